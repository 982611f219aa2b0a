#include "pcednet/detect/model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/core/version.h"
#include "pcednet/detect/context.h"
#include "pcednet/nn/model_file.h"

namespace pcednet::detect {
namespace {

constexpr std::array kFeatureSets = {gls::FeatureSet::kAll28, gls::FeatureSet::kInvariant7,
                                     gls::FeatureSet::kPaper6, gls::FeatureSet::kSpatial4,
                                     gls::FeatureSet::kRelief3};
constexpr const char* kFormat = "pcednet-edge-model-1";
constexpr const char* kContextFormat = "pcednet-edge-model-2";  // with a context network
constexpr std::string_view kContext = "context.";

/// The metadata of a model file, with errors that name it.
class Metadata {
 public:
  Metadata(const std::filesystem::path& path, std::map<std::string, std::string>& values)
      : path_(path), values_(values) {}

  [[noreturn]] void refuse(const std::string& why) const {
    throw Error(ErrorKind::kModelMismatch, fmt::format("{}: {}", path_.string(), why));
  }
  std::string take(const std::string& key) {
    const auto found = values_.find(key);
    if (found == values_.end()) refuse(fmt::format("no model of edges: \"{}\" is missing", key));
    std::string value = std::move(found->second);
    values_.erase(found);
    return value;
  }
  template <typename Number>
  Number take_number(const std::string& key) {
    const std::string text = take(key);
    Number number{};
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || rest != end) refuse(fmt::format("\"{}\" is {}", key, text));
    return number;
  }

 private:
  const std::filesystem::path& path_;
  std::map<std::string, std::string>& values_;
};

gls::FeatureSet feature_set_of(const std::string& names, const Metadata& metadata) {
  for (const gls::FeatureSet set : kFeatureSets) {
    if (names == fmt::format("{}", fmt::join(gls::feature_names(set), " "))) return set;
  }
  metadata.refuse(fmt::format("unknown features: {}", names));
}

gls::Reconstruction reconstruction_of(const std::string& name, const Metadata& metadata) {
  const auto names = gls::reconstruction_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) metadata.refuse(fmt::format("unknown reconstruction: {}", name));
  return static_cast<gls::Reconstruction>(found - names.begin());
}

std::vector<std::uint8_t> classes_of(const std::string& text, const Metadata& metadata) {
  if (text == "0 1 2") return {kNonEdge, kSmoothEdge, kSharpEdge};
  if (text == "0 2") return {kNonEdge, kSharpEdge};
  metadata.refuse(fmt::format("unknown classes: {}", text));
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
  Metadata metadata(path, model.network.metadata);
  const std::string wanted = context.tensors.empty() ? kFormat : kContextFormat;
  if (const std::string format = metadata.take("format"); format != wanted) {
    metadata.refuse(fmt::format("format {} where {} is read", format, wanted));
  }
  metadata.take("version");
  if (metadata.take("undefined") != "zero") metadata.refuse("another policy for bad fits");
  model.name = metadata.take("name");
  model.seed = metadata.take_number<std::uint64_t>("seed");
  gls::ScaleSpaceOptions& descriptor = model.descriptor;
  descriptor.scales = metadata.take_number<int>("descriptor_scales");
  descriptor.features = feature_set_of(metadata.take("descriptor_features"), metadata);
  descriptor.reconstruction =
      reconstruction_of(metadata.take("descriptor_reconstruction"), metadata);
  descriptor.max_projection_steps = metadata.take_number<int>("descriptor_projection_steps");
  if (model.network.metadata.contains("descriptor_side_gate")) {
    descriptor.side_gate = metadata.take_number<double>("descriptor_side_gate");
  }
  if (model.network.metadata.contains("descriptor_second_gate")) {
    descriptor.second_gate = metadata.take_number<double>("descriptor_second_gate");
  }
  if (model.network.metadata.contains("descriptor_s_max_fraction")) {
    descriptor.s_max_fraction = metadata.take_number<double>("descriptor_s_max_fraction");
  }
  model.classes = classes_of(metadata.take("classes"), metadata);
  const nn::Architecture& network = model.network.network.architecture;
  if (network.scales != descriptor.scales || network.features != gls::column_count(descriptor) ||
      network.classes != static_cast<int>(model.classes.size())) {
    metadata.refuse("the network does not fit its descriptor and classes");
  }
  if (!context.tensors.empty()) model.context = read_context(path, context, model.classes.size());
  return model;
}

void save_model(const std::filesystem::path& path, const EdgeModel& model, Overwrite overwrite) {
  nn::Model network = model.network;
  auto& metadata = network.metadata;
  const gls::ScaleSpaceOptions& descriptor = model.descriptor;
  metadata["format"] = model.context ? kContextFormat : kFormat;
  metadata["version"] = kVersion;
  metadata["undefined"] = "zero";
  metadata["name"] = model.name;
  metadata["seed"] = std::to_string(model.seed);
  metadata["descriptor_scales"] = std::to_string(descriptor.scales);
  metadata["descriptor_features"] =
      fmt::format("{}", fmt::join(gls::feature_names(descriptor.features), " "));
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
  metadata["classes"] = fmt::format("{}", fmt::join(model.classes, " "));
  nn::Safetensors content = nn::to_safetensors(network);
  if (model.context) {
    const nn::Safetensors context = nn::to_safetensors(*model.context);
    add_context(context.tensors, content.tensors);
    add_context(context.metadata, content.metadata);
  }
  nn::write_safetensors(path, content, overwrite);
}

}  // namespace pcednet::detect
