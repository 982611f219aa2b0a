#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <string>

#include "pcednet/detect/model.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::app {

/// The model of commands without `--model`.
inline constexpr const char* kDefaultModel = "general";

/// The shipped models by name, looked for beside the installed program and in the source tree.
std::map<std::string, std::filesystem::path> shipped_models();

/// "cad, general, scan, worn".
std::string names_of(const std::map<std::string, std::filesystem::path>& models);

/// The file behind `--model`: a path as given, or the shipped model of that name. Throws
/// Error(kUsage) with the available names.
std::filesystem::path find_model(const std::string& name_or_file);

/// A model and its use.
struct ModelArguments {
  std::string name;
  bool no_context = false;
  bool no_boundary = false;
  gls::ScaleSpaceOptions scales = {};  ///< its s_min, s_max and engine
};

/// Adds --model, --no-context, --no-boundary, --exact, --s-min and --s-max; the last five apply to
/// models only.
void add_model_options(CLI::App& command, ModelArguments& arguments);

/// The model as a plan of tiles names it. Throws as find_model() does.
tiles::PlannedModel planned_model(const ModelArguments& arguments);

/// Takes the shipped model of the same name for a planned one whose file is not here, as where
/// pcednet is installed elsewhere; its digest decides whether it is the same.
void find_planned_model(tiles::PlannedModel& model);

/// The file of the model, for check_not_input(); empty without a model. Throws as find_model()
/// does.
std::filesystem::path model_file(const ModelArguments& arguments);

/// Throws as find_model() and detect::load_model() do.
detect::EdgeModel load_model(const ModelArguments& arguments);

}  // namespace pcednet::app
