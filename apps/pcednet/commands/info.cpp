#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>

#include "batch.h"
#include "commands.h"
#include "facts.h"
#include "pcednet/core/counted.h"
#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/core/output_file.h"
#include "pcednet/detect/cloud_kind.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/virtual_cloud.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/tiles/large_facts.h"

namespace pcednet::app {
namespace {

bool is_predicted(const detect::EdgeModel& model, std::size_t id) {
  const auto& classes = model.classes;
  return std::find(classes.begin(), classes.end(), id) != classes.end();
}

std::size_t weights_of(const nn::Model& model) {
  return model.network.parameters.size();
}

bool is_model_file(const std::filesystem::path& path) {
  return io::extension_of(path) == ".safetensors";
}

OrderedJson model_json(const std::filesystem::path& path, const detect::EdgeModel& model) {
  OrderedJson classes = OrderedJson::array();
  for (std::size_t id = 0; id < model.table.size(); ++id) {
    classes.push_back({{"id", id},
                       {"name", model.table[id].name},
                       {"colour", pcednet::text_of(model.table[id].colour)},
                       {"predicted", is_predicted(model, id)}});
  }
  return {{"file", path.string()},
          {"format", "model"},
          {"name", model.name},
          {"seed", model.seed},
          {"classes", classes},
          {"scales", model.descriptor.scales},
          {"weights", weights_of(model.network)},
          {"context_weights", model.context ? weights_of(*model.context) : 0}};
}

std::string model_text(const std::filesystem::path& path, const detect::EdgeModel& model) {
  std::string text = path.string() + "\n";
  const auto add = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<14} {}\n", name, value);
  };
  add("format", "model");
  add("name", model.name);
  for (std::size_t id = 0; id < model.table.size(); ++id) {
    const bool by_geometry = id == kBoundary && has_edges(model.table);
    add("class", fmt::format("{} {} {}{}", id, pcednet::text_of(model.table[id].colour),
                             model.table[id].name,
                             is_predicted(model, id) ? ""
                             : by_geometry           ? ", found by geometry"
                                                     : ", not learnt"));
  }
  add("scales", std::to_string(model.descriptor.scales));
  add("weights",
      fmt::format(
          "{}{}", weights_of(model.network),
          model.context ? fmt::format(" and {} for context", weights_of(*model.context)) : ""));
  return text;
}

struct InfoRequest {
  std::vector<std::string> inputs;
  std::string json, vpc;
  bool all = false;
};

void write_json(const InfoRequest& request, const OrderedJson& files, const Common& common) {
  if (request.json.empty()) return;
  // Names and comments of foreign files need not be UTF-8.
  const std::string text = to_text(files, 2, NotUtf8::kReplace) + "\n";
  if (request.json == "-") {
    fmt::print("{}", text);
  } else {
    write_text_file(request.json, text, common.overwrite());
  }
}

void check_is_las(const std::filesystem::path& path) {
  if (formats::format_of(io::InputFile(path)).is_las()) return;
  throw Error(ErrorKind::kUsage, path.string() +
                                     ": --vpc lists LAS, LAZ and COPC files, which "
                                     "pcednet convert writes");
}

/// Reads only headers.
void list_files(const InfoRequest& request, const Common& common) {
  check_writable(request.vpc, common.overwrite());
  const Progress progress = console_progress(common);
  const Inputs inputs = find_inputs(request.inputs);
  Batch batch(inputs);
  std::vector<formats::VirtualFile> files;
  for (const std::filesystem::path& path : inputs.files) {
    throw_if_cancelled(&progress);
    batch.run(path, [&] {
      check_is_las(path);
      files.push_back(formats::virtual_file(path));
    });
  }
  batch.finish();
  for (const std::string& remark :
       formats::write_virtual_cloud(request.vpc, files, common.overwrite())) {
    warn(request.vpc + ": " + remark);
  }
  std::uint64_t points = 0;
  for (const formats::VirtualFile& file : files) points += file.points;
  say(fmt::format("{}: {}, {} points", request.vpc, counted(files.size(), "file"), points));
}

formats::CloudFacts facts_of(const std::filesystem::path& path, bool all,
                             const Progress& progress) {
  if (auto facts = tiles::large_facts(path, {.all = all}, &progress)) return std::move(*facts);
  const EndsAtOnce reading;
  return formats::cloud_facts(path);
}

void info(const InfoRequest& request, const Common& common) {
  check_not_inputs(request.json, request.inputs);
  check_not_inputs(request.vpc, request.inputs);
  if (!request.vpc.empty()) return list_files(request, common);
  if (request.json != "-") check_writable(request.json, common.overwrite());
  const Progress progress = console_progress(common);
  const Inputs inputs = find_inputs(request.inputs);
  Batch batch(inputs);
  OrderedJson files = OrderedJson::array();
  const auto add_failure = [&](const Failure& failure) {
    files.push_back({{"file", failure.input}, {"error", failure.error.what()}});
  };
  std::for_each(batch.failures().begin(), batch.failures().end(), add_failure);
  for (const std::filesystem::path& path : inputs.files) {
    throw_if_cancelled(&progress);
    const auto describe = [&] {
      if (is_model_file(path)) {
        const detect::EdgeModel model = detect::load_model(path);
        files.push_back(model_json(path, model));
        if (request.json != "-") fmt::print("{}", model_text(path, model));
        return;
      }
      const formats::CloudFacts facts = facts_of(path, request.all, progress);
      files.push_back(json_of(path, facts));
      if (request.json != "-") fmt::print("{}", text_of(path, facts));
    };
    if (!batch.run(path, describe)) add_failure(batch.failures().back());
  }
  write_json(request, files, common);
  batch.finish();
}

}  // namespace

void add_info(CLI::App& app, Common& common) {
  CLI::App* command =
      add_command(app, common, "info", "Describe point files and models",
                  "pcednet info scan.ply\n"
                  "pcednet info folder/ --json report.json\n"
                  "pcednet info scan.ply --json -\n"
                  "pcednet info city.laz --all     counts every point of a large file\n"
                  "pcednet info my.safetensors     its classes\n"
                  "pcednet info tiles/ --vpc city.vpc");
  auto request = std::make_shared<InfoRequest>();
  command
      ->add_option("inputs", request->inputs, "Point files, folders of point files, or model files")
      ->required();
  command->add_option("--json", request->json,
                      "Write the result as JSON to this file; - for standard output only");
  CLI::Option* all = command->add_flag(
      "--all", request->all,
      "Read all points of LAS, LAZ and binary PLY files of more than two million, "
      "not a sample of them");
  command->add_option("--vpc", request->vpc,
                      "Instead of describing them, list LAS, LAZ and COPC files in a virtual point "
                      "cloud for QGIS; only their headers are read");
  CLI::Option* vpc = command->get_option("--vpc");
  command->get_option("--json")->excludes(vpc);
  all->excludes(vpc);
  command->callback([request, &common] { info(*request, common); });
}

}  // namespace pcednet::app
