#include "pcednet/detect/crease_kind.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pcednet/core/parallel.h"
#include "pcednet/detect/crease_distance.h"
#include "pcednet/detect/decide.h"

namespace pcednet::detect {
namespace {

// For log-odds, see the header.
constexpr double kOfNetworks = 0.55, kIfNear = 1.0, kIfFar = -2.15;
constexpr double kSurestKind = 1e-4;  ///< probability that the networks' log-odds are cut at

// For distances.
constexpr double kBetween = 0.48, kChange = 0.02;

/// The share of sharp-edge in the probability of an edge.
double share_of_sharp(double by_networks, double distance) {
  const double share = std::clamp(by_networks, kSurestKind, 1.0 - kSurestKind);
  const double is_far = 1.0 / (1.0 + std::exp((kBetween - distance) / kChange));
  const double log_odds =
      kOfNetworks * std::log(share / (1.0 - share)) + kIfNear + (kIfFar - kIfNear) * is_far;
  return 1.0 / (1.0 + std::exp(-log_odds));
}

void decide_kind(std::size_t point, double distance, Classification& found) {
  float &sharp = found.p_sharp[point], &smooth = found.p_smooth[point];
  const float edge = sharp + smooth;
  const double share = share_of_sharp(static_cast<double>(sharp / edge), distance);
  sharp = static_cast<float>(share) * edge;
  smooth = edge - sharp;
  std::uint8_t& its_class = found.classes[point];
  if (its_class == kNonEdge) return;
  its_class = sharp >= smooth ? kSharpEdge : kSmoothEdge;
  if (!found.p_class.empty()) found.p_class[point] = std::max(sharp, smooth);
}

}  // namespace

void apply_crease_kind(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
                       double smallest_scale, float least_edge, Classification& found) {
  std::vector<std::uint8_t> wanted(positions.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const bool may_be_edge = found.p_sharp[i] + found.p_smooth[i] >= least_edge;
    wanted[i] = may_be_edge && found.classes[i] <= kSharpEdge ? 1 : 0;
  }
  const std::vector<float> distances = crease_distances(positions, curve, wanted, smallest_scale);
  constexpr std::size_t kPointsOfTask = 1 << 12;
  parallel_blocks(wanted.size(), kPointsOfTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (std::isfinite(distances[i])) decide_kind(i, static_cast<double>(distances[i]), found);
    }
  });
}

}  // namespace pcednet::detect
