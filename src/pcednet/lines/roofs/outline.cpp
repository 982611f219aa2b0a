#include "pcednet/lines/roofs/outline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "pcednet/core/vec3.h"
#include "pcednet/lines/curves/curve.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {
namespace {

/// Directions of the disc's centre from a point in which the disc holds no other point. It rolls
/// from touching `before` to touching `after`.
struct Rest {
  std::size_t point, before, after;
  double middle;
};

/// A range of directions in which another point is in the disc.
struct Blocked {
  double from, to;
  std::size_t by;
};

void add_rests(std::size_t point, std::vector<Blocked>& blocked, std::vector<Rest>& rests) {
  std::sort(blocked.begin(), blocked.end(), [](const Blocked& a, const Blocked& b) {
    return std::pair(a.from, a.by) < std::pair(b.from, b.by);
  });
  Blocked last = *std::max_element(blocked.begin(), blocked.end(),
                                   [](const auto& a, const auto& b) { return a.to < b.to; });
  last.to -= kWholeTurn;
  for (const Blocked& next : blocked) {
    if (next.from > last.to) {
      rests.push_back({point, last.by, next.by, 0.5 * (last.to + next.from)});
    }
    if (next.to > last.to) last = next;
  }
}

std::vector<Rest> rests_of(std::span<const Eigen::Vector2d> points, double radius) {
  std::vector<Vec3> places;
  for (const auto& point : points) places.emplace_back(point.x(), point.y(), 0.0);
  const spatial::KdTree tree(places);
  std::vector<Rest> rests;
  std::vector<spatial::Neighbour> near;
  std::vector<Blocked> blocked;
  for (std::size_t i = 0; i < points.size(); ++i) {
    tree.within(places[i], 2.0 * radius, near);
    blocked.clear();
    for (const spatial::Neighbour& other : near) {
      if (other.index == i || !(other.sq_distance > 0.0)) continue;
      const Eigen::Vector2d to = points[other.index] - points[i];
      const double half = std::acos(std::min(1.0, 0.5 * to.norm() / radius));
      const double angle = std::atan2(to.y(), to.x());
      const double from =
          angle - half < -std::numbers::pi ? angle - half + kWholeTurn : angle - half;
      blocked.push_back({from, from + 2.0 * half, other.index});
    }
    if (!blocked.empty()) add_rests(i, blocked, rests);
  }
  return rests;
}

}  // namespace

std::vector<std::vector<OutlinePoint>> outlines(std::span<const Eigen::Vector2d> points,
                                                double radius) {
  const std::vector<Rest> rests = rests_of(points, radius);
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> entered;  // (before, point)
  for (std::size_t r = 0; r < rests.size(); ++r) {
    entered.emplace(std::pair(rests[r].before, rests[r].point), r);
  }
  // Each rest's next; those that no other leads to come first.
  constexpr auto kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> next(rests.size(), kNone);
  std::vector<bool> led_to(rests.size()), used(rests.size());
  for (std::size_t r = 0; r < rests.size(); ++r) {
    const auto found = entered.find({rests[r].point, rests[r].after});
    if (found == entered.end() || led_to[found->second]) continue;
    next[r] = found->second;
    led_to[found->second] = true;
  }
  std::vector<std::vector<OutlinePoint>> chains;
  for (const bool loops : {false, true}) {
    for (std::size_t start = 0; start < rests.size(); ++start) {
      if (used[start] || led_to[start] != loops) continue;
      std::vector<OutlinePoint> chain;
      for (std::size_t r = start; r != kNone && !used[r]; r = next[r]) {
        used[r] = true;
        chain.push_back({rests[r].point, {std::cos(rests[r].middle), std::sin(rests[r].middle)}});
      }
      chains.push_back(std::move(chain));
    }
  }
  return chains;
}

}  // namespace pcednet::lines
