#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>

#include "commands.h"
#include "common.h"
#include "missing_command.h"
#include "number_options.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/version.h"
#include "program_folder.h"

namespace pcednet::app {
namespace {

/// Throws if what was printed could not be written, as on a full disk.
void check_printed() {
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw Error(ErrorKind::kFailure, fmt::format("standard output: {}", std::strerror(errno)));
}

int run(int argc, char** argv) {
  CLI::App app{
      "pcednet finds edges in 3D point clouds.\n\nExamples:\n"
      "  pcednet classify scan.ply                labels and confidences in scan_edges.ply\n"
      "  pcednet classify folder/ --out-dir out   every point file of a folder\n"
      "  pcednet lines scan.ply -o edges.dxf      edges as segments, arcs, circles and polylines\n"
      "  pcednet train painted.ply -o my.safetensors\n"};
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_version_flag("--version", std::string("pcednet ") + kVersion);
  app.require_subcommand(1);
  app.fallthrough(false);
  Common common;
  app.parse_complete_callback([&] { set_thread_count(common.threads); });
  use_own_proj_database();
  install_signal_handlers();
  // One line per subcommand, in the order of the help.
  add_classify(app, common);
  add_lines(app, common);
  add_tiles(app, common);
  add_train(app, common);
  add_evaluate(app, common);
  add_describe(app, common);
  add_generate(app, common);
  add_normals(app, common);
  add_info(app, common);
  add_convert(app, common);
  add_study(app, common);
  add_report(app, common);
  add_annotate(app, common);
  guard_number_options(app);
  try {
    for (int i = 1; i < argc; ++i) {
      if (*argv[i] == '\0') throw CLI::ValidationError("an argument is empty");
    }
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      say_error(why_refused(error, app));
      say("Run with --help for more information.");
      return static_cast<int>(ErrorKind::kUsage);
    }
    app.exit(error, std::cout);  // help and version
  }
  check_printed();
  return 0;
}

}  // namespace
}  // namespace pcednet::app

int main(int argc, char** argv) {
  try {
    return pcednet::app::run(argc, argv);
  } catch (const pcednet::Error& error) {
    pcednet::app::say_error(pcednet::app::explain(error));
    return static_cast<int>(error.kind());
  } catch (const std::bad_alloc&) {
    pcednet::app::say_error("not enough memory");
  } catch (const std::filesystem::filesystem_error& error) {
    pcednet::app::say_error(fmt::format("{}: {}", error.path1().string(), error.code().message()));
  } catch (const std::exception& error) {
    pcednet::app::say_error(error.what());
  }
  return static_cast<int>(pcednet::ErrorKind::kFailure);
}
