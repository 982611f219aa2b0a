#include "pcednet/nn/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/nn/metadata.h"
#include "pcednet/nn/plan.h"

namespace pcednet::nn {
namespace {

constexpr std::string_view kOwn = "nn.";
constexpr std::string_view kFormat = "pcednet network 1";

constexpr std::array<std::pair<NetworkKind, std::string_view>, 3> kKinds = {
    {{NetworkKind::kPcednet, "PCEDNet"}, {NetworkKind::kFc, "FC"}, {NetworkKind::kCnn, "CNN"}}};
constexpr std::array<std::pair<Symmetry, std::string_view>, 3> kSymmetries = {
    {{Symmetry::kNone, "none"},
     {Symmetry::kAverage, "average"},
     {Symmetry::kCanonical, "canonical"}}};
constexpr std::string_view kSquash = "clip";  // there was another way to limit inputs once

template <typename T, std::size_t N>
std::string name_of(const std::array<std::pair<T, std::string_view>, N>& names, T value) {
  for (const auto& [known, name] : names) {
    if (known == value) return std::string(name);
  }
  return "";
}

std::vector<float> part(const std::vector<float>& all, std::size_t begin, std::size_t end) {
  return {all.begin() + static_cast<std::ptrdiff_t>(begin),
          all.begin() + static_cast<std::ptrdiff_t>(end)};
}

/// Takes a file's tensors apart, each once.
class Tensors {
 public:
  Tensors(const Safetensors& content, const Metadata& metadata)
      : content_(content), metadata_(metadata) {}

  std::vector<float> take(const std::string& key, const std::vector<std::size_t>& shape) {
    const auto found = content_.tensors.find(key);
    if (found == content_.tensors.end()) metadata_.refuse(fmt::format("no tensor \"{}\"", key));
    if (found->second.shape != shape) {
      metadata_.refuse(fmt::format("tensor \"{}\" is {}; the network needs {}", key,
                                   to_text(Json(found->second.shape)), to_text(Json(shape))));
    }
    for (const float value : found->second.values) {
      if (!std::isfinite(value)) {
        metadata_.refuse(fmt::format("tensor \"{}\" holds {}", key, value));
      }
    }
    ++taken_;
    return found->second.values;
  }

  void check_nothing_left() const {
    if (taken_ == content_.tensors.size()) return;
    metadata_.refuse(
        fmt::format("{} tensors; the network needs {}", content_.tensors.size(), taken_));
  }

 private:
  const Safetensors& content_;
  const Metadata& metadata_;
  std::size_t taken_ = 0;
};

template <typename T>
std::vector<T> take_list(Metadata& metadata, const std::string& key) {
  try {
    return parse_json(metadata.take(key)).get<std::vector<T>>();
  } catch (const Json::exception&) {
    metadata.refuse(fmt::format("metadata \"{}\" is not a list of the right kind", key));
  }
}

Architecture read_architecture(Metadata& metadata) {
  Architecture a;
  a.kind = metadata.take_choice("nn.kind", kKinds);
  a.scales = metadata.take_number<int>("nn.scales");
  a.features = metadata.take_number<int>("nn.features");
  a.classes = metadata.take_number<int>("nn.classes");
  a.width = metadata.take_number<int>("nn.width");
  a.hidden = metadata.take_number<int>("nn.hidden");
  return a;
}

Standardisation read_standardisation(Tensors& tensors, const Architecture& a) {
  const std::vector<std::size_t> shape = {static_cast<std::size_t>(a.scales),
                                          static_cast<std::size_t>(a.features)};
  Standardisation s;
  s.mean = tensors.take("standardisation.mean", shape);
  s.inverse_deviation = tensors.take("standardisation.inverse_deviation", shape);
  s.bound = tensors.take("standardisation.bound", {1})[0];
  return s;
}

SignRule read_sign_rule(Metadata& metadata) {
  SignRule rule;
  rule.symmetry = metadata.take_choice("nn.symmetry", kSymmetries);
  rule.odd_features = take_list<std::uint8_t>(metadata, "nn.odd_features");
  for (const std::uint8_t odd : rule.odd_features) {
    if (odd > 1) metadata.refuse("metadata \"nn.odd_features\" holds more than 0 and 1");
  }
  rule.deciding_feature = metadata.take_number<int>("nn.deciding_feature");
  return rule;
}

Model read_model(Metadata& metadata, Tensors& tensors) {
  metadata.take_fixed("nn.format", kFormat);
  metadata.take_fixed("nn.squash", kSquash);
  Model model;
  model.network.architecture = read_architecture(metadata);
  const Architecture& a = model.network.architecture;
  for (const Layer& layer : make_plan(a).layers) {
    for (const auto& [suffix, shape] :
         {std::pair(".weight", &layer.weight_shape), std::pair(".bias", &layer.bias_shape)}) {
      const std::vector<float> values = tensors.take(layer.name + suffix, *shape);
      model.network.parameters.insert(model.network.parameters.end(), values.begin(), values.end());
    }
  }
  model.standardisation = read_standardisation(tensors, a);
  model.sign_rule = read_sign_rule(metadata);
  model.class_names = take_list<std::string>(metadata, "nn.class_names");
  tensors.check_nothing_left();
  check_consistent(model);
  return model;
}

}  // namespace

Safetensors to_safetensors(const Model& model) {
  check_consistent(model);
  const Architecture& a = model.network.architecture;
  Safetensors content;
  for (const Layer& layer : make_plan(a).layers) {
    const std::size_t end = layer.bias + count_of(layer.bias_shape);
    content.tensors[layer.name + ".weight"] = {
        layer.weight_shape, part(model.network.parameters, layer.weight, layer.bias)};
    content.tensors[layer.name + ".bias"] = {layer.bias_shape,
                                             part(model.network.parameters, layer.bias, end)};
  }
  const Standardisation& s = model.standardisation;
  const std::vector<std::size_t> shape = {static_cast<std::size_t>(a.scales),
                                          static_cast<std::size_t>(a.features)};
  content.tensors["standardisation.mean"] = {shape, s.mean};
  content.tensors["standardisation.inverse_deviation"] = {shape, s.inverse_deviation};
  content.tensors["standardisation.bound"] = {{1}, {s.bound}};
  for (const auto& [key, text] : model.metadata) {
    if (key.starts_with(kOwn)) {
      throw Error(ErrorKind::kUsage, fmt::format("metadata \"{}\": nn. is the network's own", key));
    }
  }
  content.metadata = model.metadata;
  content.metadata["nn.format"] = kFormat;
  content.metadata["nn.kind"] = name_of(kKinds, a.kind);
  content.metadata["nn.scales"] = fmt::format("{}", a.scales);
  content.metadata["nn.features"] = fmt::format("{}", a.features);
  content.metadata["nn.classes"] = fmt::format("{}", a.classes);
  content.metadata["nn.width"] = fmt::format("{}", a.width);
  content.metadata["nn.hidden"] = fmt::format("{}", a.hidden);
  content.metadata["nn.squash"] = kSquash;
  content.metadata["nn.symmetry"] = name_of(kSymmetries, model.sign_rule.symmetry);
  content.metadata["nn.odd_features"] = to_text(Json(model.sign_rule.odd_features));
  content.metadata["nn.deciding_feature"] = fmt::format("{}", model.sign_rule.deciding_feature);
  content.metadata["nn.class_names"] = to_text(Json(model.class_names));
  return content;
}

Model from_safetensors(const Safetensors& content, const std::string& name) {
  Metadata metadata(content.metadata, name);
  Tensors tensors(content, metadata);
  try {
    Model model = read_model(metadata, tensors);
    for (const auto& [key, text] : metadata.rest()) {
      if (!key.starts_with(kOwn)) model.metadata[key] = text;
    }
    return model;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kUsage) throw;
    metadata.refuse(error.what());  // a shape that cannot be built
  }
}

}  // namespace pcednet::nn
