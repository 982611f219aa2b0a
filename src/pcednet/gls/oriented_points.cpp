#include "pcednet/gls/oriented_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/core/half_space.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::gls {
namespace {

/// An order of normals that a flip of all of them preserves, except for exactly opposite ones.
bool is_less(const Vec3& a, const Vec3& b) {
  const Vec3 p = upward(a), q = upward(b);
  if (p == q) return points_down(a) && !points_down(b);
  return is_before(p, q);
}

bool are_copies(OrientedPoints points, std::uint32_t i, std::uint32_t j) {
  if (points.positions[i] != points.positions[j]) return false;
  const Vec3 &n = points.normals[i], &m = points.normals[j];
  return is_usable(n) ? n == m : !is_usable(m);
}

void refuse(const std::string& why) {
  throw Error(ErrorKind::kUsage, why);
}

}  // namespace

void check(OrientedPoints points, const ScaleSpaceOptions& options) {
  if (points.positions.size() != points.normals.size()) {
    refuse(fmt::format("{} positions with {} normals", points.positions.size(),
                       points.normals.size()));
  }
  if (points.positions.size() >= kNowhere) refuse("more than 2^32 - 2 points");
  if (options.max_projection_steps < 0) refuse("max_projection_steps is negative");
  for (const auto& gate : {options.side_gate, options.second_gate}) {
    if (gate && !(std::abs(*gate) <= 1.0)) {
      refuse(fmt::format("the side gate {} is not within -1 to 1", *gate));
    }
  }
  if (options.second_gate && !options.side_gate) refuse("a second gate without a first");
  if (!(options.eps >= 0.01 && options.eps <= 1.0)) {
    refuse(fmt::format("eps {} is not within 0.01 to 1", options.eps));
  }
  for (std::size_t i = 0; i < points.normals.size(); ++i) {
    const Vec3& n = points.normals[i];
    if (is_usable(n) && !(std::abs(n.squaredNorm() - 1.0) <= 2e-3)) {
      refuse(fmt::format("the normal of point {} has length {}, not 1", i, n.norm()));
    }
  }
}

PointOrder point_order(OrientedPoints points) {
  const auto usable = [&](std::uint32_t i) {
    return is_usable(points.normals[i]) ? points.normals[i] : Vec3::Zero().eval();
  };
  std::vector<std::uint32_t> order(points.curve.begin(), points.curve.end());
  if (order.empty()) order = spatial::curve_order(points.positions);
  if (!spatial::have_copies(points.positions, order)) return {std::move(order), false};
  for (auto first = order.begin(); first != order.end();) {
    const auto last = std::find_if(first + 1, order.end(), [&](std::uint32_t i) {
      return points.positions[i] != points.positions[*first];
    });
    if (last - first > 1) {
      std::sort(first, last,
                [&](std::uint32_t i, std::uint32_t j) { return is_less(usable(i), usable(j)); });
    }
    first = last;
  }
  return {std::move(order), true};
}

std::vector<std::uint32_t> places_in(std::span<const std::uint32_t> order, std::size_t count) {
  std::vector<std::uint32_t> places(count, kNowhere);
  for (std::size_t i = 0; i < order.size(); ++i) places[order[i]] = static_cast<std::uint32_t>(i);
  return places;
}

std::vector<std::uint32_t> distinct_points(OrientedPoints points, const PointOrder& ordered) {
  const std::vector<std::uint32_t>& order = ordered.order;
  if (!ordered.shares_places) return order;
  std::vector<std::uint32_t> distinct;
  distinct.reserve(order.size());
  for (const std::uint32_t i : order) {
    if (distinct.empty() || !are_copies(points, distinct.back(), i)) distinct.push_back(i);
  }
  return distinct;
}

void add_copies(OrientedPoints points, std::span<const std::uint32_t> distinct,
                std::vector<std::uint32_t>& order, std::span<std::uint32_t> places) {
  if (distinct.size() < order.size()) {
    std::uint32_t original = order.front();
    for (const std::uint32_t i : order) {
      if (are_copies(points, original, i)) {
        places[i] = places[original];
      } else {
        original = i;
      }
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t i, std::uint32_t j) { return places[i] < places[j]; });
  } else {
    order.assign(distinct.begin(), distinct.end());
  }
}

std::vector<Visit> plan_visits(std::span<const std::uint32_t> targets,
                               std::span<const std::uint32_t> places) {
  std::vector<Visit> visits;
  visits.reserve(targets.size());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (targets[i] >= places.size()) {
      refuse(fmt::format("there is no point {} among {}", targets[i], places.size()));
    }
    visits.push_back({places[targets[i]], i});
  }
  const auto is_before = [](const Visit& a, const Visit& b) {
    return a.place != b.place ? a.place < b.place : a.row < b.row;
  };
  if (!std::is_sorted(visits.begin(), visits.end(), is_before)) {
    std::sort(visits.begin(), visits.end(), is_before);
  }
  return visits;
}

void check_room(std::size_t targets, std::size_t scales, std::size_t width, std::size_t features,
                std::size_t statuses) {
  if (features == targets * scales * width && statuses == targets * scales) return;
  refuse(fmt::format("{} targets need {} features and {} statuses, not {} and {}", targets,
                     targets * scales * width, targets * scales, features, statuses));
}

}  // namespace pcednet::gls
