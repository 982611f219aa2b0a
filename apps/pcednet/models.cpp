#include "models.h"

#include <fmt/format.h>

#include <vector>

#include "descriptor_options.h"
#include "pcednet/core/error.h"
#include "program_folder.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

/// Folders that may hold the shipped models, the likeliest first.
std::vector<fs::path> model_folders() {
  return {program_folder() / "../share/pcednet/models", PCEDNET_INSTALLED_MODELS,
          PCEDNET_SOURCE_MODELS};
}

}  // namespace

std::map<std::string, fs::path> shipped_models() {
  std::map<std::string, fs::path> models;
  std::error_code error;
  for (const fs::path& folder : model_folders()) {
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".safetensors") {
        models.emplace(entry.path().stem().string(), entry.path());
      }
    }
  }
  return models;
}

fs::path find_model(const std::string& name_or_file) {
  std::error_code error;
  if (fs::is_regular_file(name_or_file, error)) return name_or_file;
  const auto models = shipped_models();
  if (const auto found = models.find(name_or_file); found != models.end()) return found->second;
  throw Error(ErrorKind::kUsage, fmt::format("{}: neither a file nor a shipped model ({})",
                                             name_or_file, names_of(models)));
}

std::string names_of(const std::map<std::string, fs::path>& models) {
  std::string names;
  for (const auto& [name, path] : models) names += (names.empty() ? "" : ", ") + name;
  return names;
}

void add_model_options(CLI::App& command, ModelArguments& arguments) {
  command.add_option("--model", arguments.name, "Name of a shipped model, or a model file")
      ->capture_default_str();
  command.add_flag("--no-context", arguments.no_context,
                   "Leave out the context network: faster, less accurate");
  command.add_flag("--no-boundary", arguments.no_boundary,
                   "Leave out the class boundary (3): where the sampled surface ends");
  add_engine_option(command, arguments.scales);
  add_scale_range_options(command, arguments.scales);
}

tiles::PlannedModel planned_model(const ModelArguments& arguments) {
  return {.name = arguments.name,
          .path = find_model(arguments.name),
          .context = !arguments.no_context,
          .boundary = !arguments.no_boundary,
          .exact = arguments.scales.engine == gls::Engine::kExact};
}

void find_planned_model(tiles::PlannedModel& model) {
  std::error_code error;
  if (fs::exists(model.path, error)) return;
  const auto models = shipped_models();
  if (const auto found = models.find(model.name); found != models.end()) model.path = found->second;
}

std::filesystem::path model_file(const ModelArguments& arguments) {
  return arguments.name.empty() ? std::filesystem::path() : find_model(arguments.name);
}

detect::EdgeModel load_model(const ModelArguments& arguments) {
  detect::EdgeModel model = detect::load_model(find_model(arguments.name));
  if (arguments.no_context) detect::drop_context(model);
  model.descriptor.range.s_min = arguments.scales.range.s_min;
  model.descriptor.range.s_max = arguments.scales.range.s_max;
  model.descriptor.engine = arguments.scales.engine;
  return model;
}

}  // namespace pcednet::app
