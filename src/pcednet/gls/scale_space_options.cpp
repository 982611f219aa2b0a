#include "pcednet/gls/scale_space_options.h"

#include <fmt/format.h>

#include "pcednet/cloud/bounding_box.h"

namespace pcednet::gls {

std::vector<std::string> column_names(const ScaleSpaceOptions& options) {
  std::vector<std::string> names;
  for (const std::string_view name : feature_names(options.features)) names.emplace_back(name);
  if (!options.second_gate) return names;
  for (const std::string_view name : feature_names(options.features)) {
    names.push_back(fmt::format("second_{}", name));
  }
  return names;
}

int column_count(const ScaleSpaceOptions& options) {
  return (options.second_gate ? 2 : 1) * feature_count(options.features);
}

std::vector<std::optional<double>> gates_of(const ScaleSpaceOptions& options) {
  if (!options.second_gate) return {options.side_gate};
  return {options.side_gate, options.second_gate};
}

std::string note_on(const ScaleSpaceOptions& options, std::span<const double> scales,
                    std::span<const Vec3> positions) {
  const double usual = options.range.s_max_fraction * bounding_box(positions).diagonal();
  if (options.range.s_max > 0.0 || options.range.s_max_ratio > 0.0 || scales.front() < usual)
    return {};
  return fmt::format(
      "too few points for scales up to {:.4g}, {:g} % of the diagonal: scales from {:.4g} to "
      "{:.4g}; expect false edges",
      usual, 100.0 * options.range.s_max_fraction, scales.front(), scales.back());
}

std::string text_of(const ScaleSpaceOptions& options) {
  // Names every member, so that a new one does not compile before it has its place in the text.
  const auto& [scales, range, features, reconstruction, steps, side_gate, second_gate, engine,
               eps] = options;
  const auto& [s_min, s_max, s_max_fraction, s_max_ratio, octaves, rounded] = range;
  return fmt::format(
      "scales {} s_min {} s_max {} fraction {} ratio {}{}{} features {} reconstruction {} steps {} "
      "gate {}{} engine {} eps {}",
      scales, s_min, s_max, s_max_fraction, s_max_ratio, octaves ? " octaves" : "",
      rounded ? "" : " unrounded", static_cast<int>(features), static_cast<int>(reconstruction),
      steps, side_gate ? fmt::format("{}", *side_gate) : "none",
      second_gate ? fmt::format(" and {}", *second_gate) : "", static_cast<int>(engine), eps);
}

}  // namespace pcednet::gls
