#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "commands.h"
#include "pcednet/io/read_cloud.h"
#include "pcednet/io/write_cloud.h"

namespace pcednet::app {
namespace {

struct Request {
  std::string input;
  std::string output;
  bool ascii = false;
};

void convert(const Request& request, const Common& common) {
  // What the output's extension allows is asked before a long read.
  io::losses(request.output, {});
  const io::LoadedCloud loaded = io::read_cloud(request.input);
  for (const std::string& warning : loaded.warnings) warn(request.input + ": " + warning);
  for (const std::string& loss : io::losses(request.output, loaded.cloud)) {
    warn(request.output + " does not keep: " + loss);
  }
  io::write_cloud(request.output, loaded.cloud,
                  {.overwrite = common.overwrite(), .ascii = request.ascii});
  say(fmt::format("{}: {} points", request.output, loaded.cloud.size()));
}

}  // namespace

void add_convert(CLI::App& app, Common& common) {
  CLI::App* command = add_command(app, common, "convert", "Writes a point file in another format",
                                  "pcednet convert scan.xyz -o scan.ply\n"
                                  "pcednet convert scan.ply -o scan.pcd\n"
                                  "pcednet convert scan.ply -o readable.ply --ascii");
  auto request = std::make_shared<Request>();
  command->add_option("input", request->input, "The point file to read")->required();
  command
      ->add_option("-o,--output", request->output,
                   "The file to write: .ply .pcd .obj .xyz .txt .asc .pts or .csv")
      ->required();
  command->add_flag("--ascii", request->ascii, "Numbers as text in .ply and .pcd");
  command->callback([request, &common] { convert(*request, common); });
}

}  // namespace pcednet::app
