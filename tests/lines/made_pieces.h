#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// A straight piece with nodes about one apart; its wedge is open to `side_a` and `side_b`.
inline Piece straight(const Vec3& from, const Vec3& to, const Vec3& side_a = Vec3::UnitZ(),
                      const Vec3& side_b = -Vec3::UnitZ()) {
  Piece piece;
  const auto steps = static_cast<int>(std::round((to - from).norm()));
  for (int i = 0; i <= steps; ++i) {
    piece.nodes.push_back({.at = from + (to - from) * i / steps,
                           .along = (to - from).normalized(),
                           .side_a = side_a,
                           .side_b = side_b,
                           .spacing = 1.0});
  }
  piece.fit = fit_segment(piece.nodes);
  piece.ends = {from, to};
  return piece;
}

/// Along the x axis, its wedge open to y and z.
inline Piece straight_along_x(double from, double to) {
  return straight(from * Vec3::UnitX(), to * Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ());
}

/// Part of the circle of this radius about the z axis, nodes one apart, off it by `off` in turn;
/// its wedge is open outwards and upwards.
inline Piece round_about_z(double radius, double height, double from, double to, double off = 0.0) {
  Piece piece;
  double sign = 1.0;
  for (double t = from; t <= to; t += 1.0 / radius) {
    const Vec3 out(std::cos(t), std::sin(t), 0);
    sign = -sign;
    piece.nodes.push_back({.at = (radius + sign * off) * out + height * Vec3::UnitZ(),
                           .along = {-std::sin(t), std::cos(t), 0},
                           .side_a = out,
                           .side_b = Vec3::UnitZ(),
                           .spacing = 1.0});
  }
  piece.fit = fit_arc(piece.nodes);
  piece.ends = {piece.nodes.front().at, piece.nodes.back().at};
  return piece;
}

inline OrderedPoints no_points() {
  return OrderedPoints(EdgePoints{});
}

/// Sharp-edge points one apart along a circle about the z axis.
struct EdgeRing {
  EdgeRing(double radius, double height) {
    for (double t = 0.0; t < 6.28; t += 1.0 / radius) {
      positions.emplace_back(radius * std::cos(t), radius * std::sin(t), height);
    }
    normals.assign(positions.size(), Vec3::UnitZ());
    classes.assign(positions.size(), kSharpEdge);
  }
  OrderedPoints points() const { return OrderedPoints({positions, normals, classes}); }

  std::vector<Vec3> positions, normals;
  std::vector<std::uint8_t> classes;
};

}  // namespace pcednet::lines
