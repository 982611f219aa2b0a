#include "pcednet/tiles/las_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pcednet/io/las/file.h"

namespace pcednet::tiles {
namespace {

/// Scale and offset along an axis.
struct Steps {
  double scale = 1.0, offset = 0.0;

  /// Whether 32 bits hold the coordinates from `least` to `most`.
  bool hold(double least, double most) const {
    const double a = std::round((least - offset) / scale);
    const double b = std::round((most - offset) / scale);
    return std::min(a, b) >= INT32_MIN && std::max(a, b) <= INT32_MAX;
  }
  /// Whether they coincide with steps of `into`.
  bool fit(const Steps& into) const {
    const double steps = (offset - into.offset) / into.scale;
    const double ratio = scale / into.scale;
    return std::abs(steps - std::round(steps)) <= 1e-3 &&
           std::abs(ratio - std::round(ratio)) <= 1e-9;
  }
};

std::vector<Steps> steps_along(std::size_t axis, const std::vector<io::LasFile>& files) {
  std::vector<Steps> steps;
  for (const io::LasFile& file : files) steps.push_back({file.scale(axis), file.offset(axis)});
  return steps;
}

void note_rounding(const char* why, double coarsest, Plan& plan) {
  plan.notes.push_back(fmt::format("{}: coordinates are rounded to steps of {:g}", why, coarsest));
}

}  // namespace

void choose_las_steps(const std::vector<IndexedInput>& inputs, Plan& plan) {
  std::vector<io::LasFile> files;
  for (const IndexedInput& input : inputs) {
    io::LasFile file = io::attached_las_file(input.outline);
    if (file.header.empty()) return;
    files.push_back(std::move(file));
  }
  double coarsest = 0.0;
  bool widened = false, rounded = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<Steps> all = steps_along(axis, files);
    Steps chosen = *std::min_element(all.begin(), all.end(), [](const Steps& a, const Steps& b) {
      return std::abs(a.scale) < std::abs(b.scale);
    });
    const int a = static_cast<int>(axis);
    while (files.size() > 1 && !plan.box.empty() &&
           !chosen.hold(plan.box.min[a], plan.box.max[a])) {
      chosen.scale *= 10.0;
      widened = true;
    }
    rounded = rounded || !std::all_of(all.begin(), all.end(),
                                      [&](const Steps& its) { return its.fit(chosen); });
    plan.las_steps.insert(plan.las_steps.end(), {chosen.scale, chosen.offset});
    coarsest = std::max(coarsest, std::abs(chosen.scale));
  }
  if (widened) {
    note_rounding("no steps of the inputs hold them all in 32 bits", coarsest, plan);
  } else if (rounded) {
    note_rounding("the inputs have different scales and offsets", coarsest, plan);
  }
}

}  // namespace pcednet::tiles
