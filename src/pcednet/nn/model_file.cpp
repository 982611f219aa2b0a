#include "pcednet/nn/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "pcednet/core/error.h"

namespace pcednet::nn {
namespace {

using Json = nlohmann::json;

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

std::size_t count_of(const std::vector<std::size_t>& shape) {
  std::size_t count = 1;
  for (const std::size_t n : shape) count *= n;
  return count;
}

/// Takes a file's content apart, each piece once.
class Reader {
 public:
  Reader(const Safetensors& content, const std::string& name) : content_(content), name_(name) {}

  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(ErrorKind::kModelMismatch, fmt::format("{}: {}", name_, what));
  }

  const std::string& text(const std::string& key) const {
    const auto found = content_.metadata.find(key);
    if (found == content_.metadata.end()) refuse(fmt::format("no metadata \"{}\"", key));
    return found->second;
  }

  int number(const std::string& key) const {
    const std::string& digits = text(key);
    int value = 0;
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, value);
    if (error != std::errc() || stop != end) {
      refuse(fmt::format("metadata \"{}\" is \"{}\"; a whole number is needed", key, digits));
    }
    return value;
  }

  template <typename T, std::size_t N>
  T choice(const std::string& key,
           const std::array<std::pair<T, std::string_view>, N>& names) const {
    const std::string& given = text(key);
    for (const auto& [value, name] : names) {
      if (name == given) return value;
    }
    refuse(fmt::format("metadata \"{}\" is \"{}\", which this version does not know", key, given));
  }

  template <typename T>
  std::vector<T> list(const std::string& key) const {
    try {
      return Json::parse(text(key)).get<std::vector<T>>();
    } catch (const Json::exception&) {
      refuse(fmt::format("metadata \"{}\" is not a list of the right kind", key));
    }
  }

  std::vector<float> tensor(const std::string& key, const std::vector<std::size_t>& shape) {
    const auto found = content_.tensors.find(key);
    if (found == content_.tensors.end()) refuse(fmt::format("no tensor \"{}\"", key));
    if (found->second.shape != shape) {
      refuse(fmt::format("tensor \"{}\" is {}; the network needs {}", key,
                         Json(found->second.shape).dump(), Json(shape).dump()));
    }
    for (const float value : found->second.values) {
      if (!std::isfinite(value)) refuse(fmt::format("tensor \"{}\" holds {}", key, value));
    }
    ++taken_;
    return found->second.values;
  }

  void check_nothing_left() const {
    if (taken_ == content_.tensors.size()) return;
    refuse(fmt::format("{} tensors; the network needs {}", content_.tensors.size(), taken_));
  }

 private:
  const Safetensors& content_;
  const std::string& name_;
  std::size_t taken_ = 0;
};

Architecture read_architecture(const Reader& reader) {
  Architecture a;
  a.kind = reader.choice("nn.kind", kKinds);
  a.scales = reader.number("nn.scales");
  a.features = reader.number("nn.features");
  a.classes = reader.number("nn.classes");
  a.width = reader.number("nn.width");
  a.hidden = reader.number("nn.hidden");
  return a;
}

Standardisation read_standardisation(Reader& reader, const Architecture& a) {
  const std::vector<std::size_t> shape = {static_cast<std::size_t>(a.scales),
                                          static_cast<std::size_t>(a.features)};
  Standardisation s;
  s.mean = reader.tensor("standardisation.mean", shape);
  s.inverse_deviation = reader.tensor("standardisation.inverse_deviation", shape);
  s.bound = reader.tensor("standardisation.bound", {1})[0];
  if (const std::string& squash = reader.text("nn.squash"); squash != kSquash) {
    reader.refuse(
        fmt::format("inputs limited by \"{}\"; this version reads \"{}\"", squash, kSquash));
  }
  return s;
}

Model read_model(Reader& reader) {
  if (reader.text("nn.format") != kFormat) {
    reader.refuse(
        fmt::format("format \"{}\"; this version reads \"{}\"", reader.text("nn.format"), kFormat));
  }
  Model model;
  model.network.architecture = read_architecture(reader);
  const Architecture& a = model.network.architecture;
  for (const Layer& layer : make_plan(a).layers) {
    for (const auto& [suffix, shape] :
         {std::pair(".weight", &layer.weight_shape), std::pair(".bias", &layer.bias_shape)}) {
      const std::vector<float> values = reader.tensor(layer.name + suffix, *shape);
      model.network.parameters.insert(model.network.parameters.end(), values.begin(), values.end());
    }
  }
  model.standardisation = read_standardisation(reader, a);
  model.sign_rule.symmetry = reader.choice("nn.symmetry", kSymmetries);
  model.sign_rule.odd_features = reader.list<std::uint8_t>("nn.odd_features");
  for (const std::uint8_t odd : model.sign_rule.odd_features) {
    if (odd > 1) reader.refuse("metadata \"nn.odd_features\" holds more than 0 and 1");
  }
  model.sign_rule.deciding_feature = reader.number("nn.deciding_feature");
  model.class_names = reader.list<std::string>("nn.class_names");
  reader.check_nothing_left();
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
  content.metadata["nn.odd_features"] = Json(model.sign_rule.odd_features).dump();
  content.metadata["nn.deciding_feature"] = fmt::format("{}", model.sign_rule.deciding_feature);
  content.metadata["nn.class_names"] = Json(model.class_names).dump();
  return content;
}

Model from_safetensors(const Safetensors& content, const std::string& name) {
  Reader reader(content, name);
  try {
    Model model = read_model(reader);
    for (const auto& [key, text] : content.metadata) {
      if (!key.starts_with(kOwn)) model.metadata[key] = text;
    }
    return model;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kUsage) throw;
    reader.refuse(error.what());  // a shape that cannot be built
  }
}

void save_model(const std::filesystem::path& path, const Model& model, Overwrite overwrite) {
  write_safetensors(path, to_safetensors(model), overwrite);
}

Model load_model(const std::filesystem::path& path) {
  return from_safetensors(read_safetensors(path), path.string());
}

}  // namespace pcednet::nn
