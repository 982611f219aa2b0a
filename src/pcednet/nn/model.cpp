#include "pcednet/nn/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "pcednet/core/error.h"

namespace pcednet::nn {

void check_consistent(const Model& model) {
  const Architecture& a = model.network.architecture;
  const auto check_size = [](std::string_view what, std::size_t size, std::size_t wanted) {
    if (size == wanted) return;
    throw Error(ErrorKind::kUsage,
                fmt::format("a model with {} {}; its architecture needs {}", size, what, wanted));
  };
  const auto inputs = static_cast<std::size_t>(a.inputs());
  check_size("parameters", model.network.parameters.size(), weight_count(a));
  check_size("means", model.standardisation.mean.size(), inputs);
  check_size("deviations", model.standardisation.inverse_deviation.size(), inputs);
  if (!model.class_names.empty()) {
    check_size("class names", model.class_names.size(), static_cast<std::size_t>(a.classes));
  }
  if (!(model.standardisation.bound > 0.0f)) {
    throw Error(ErrorKind::kUsage, "the bound of standardised inputs must be positive");
  }
  const SignRule& rule = model.sign_rule;
  if (!rule.odd_features.empty()) {
    check_size("odd features", rule.odd_features.size(), static_cast<std::size_t>(a.features));
  }
  if (rule.symmetry == Symmetry::kNone) return;
  if (std::none_of(rule.odd_features.begin(), rule.odd_features.end(), [](auto o) { return o; })) {
    throw Error(ErrorKind::kUsage, "a symmetry without features that change sign");
  }
  const auto deciding = static_cast<std::size_t>(rule.deciding_feature);
  if (rule.symmetry == Symmetry::kCanonical &&
      (deciding >= rule.odd_features.size() || !rule.odd_features[deciding])) {
    throw Error(ErrorKind::kUsage,
                fmt::format("feature {} does not change sign, so it cannot decide it", deciding));
  }
  for (std::size_t u = 0; u < inputs; ++u) {
    if (rule.odd_features[u % rule.odd_features.size()] && model.standardisation.mean[u] != 0.0f) {
      throw Error(ErrorKind::kUsage, fmt::format("input {} changes sign but has a mean", u));
    }
  }
}

}  // namespace pcednet::nn
