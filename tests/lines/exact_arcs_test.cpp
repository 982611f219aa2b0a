#include <gtest/gtest.h>

#include <functional>

#include "exact_parts.h"
#include "pcednet/lines/curves/curve.h"

namespace pcednet::lines {
namespace {

using SurfacePlace = std::function<Vec3(double, double)>;

/// Points of a surface over the unit square, at the edge where it says so.
void add_surface(PlanePart& part, double area, const SurfacePlace& place,
                 const std::function<bool(const Vec3&)>& is_edge) {
  for (int i = 0; i < static_cast<int>(area); ++i) {
    const double u = part.random.uniform(), v = part.random.uniform();
    const Vec3 at = place(u, v);
    part.add(at, Vec3::UnitZ(), is_edge(at));  // its normals are not used
  }
}

Vec3 around(double radius, double turn, double z) {
  return {radius * std::cos(kTurn * turn), radius * std::sin(kTurn * turn), z};
}

double radius_at(const Vec3& place) {
  return std::hypot(place.x(), place.y());
}

/// A square plane of this half side with a hole about the z axis.
void add_holed_plane(PlanePart& part, double half, double radius, double z) {
  for (int i = 0; i < static_cast<int>(4.0 * half * half); ++i) {
    const double y = half * (2.0 * part.random.uniform() - 1.0);
    const double x = half * (2.0 * part.random.uniform() - 1.0);
    const Vec3 at(x, y, z);
    if (radius_at(at) > radius) part.add(at, Vec3::UnitZ(), radius_at(at) < radius + kNear);
  }
}

/// A surface about the z axis, its profile a segment from (radius, z) to another.
void add_ring(PlanePart& part, double radius, double z, double to_radius, double to_z,
              double turn = 1.0) {
  const double area =
      0.5 * kTurn * turn * (radius + to_radius) * std::hypot(to_radius - radius, to_z - z);
  const auto near_end = [&](const Vec3& at) {
    const Eigen::Vector2d here(radius_at(at), at.z());
    return std::min((here - Eigen::Vector2d(radius, z)).norm(),
                    (here - Eigen::Vector2d(to_radius, to_z)).norm()) < kNear;
  };
  add_surface(
      part, area,
      [&](double u, double v) {
        return around(radius + v * (to_radius - radius), turn * u, z + v * (to_z - z));
      },
      near_end);
}

bool has_circle(const std::vector<Piece>& arcs, double radius, double z) {
  return std::ranges::any_of(arcs, [&](const Piece& arc) {
    return arc.closed && std::abs(arc.fit.radius - radius) < 1e-3 &&
           (arc.fit.point - z * Vec3::UnitZ()).norm() < 1e-3;
  });
}

TEST(ExactArcs, AreTheRimsOfBores) {
  for (const double radius : {1.2, 2.0, 7.0}) {
    PlanePart plate;
    add_holed_plane(plate, 15.0, radius, 0.0);
    add_holed_plane(plate, 15.0, radius, -6.0);
    add_ring(plate, radius, 0.0, radius, -6.0);
    const std::vector<Piece> arcs = plate.arcs();
    EXPECT_EQ(arcs.size(), 2u) << radius;
    EXPECT_TRUE(has_circle(arcs, radius, 0.0)) << radius;
    EXPECT_TRUE(has_circle(arcs, radius, -6.0)) << radius;
    for (const Piece& arc : arcs) {
      EXPECT_TRUE(arc.exact);
      EXPECT_NEAR(dihedral_angle(arc.middle().side_a, arc.middle().side_b), 0.25 * kTurn, 1e-6);
    }
  }
}

TEST(ExactArcs, AreTheRimsOfPins) {
  const std::vector<Piece> arcs = column(0, 12.0, 15.0).arcs();
  EXPECT_EQ(arcs.size(), 1u);
  EXPECT_TRUE(has_circle(arcs, 12.0, 0.0));
}

/// A quarter of a column: a rounded corner of radius 5 without the walls beside it.
PlanePart rounded_corner(bool labelled) {
  PlanePart part;
  add_ring(part, 5.0, 0.0, 5.0, -10.0, 0.25);
  add_ring(part, 0.0, 0.0, 5.0, 0.0, 0.25);
  for (auto& edge_class : part.classes) {
    if (!labelled) edge_class = kNonEdge;
  }
  return part;
}

TEST(ExactArcs, GoAsFarAsTheSurfaces) {
  const std::vector<Piece> arcs = rounded_corner(true).arcs();
  ASSERT_EQ(arcs.size(), 1u);
  const Piece& arc = arcs[0];
  EXPECT_FALSE(arc.closed);
  EXPECT_NEAR(arc.fit.radius, 5.0, 1e-3);
  EXPECT_GT(length_of(arc), 0.7 * 0.25 * kTurn * 5.0);
  EXPECT_LT(length_of(arc), 0.25 * kTurn * 5.0 + 1e-6);
  for (const Vec3& end : arc.ends) {
    EXPECT_NEAR(radius_at(end), 5.0, 1e-3);
    EXPECT_NEAR(end.z(), 0.0, 1e-3);
  }
}

TEST(ExactArcs, NeedPointsThatMayBeOfAnEdge) {
  EXPECT_TRUE(rounded_corner(false).edges().pieces.empty());
}

TEST(ExactArcs, AreAtBothEndsOfAChamfer) {
  for (const double wide : {0.7, 1.2, 1.8}) {
    PlanePart bore;
    add_holed_plane(bore, 15.0, 4.0 + wide, 0.0);
    add_ring(bore, 4.0 + wide, 0.0, 4.0, -wide);
    add_ring(bore, 4.0, -wide, 4.0, -10.0);
    const ExactEdges edges = bore.edges();
    EXPECT_EQ(edges.pieces.size(), 2u) << wide;
    EXPECT_TRUE(has_circle(edges.pieces, 4.0 + wide, 0.0)) << wide;
    EXPECT_TRUE(has_circle(edges.pieces, 4.0, -wide)) << wide;
    EXPECT_TRUE(has_circle(edges.cut_off, 4.0, 0.0)) << wide;
  }
}

TEST(ExactArcs, AreNotAtARoundedRim) {
  for (const double rounding : {0.4, 0.8, 1.5}) {
    PlanePart pin;
    const double inner = 12.0 - rounding;
    add_ring(pin, 0.0, 0.0, inner, 0.0);
    add_ring(pin, 12.0, -rounding, 12.0, -10.0);
    add_surface(
        pin, 0.25 * kTurn * rounding * kTurn * 12.0,
        [&](double u, double v) {
          const double angle = 0.25 * kTurn * v;
          return around(inner + rounding * std::sin(angle), u, rounding * (std::cos(angle) - 1.0));
        },
        [](const Vec3&) { return true; });
    EXPECT_TRUE(pin.arcs().empty()) << rounding;
  }
}

/// A disc whose rim a notch of this width divides.
PlanePart notched_disc(double width) {
  PlanePart whole = column(0, 15.0, 8.0), part;
  const double half = 0.5 * width, floor = 11.0;
  for (std::size_t i = 0; i < whole.positions.size(); ++i) {
    const Vec3& at = whole.positions[i];
    if (at.x() > floor && std::abs(at.y()) < half) continue;
    part.add(at, whole.normals[i], whole.classes[i] == kSharpEdge);
  }
  for (const double y : {-half, half}) {
    part.add_face({floor, y, -8.0}, {15.0 - floor, 0.0, 0.0}, {0.0, 0.0, 8.0});
  }
  part.add_face({floor, -half, -8.0}, {0.0, width, 0.0}, {0.0, 0.0, 8.0});
  return part;
}

TEST(ExactArcs, EndAtANotch) {
  const std::vector<Piece> arcs = notched_disc(5.0).arcs();
  ASSERT_EQ(arcs.size(), 1u);
  EXPECT_FALSE(arcs[0].closed);
  EXPECT_NEAR(length_of(arcs[0]), kTurn * 15.0 - 5.0, 3.0);
  for (const Vec3& end : arcs[0].ends) EXPECT_NEAR(std::abs(end.y()), 2.5, 2.0);
}

TEST(ExactArcs, AreTheSameForAnyOrderOfThePoints) {
  const PlanePart part = notched_disc(5.0);
  const std::vector<Piece> arcs = part.arcs(), others = turned_round(part).arcs();
  ASSERT_EQ(arcs.size(), others.size());
  for (std::size_t i = 0; i < arcs.size(); ++i) EXPECT_EQ(arcs[i].ends, others[i].ends);
}

/// Circles at the foot of a pin on a plane: its points are up to `facet` within a circle that grows
/// by `lean` of the height.
std::ptrdiff_t circles_around_a_pin(double facet, double lean) {
  PlanePart part;
  add_holed_plane(part, 16.0, 10.0, 0.0);
  add_surface(
      part, kTurn * 10.0 * 6.0,
      [&](double u, double v) {
        const double height = 6.0 * v;
        return around(10.0 + lean * height - facet * part.random.uniform(), u, height);
      },
      [](const Vec3& at) { return at.z() < kNear; });
  return std::ranges::count_if(part.arcs(), &Piece::closed);
}

TEST(ExactArcs, AreFoundAtFacetsButNotAtCones) {
  EXPECT_EQ(circles_around_a_pin(0.0, 0.0), 1);
  EXPECT_EQ(circles_around_a_pin(0.02, 0.0), 1);
  EXPECT_EQ(circles_around_a_pin(0.0, 0.008), 0);
  EXPECT_EQ(circles_around_a_pin(0.0, 0.1), 0);
}

}  // namespace
}  // namespace pcednet::lines
