#include "pcednet/detect/model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <map>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/core/version.h"
#include "pcednet/detect/context.h"
#include "pcednet/nn/metadata.h"
#include "pcednet/nn/model_file.h"

namespace pcednet::detect {
namespace {

constexpr const char* kFormat = "pcednet-edge-model-1";
constexpr const char* kContextFormat = "pcednet-edge-model-2";  // with a context network
constexpr std::string_view kContext = "context.";
const std::array<std::vector<std::uint8_t>, 2> kClassLists = {
    {{kNonEdge, kSmoothEdge, kSharpEdge}, {kNonEdge, kSharpEdge}}};

std::string text_of(const std::vector<std::uint8_t>& classes) {
  return fmt::format("{}", fmt::join(classes, " "));
}

std::string names_of(gls::FeatureSet set) {
  return fmt::format("{}", fmt::join(gls::feature_names(set), " "));
}

gls::FeatureSet take_features(nn::Metadata& metadata) {
  const std::string key = "descriptor_features", names = metadata.take(key);
  for (const gls::FeatureSet set : gls::feature_sets()) {
    if (names == names_of(set)) return set;
  }
  metadata.refuse_value(key, names);
}

gls::Reconstruction take_reconstruction(nn::Metadata& metadata) {
  const std::string key = "descriptor_reconstruction", name = metadata.take(key);
  if (const auto found = gls::reconstruction_of(name)) return *found;
  metadata.refuse_value(key, name);
}

std::vector<std::uint8_t> take_classes(nn::Metadata& metadata) {
  const std::string key = "classes", text = metadata.take(key);
  for (const auto& classes : kClassLists) {
    if (text == text_of(classes)) return classes;
  }
  metadata.refuse_value(key, text);
}

gls::ScaleSpaceOptions take_descriptor(nn::Metadata& metadata) {
  gls::ScaleSpaceOptions descriptor;
  descriptor.scales = metadata.take_number<int>("descriptor_scales");
  descriptor.features = take_features(metadata);
  descriptor.reconstruction = take_reconstruction(metadata);
  descriptor.max_projection_steps = metadata.take_number<int>("descriptor_projection_steps");
  if (metadata.has("descriptor_side_gate")) {
    descriptor.side_gate = metadata.take_number<double>("descriptor_side_gate");
  }
  if (metadata.has("descriptor_second_gate")) {
    descriptor.second_gate = metadata.take_number<double>("descriptor_second_gate");
  }
  if (metadata.has("descriptor_s_max_fraction")) {
    descriptor.s_max_fraction = metadata.take_number<double>("descriptor_s_max_fraction");
  }
  if (metadata.has("descriptor_s_max_ratio")) {
    descriptor.s_max_ratio = metadata.take_number<double>("descriptor_s_max_ratio");
  }
  return descriptor;
}

void put_descriptor(const gls::ScaleSpaceOptions& descriptor,
                    std::map<std::string, std::string>& metadata) {
  metadata["descriptor_scales"] = std::to_string(descriptor.scales);
  metadata["descriptor_features"] = names_of(descriptor.features);
  metadata["descriptor_reconstruction"] =
      std::string(gls::reconstruction_names()[static_cast<std::size_t>(descriptor.reconstruction)]);
  metadata["descriptor_projection_steps"] = std::to_string(descriptor.max_projection_steps);
  if (descriptor.side_gate) {
    metadata["descriptor_side_gate"] = fmt::format("{}", *descriptor.side_gate);
  }
  if (descriptor.second_gate) {
    metadata["descriptor_second_gate"] = fmt::format("{}", *descriptor.second_gate);
  }
  if (descriptor.s_max_fraction != gls::kPartOfDiagonal) {
    metadata["descriptor_s_max_fraction"] = fmt::format("{}", descriptor.s_max_fraction);
  }
  if (descriptor.s_max_ratio > 0.0) {
    metadata["descriptor_s_max_ratio"] = fmt::format("{}", descriptor.s_max_ratio);
  }
}

/// Takes what is named with kContext before it out of `all`, and out of its names.
template <typename Value>
std::map<std::string, Value> take_context(std::map<std::string, Value>& all) {
  std::map<std::string, Value> context;
  for (auto entry = all.begin(); entry != all.end();) {
    if (entry->first.starts_with(kContext)) {
      context.emplace(entry->first.substr(kContext.size()), std::move(entry->second));
      entry = all.erase(entry);
    } else {
      ++entry;
    }
  }
  return context;
}

/// Puts `part` into `all`, with kContext before the names.
template <typename Value>
void add_context(const std::map<std::string, Value>& part, std::map<std::string, Value>& all) {
  for (const auto& [name, value] : part) all[std::string(kContext) + name] = value;
}

nn::Model read_context(const std::filesystem::path& path, const nn::Safetensors& content,
                       std::size_t classes) {
  nn::Model context = nn::from_safetensors(content, path.string() + ": context network");
  const nn::Architecture& its = context.network.architecture;
  const nn::Architecture wanted = context_architecture(static_cast<int>(classes));
  if (its.scales != wanted.scales || its.features != wanted.features ||
      its.classes != wanted.classes) {
    throw Error(ErrorKind::kModelMismatch,
                fmt::format("{}: the context network does not fit the classes", path.string()));
  }
  return context;
}

}  // namespace

EdgeModel load_model(const std::filesystem::path& path) {
  EdgeModel model;
  nn::Safetensors content = nn::read_safetensors(path);
  const nn::Safetensors context = {take_context(content.tensors), take_context(content.metadata)};
  model.network = nn::from_safetensors(content, path.string());
  nn::Metadata metadata(std::move(model.network.metadata), path.string());
  metadata.take_fixed("format", context.tensors.empty() ? kFormat : kContextFormat);
  metadata.take_fixed("undefined", "zero");
  metadata.take("version");
  model.name = metadata.take("name");
  model.seed = metadata.take_number<std::uint64_t>("seed");
  model.descriptor = take_descriptor(metadata);
  model.classes = take_classes(metadata);
  const nn::Architecture& network = model.network.network.architecture;
  if (network.scales != model.descriptor.scales ||
      network.features != gls::column_count(model.descriptor) ||
      network.classes != static_cast<int>(model.classes.size())) {
    metadata.refuse("the network does not fit its descriptor and classes");
  }
  model.network.metadata = std::move(metadata.rest());
  if (!context.tensors.empty()) model.context = read_context(path, context, model.classes.size());
  return model;
}

void save_model(const std::filesystem::path& path, const EdgeModel& model, Overwrite overwrite) {
  nn::Model network = model.network;
  auto& metadata = network.metadata;
  metadata["format"] = model.context ? kContextFormat : kFormat;
  metadata["version"] = kVersion;
  metadata["undefined"] = "zero";
  metadata["name"] = model.name;
  metadata["seed"] = std::to_string(model.seed);
  put_descriptor(model.descriptor, metadata);
  metadata["classes"] = text_of(model.classes);
  nn::Safetensors content = nn::to_safetensors(network);
  if (model.context) {
    const nn::Safetensors context = nn::to_safetensors(*model.context);
    add_context(context.tensors, content.tensors);
    add_context(context.metadata, content.metadata);
  }
  nn::write_safetensors(path, content, overwrite);
}

}  // namespace pcednet::detect
