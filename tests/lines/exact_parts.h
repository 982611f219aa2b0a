#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "made_clouds.h"
#include "pcednet/lines/exact/edges.h"

namespace pcednet::lines {

inline constexpr double kTurn = 2.0 * std::numbers::pi;

/// Parts of one point per unit of area.
struct PlanePart : Cloud {
  Random random = Random(7);

  PlanePart() { spacing = 1.0; }

  /// A parallelogram, labelled along its rim, or not at all.
  void add_face(const Vec3& corner, const Vec3& u, const Vec3& v, bool labelled = true) {
    const Vec3 normal = u.cross(v);
    const auto count = static_cast<int>(normal.norm());
    for (int i = 0; i < count; ++i) {
      const double s = random.uniform(), t = random.uniform();
      const double from_rim =
          std::min(std::min(s, 1.0 - s) * u.norm(), std::min(t, 1.0 - t) * v.norm());
      add(corner + s * u + t * v, normal.normalized(), labelled && from_rim < kNear);
    }
  }
  void add_box(const Vec3& corner, const Vec3& size, bool labelled = true) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 u = Vec3::Zero(), v = Vec3::Zero(), far = Vec3::Zero();
      u[(axis + 1) % 3] = size[(axis + 1) % 3];
      v[(axis + 2) % 3] = size[(axis + 2) % 3];
      far[axis] = size[axis];
      add_face(corner, u, v, labelled);
      add_face(corner + far, u, v, labelled);
    }
  }
  ExactEdges edges() const {
    return find_exact_edges(OrderedPoints({positions, normals, classes}), spacing, nullptr);
  }
  std::vector<Piece> of_kind(CurveKind kind) const {
    std::vector<Piece> pieces = edges().pieces;
    std::erase_if(pieces, [&](const Piece& piece) { return piece.fit.kind != kind; });
    return pieces;
  }
  std::vector<Piece> folds() const { return of_kind(CurveKind::kSegment); }
  std::vector<Piece> arcs() const { return of_kind(CurveKind::kArc); }
};

/// The same points the other way round, with opposite normals.
inline PlanePart turned_round(const PlanePart& part) {
  PlanePart turned;
  for (std::size_t i = part.positions.size(); i-- > 0;) {
    turned.add(part.positions[i], -part.normals[i], part.classes[i] == kSharpEdge);
  }
  return turned;
}

/// The side and the top of a column with so many sides; round for none.
inline PlanePart column(int sides, double radius, double height) {
  PlanePart part;
  const auto place = [&](double turn) {
    const double angle = kTurn * turn;
    if (sides == 0) return Vec3(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    const double side = std::floor(turn * sides), share = turn * sides - side;
    const auto corner = [&](double k) {
      return Vec3(radius * std::cos(kTurn * k / sides), radius * std::sin(kTurn * k / sides), 0.0);
    };
    return Vec3((1.0 - share) * corner(side) + share * corner(side + 1.0));
  };
  for (int i = 0; i < static_cast<int>(kTurn * radius * height); ++i) {
    const Vec3 at = place(part.random.uniform());
    const double down = height * part.random.uniform();
    part.add(at - down * Vec3::UnitZ(), at.normalized(), down < kNear);
  }
  for (int i = 0; i < static_cast<int>(0.5 * kTurn * radius * radius); ++i) {
    const double share = std::sqrt(part.random.uniform());
    part.add(share * place(part.random.uniform()), Vec3::UnitZ(), radius * (1.0 - share) < kNear);
  }
  return part;
}

}  // namespace pcednet::lines
