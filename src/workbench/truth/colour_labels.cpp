#include "workbench/truth/colour_labels.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace pcednet::truth {
namespace {

using Colour = std::array<std::uint8_t, 3>;

std::optional<std::uint8_t> class_of(const Colour& colour) {
  const int red = colour[0], green = colour[1], blue = colour[2];
  if (std::max({red, green, blue}) - std::min({red, green, blue}) <= 16) return kNonEdge;
  if (blue >= 96 && red < blue / 4) return kBoundary;
  if (red < 96 || blue > green + 16) return std::nullopt;
  if (green < red / 4) return kSharpEdge;
  if (green > red / 2 && blue < red * 2 / 3) return kSmoothEdge;
  return std::nullopt;
}

}  // namespace

std::vector<std::uint8_t> labels_of_colours(const PointCloud& cloud) {
  std::map<Colour, std::uint8_t> classes;
  for (const auto& colour : cloud.colours) {
    const Colour key = {colour[0], colour[1], colour[2]};
    if (classes.contains(key)) continue;
    const auto found = class_of(key);
    const bool taken = std::any_of(classes.begin(), classes.end(),
                                   [&](const auto& entry) { return entry.second == found; });
    if (!found || taken) return {};
    classes[key] = *found;
  }
  const bool has_red = std::any_of(classes.begin(), classes.end(),
                                   [](const auto& entry) { return entry.second == kSharpEdge; });
  if (classes.size() < 2 || !has_red) return {};
  std::vector<std::uint8_t> labels;
  labels.reserve(cloud.size());
  for (const auto& colour : cloud.colours) {
    labels.push_back(classes.at({colour[0], colour[1], colour[2]}));
  }
  return labels;
}

}  // namespace pcednet::truth
