#include "workbench/render/near_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pcednet/core/parallel.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::render {
namespace {

constexpr std::size_t kWindow = 8;  // points to each side along each curve
constexpr std::size_t kCurves = 3;
constexpr std::size_t kQueriesAtOnce = 4096;

struct Candidate {
  double sq_distance;
  std::uint32_t index;
  bool operator==(const Candidate&) const = default;
  bool operator<(const Candidate& other) const {
    if (sq_distance != other.sq_distance) return sq_distance < other.sq_distance;
    return index < other.index;
  }
};

/// A curve through the points, turned a little, so that no two curves are cut at the same places.
struct Curve {
  std::vector<std::uint32_t> order, rank;

  Curve(std::span<const Vec3> positions, double turn) : rank(positions.size()) {
    const Mat3 rotation(Eigen::AngleAxisd(turn, Vec3(0.48, 0.60, 0.64)));
    std::vector<Vec3> turned(positions.begin(), positions.end());
    for (Vec3& p : turned) p = rotation * p;
    order = spatial::curve_order(turned);
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<std::uint32_t>(i);
  }
};

/// The least candidates seen so far, sorted, each once.
struct Least {
  std::array<Candidate, NearPoints::kMost> found;
  std::size_t count = 0;

  void offer(const Candidate& candidate) {
    if (count == found.size() && !(candidate < found.back())) return;
    std::size_t place = count;
    while (place > 0 && candidate < found[place - 1]) --place;
    if (place > 0 && candidate == found[place - 1]) return;
    count = std::min(count + 1, found.size());
    for (std::size_t k = count - 1; k > place; --k) found[k] = found[k - 1];
    found[place] = candidate;
  }
};

NearPoints nearest(std::span<const Vec3> positions, std::span<const Curve> curves, std::size_t i) {
  Least least;
  for (const Curve& curve : curves) {
    const std::size_t rank = curve.rank[i];
    const std::size_t begin = rank > kWindow ? rank - kWindow : 0;
    const std::size_t end = std::min(positions.size(), rank + kWindow + 1);
    for (std::size_t r = begin; r < end; ++r) {
      const std::uint32_t other = curve.order[r];
      const double sq_distance = (positions[other] - positions[i]).squaredNorm();
      if (sq_distance > 0.0) least.offer({sq_distance, other});
    }
  }
  NearPoints near;
  near.count = static_cast<std::uint32_t>(least.count);
  for (std::size_t k = 0; k < least.count; ++k) {
    near.index[k] = least.found[k].index;
    near.distance[k] = static_cast<float>(std::sqrt(least.found[k].sq_distance));
  }
  return near;
}

}  // namespace

std::vector<NearPoints> near_points(std::span<const Vec3> positions) {
  std::vector<Curve> curves;
  for (std::size_t c = 0; c < kCurves; ++c) curves.emplace_back(positions, 0.7 * c);
  std::vector<NearPoints> near(positions.size());
  parallel_blocks(positions.size(), kQueriesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) near[i] = nearest(positions, curves, i);
  });
  return near;
}

}  // namespace pcednet::render
