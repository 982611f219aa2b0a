#include "pcednet/detect/octaves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "pcednet/core/median.h"
#include "pcednet/core/parallel_loops.h"
#include "pcednet/detect/part_of_cloud.h"
#include "pcednet/gls/scales.h"
#include "pcednet/normals/neighbour_count.h"
#include "pcednet/normals/neighbour_graph.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kForSpacing = gls::kSpacingNeighbours - 1;

/// The mean distance of every point of the graph to its neighbours.
std::vector<double> spacings_in(const normals::NeighbourGraph& graph) {
  std::vector<double> spacings(graph.points.size());
  parallel_for_each(spacings.size(), [&](std::size_t i) {
    double sum = 0.0;
    for (const std::uint32_t k : graph.of(i)) sum += (graph.points[k] - graph.points[i]).norm();
    spacings[i] = sum / static_cast<double>(graph.degree);
  });
  return spacings;
}

std::uint8_t octave_of(double spacing, const gls::ScaleRange& range) {
  const double octave = std::round(std::log2(spacing / range.s_min));
  const auto last = static_cast<double>(gls::octave_count(range) - 1);
  return static_cast<std::uint8_t>(std::clamp(octave, 0.0, last));
}

std::vector<std::uint32_t> chosen_of(std::span<const std::uint32_t> order,
                                     std::span<const std::uint8_t> octaves, std::size_t octave,
                                     const PartOfCloud* part) {
  std::vector<std::uint32_t> chosen;
  std::copy_if(order.begin(), order.end(), std::back_inserter(chosen), [&](std::uint32_t i) {
    return (octaves.empty() ? 0u : octaves[i]) == octave && (!part || part->wanted[i] != 0);
  });
  return chosen;
}

}  // namespace

std::vector<std::uint8_t> octaves_of(std::span<const Vec3> positions,
                                     std::span<const std::uint32_t> curve,
                                     const gls::ScaleRange& range) {
  const auto graph = normals::make_neighbour_graph(positions, normals::NeighbourChoice{kForSpacing},
                                                   nullptr, curve);
  std::vector<std::uint8_t> octaves(positions.size(), 0);
  if (graph.degree == 0) return octaves;
  const std::vector<double> spacings = spacings_in(graph);
  std::vector<std::uint8_t> found(spacings.size());
  parallel_for_each(found.size(), [&](std::size_t i) {
    std::vector<double> around;
    for (const std::uint32_t k : graph.of(i)) around.push_back(spacings[k]);
    found[i] = octave_of(upper_median(std::move(around)), range);
  });
  parallel_for_each(octaves.size(), [&](std::size_t i) {
    if (graph.point_of[i] != normals::kNoPoint) octaves[i] = found[graph.point_of[i]];
  });
  return octaves;
}

void for_each_octave(
    const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor, const Progress* progress,
    const std::function<void(const gls::ScaleSpace&, std::span<const std::uint32_t>)>& work) {
  const PartOfCloud* const part = cloud.part;
  const auto plan_of = [&](std::size_t octave) { return part ? &part->pyramids[octave] : nullptr; };
  gls::ScaleSpace space({cloud.positions, cloud.normals, cloud.curve, plan_of(0)}, descriptor,
                        progress);
  const std::size_t count = gls::octave_count(space.range());
  std::vector<std::uint8_t> octaves;
  if (count > 1) octaves = octaves_of(cloud.positions, cloud.curve, space.range());
  if (octaves.empty() && !part) return work(space, space.order());
  const Progress cancel_only = without_report(progress);
  for (std::size_t octave = 0; octave < count; ++octave) {
    const auto chosen = chosen_of(space.order(), octaves, octave, part);
    if (octave > 0 && chosen.empty()) continue;
    if (octave > 0) space.take_octave(octave, plan_of(octave), &cancel_only);
    work(space, chosen);
  }
}

}  // namespace pcednet::detect
