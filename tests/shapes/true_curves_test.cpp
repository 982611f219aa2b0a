#include "workbench/shapes/true_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "workbench/shapes/solids/cad_parts.h"
#include "workbench/shapes/solids/mesh_vertices.h"
#include "workbench/shapes/solids/part_pieces.h"
#include "workbench/shapes/surfaces/default_shapes.h"
#include "workbench/shapes/surfaces/polyhedra.h"
#include "workbench/shapes/surfaces/roofs.h"

namespace pcednet::shapes {
namespace {

using lines::Curve;
using lines::CurveKind;

std::vector<BorderPoint> borders_of(const Solid& solid, std::size_t samples = 20000) {
  return find_borders(solid, sample_solid(solid, samples, 3));
}

std::vector<Curve> curves_of(const Solid& solid) {
  return true_curves(solid, borders_of(solid));
}

std::vector<Curve> of_kind(const std::vector<Curve>& curves, CurveKind kind) {
  std::vector<Curve> found;
  for (const Curve& curve : curves) {
    if (curve.kind == kind) found.push_back(curve);
  }
  return found;
}

/// The distinct ends of curves; those of curves that meet are equal to the last bit.
std::vector<Vec3> corners_of(const std::vector<Curve>& curves) {
  std::vector<Vec3> corners;
  for (const Curve& curve : curves) {
    if (curve.closed) continue;
    for (const Vec3& end : {curve.points.front(), curve.points.back()}) {
      if (std::find(corners.begin(), corners.end(), end) == corners.end()) corners.push_back(end);
    }
  }
  return corners;
}

double distance_to(const Curve& curve, const Vec3& p) {
  if (curve.kind == CurveKind::kArc || curve.kind == CurveKind::kCircle) {
    const Vec3 x = (curve.points.front() - curve.centre).normalized();
    return distance(Arc{curve.centre, x, curve.axis.cross(x), curve.radius, lines::angle_of(curve)},
                    p);
  }
  const std::vector<Vec3> vertices = lines::sampled(curve, 1.0);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    least = std::min(least, distance(Segment{vertices[i - 1], vertices[i]}, p));
  }
  return least;
}

TEST(TrueCurves, OfABoxAreTwelveSegmentsBetweenEightCorners) {
  Solid part;
  part.add(box(0.5, 0.3, 0.2, {0.1, 0.2, 0.3}));
  const std::vector<Curve> curves = curves_of(part);
  ASSERT_EQ(curves.size(), 12u);
  EXPECT_EQ(of_kind(curves, CurveKind::kSegment).size(), 12u);
  const std::vector<Vec3> corners = corners_of(curves);
  EXPECT_EQ(corners.size(), 8u);
  for (const Vec3& corner : corners) {
    const Vec3 offset = (corner - Vec3(0.1, 0.2, 0.3)).cwiseAbs();
    EXPECT_LT((offset - Vec3(0.5, 0.3, 0.2)).norm(), 1e-9) << corner.transpose();
  }
  for (const Curve& curve : curves) {
    EXPECT_NEAR(curve.dihedral_angle, 0.5 * std::numbers::pi, 1e-6);
    EXPECT_EQ(curve.edge_class, kSharpEdge);
  }
}

TEST(TrueCurves, OfACylinderAreTwoCircles) {
  Solid part;
  part.add(cylinder(0.3, 0.2, along(0, {0.1, 0.0, 0.0})));
  const std::vector<Curve> curves = curves_of(part);
  ASSERT_EQ(curves.size(), 2u);
  for (const Curve& curve : curves) {
    EXPECT_EQ(curve.kind, CurveKind::kCircle);
    EXPECT_TRUE(curve.closed);
    EXPECT_NEAR(curve.radius, 0.3, 1e-9);
    EXPECT_NEAR(std::abs(curve.axis.x()), 1.0, 1e-9);
    EXPECT_NEAR(std::abs(curve.centre.x() - 0.1), 0.2, 1e-9);
    EXPECT_LT(curve.centre.tail<2>().norm(), 1e-9);
  }
}

TEST(TrueCurves, OfAPlateWithHolesHaveTheHoles) {
  Solid part;
  part.add(box(0.5, 0.4, 0.05, Vec3::Zero()));
  part.cut(cylinder(0.06, 0.2, at({0.2, 0.1, 0.0})));
  part.cut(prism(slot_profile({-0.2, -0.1}, {-0.2, 0.1}, 0.05), 0.2, at(Vec3::Zero())));
  const std::vector<Curve> curves = curves_of(part);
  EXPECT_EQ(of_kind(curves, CurveKind::kCircle).size(), 2u);
  // Where line and arc of a slot join smoothly its rim goes from one curve to the next.
  const std::vector<Curve> arcs = of_kind(curves, CurveKind::kArc);
  EXPECT_EQ(arcs.size(), 4u);
  EXPECT_EQ(of_kind(curves, CurveKind::kSegment).size(), 12u + 4u);
  EXPECT_EQ(curves.size(), 22u);
  EXPECT_EQ(corners_of(curves).size(), 8u + 8u);
  for (const Curve& arc : arcs) {
    EXPECT_NEAR(arc.radius, 0.05, 1e-9);
    EXPECT_NEAR(lines::angle_of(arc), std::numbers::pi, 1e-6);
    for (const Vec3& end : arc.points) {
      EXPECT_LT((end.cwiseAbs() - Vec3(end.x() < -0.2 ? 0.25 : 0.15, 0.1, 0.05)).norm(), 1e-7);
    }
  }
}

TEST(TrueCurves, LeaveOutTheBordersOfFillets) {
  Solid part;
  part.add(prism(rectangle(0.4, 0.3, CornerShape::kFillet, 0.1), 0.1, at(Vec3::Zero())));
  const std::vector<Curve> curves = curves_of(part);
  EXPECT_EQ(of_kind(curves, CurveKind::kSegment).size(), 8u);
  EXPECT_EQ(of_kind(curves, CurveKind::kArc).size(), 8u);
  EXPECT_EQ(curves.size(), 16u);
  EXPECT_EQ(corners_of(curves).size(), 16u);
  Solid rounded;
  rounded.add(cylinder(0.3, 0.2, at(Vec3::Zero()), CornerShape::kFillet, 0.05));
  EXPECT_TRUE(curves_of(rounded).empty());
}

TEST(TrueCurves, PassOverFacesOfTwoVolumesInOnePlane) {
  Solid part;  // a beam of two, with one top
  part.add(box(0.2, 0.1, 0.1, {-0.15, 0.0, 0.0}));
  part.add(box(0.2, 0.1, 0.1, {0.15, 0.0, 0.0}));
  EXPECT_EQ(curves_of(part).size(), 12u);
}

TEST(TrueCurves, AreAllSharpBordersOfEveryFamilyAndNothingElse) {
  for (int family = 0; family < kPartFamilies; ++family) {
    Random random(5, 100 * static_cast<std::uint64_t>(family) + 1);
    const Solid solid = random_part(family, random);
    const std::vector<BorderPoint> borders = borders_of(solid);
    const std::vector<Curve> curves = true_curves(solid, borders);
    std::size_t sharp = 0, off = 0;
    for (const BorderPoint& border : borders) {
      if (border.turn() < kSharpTurn) continue;
      ++sharp;
      off += std::none_of(curves.begin(), curves.end(), [&](const Curve& curve) {
        return distance_to(curve, border.position) < 2e-6;
      });
    }
    // Borders of conical rims about concave corners have no unbounded surface to follow.
    EXPECT_LE(off, sharp / 500) << part_family_name(family) << ": " << sharp;
    EXPECT_EQ(sharp == 0, curves.empty());
    for (const Curve& curve : curves) {
      EXPECT_GT(lines::length_of(curve), 1e-6);
      for (const Vec3& p : lines::sampled(curve, 1e-3)) {
        EXPECT_LT(std::abs(solid.value(p).distance), 1e-6)
            << part_family_name(family) << " " << p.transpose();
      }
    }
  }
}

TEST(TrueCurves, AreTheSameFromFewBorders) {
  Random random(5, 1);
  const Solid solid = random_part(0, random);
  const std::vector<BorderPoint> borders = borders_of(solid);
  std::vector<BorderPoint> few;
  for (std::size_t i = 0; i < borders.size(); i += 4) few.push_back(borders[i]);
  EXPECT_EQ(true_curves(solid, few).size(), true_curves(solid, borders).size());
}

TEST(TrueCurves, OfAShapeJoinWhatIsOneEdge) {
  const std::vector<EdgeCurve> edges = {
      {Segment{{0, 0, 0}, {1, 0, 0}}},
      {Segment{{2, 0, 0}, {1, 0, 0}}},               // goes on
      {Segment{{2, 0, 0}, {2, 1, 0}}},               // a corner
      {Segment{{2, 1, 0}, {2, 2, 0}}, kSmoothEdge},  // of another class
      {Segment{{0, 5, 0}, {1, 5, 0}}},               // three meet:
      {Segment{{1, 5, 0}, {2, 5, 0}}},
      {Segment{{1, 5, 0}, {1, 6, 0}}},
      {Arc{{9, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2.0, std::numbers::pi}},
      {Arc{{9, 0, 0}, {-1, 0, 0}, {0, -1, 0}, 2.0, std::numbers::pi}},
      {Arc{{0, 0, 9}, {1, 0, 0}, {0, 1, 0}, 2.0, 0.5 * std::numbers::pi}}};
  const std::vector<Curve> curves = true_curves(edges);
  ASSERT_EQ(curves.size(), 8u);
  const std::vector<Curve> segments = of_kind(curves, CurveKind::kSegment);
  ASSERT_EQ(segments.size(), 6u);
  EXPECT_DOUBLE_EQ(lines::length_of(segments[0]), 2.0);
  EXPECT_EQ(segments[2].edge_class, kSmoothEdge);
  const std::vector<Curve> circles = of_kind(curves, CurveKind::kCircle);
  ASSERT_EQ(circles.size(), 1u);
  EXPECT_NEAR(circles[0].radius, 2.0, 1e-9);
  EXPECT_LT((circles[0].centre - Vec3(9, 0, 0)).norm(), 1e-9);
  const std::vector<Curve> arcs = of_kind(curves, CurveKind::kArc);
  ASSERT_EQ(arcs.size(), 1u);
  EXPECT_NEAR(lines::length_of(arcs[0]), std::numbers::pi, 1e-9);
}

TEST(TrueCurves, OfAConeDoNotHaveItsApex) {
  const std::vector<Curve> curves = true_curves(cone_on_plate().edges);
  EXPECT_EQ(curves.size(), 3u);
  EXPECT_EQ(of_kind(curves, CurveKind::kCircle).size(), 3u);
}

TEST(TrueCurves, OfAChainOfChordsAreOneCurve) {
  std::vector<EdgeCurve> helix, ring;
  const auto on = [](int i, double rise) {
    const double t = 0.1 * i;
    return Vec3(std::cos(t), std::sin(t), rise * t);
  };
  for (int i = 0; i < 20; ++i) helix.push_back({Segment{on(i, 0.2), on(i + 1, 0.2)}});
  for (int i = 0; i < 20; ++i) ring.push_back({Segment{on(i, 0.0), on(i + 1, 0.0)}});
  ASSERT_EQ(true_curves(helix).size(), 1u);
  EXPECT_EQ(true_curves(helix)[0].kind, CurveKind::kPolyline);
  EXPECT_EQ(true_curves(helix)[0].points.size(), 21u);
  ASSERT_EQ(true_curves(ring).size(), 1u);
  EXPECT_EQ(true_curves(ring)[0].kind, CurveKind::kArc);
  EXPECT_NEAR(lines::length_of(true_curves(ring)[0]), 2.0, 1e-9);
}

TEST(TrueCurves, OfAPolyhedronAreItsEdges) {
  EXPECT_EQ(true_curves(make_shape(icosahedron()).edges).size(), 30u);
}

TEST(TrueCurves, RotateWithTheirCentres) {
  Curve arc;
  arc.kind = CurveKind::kArc;
  arc.points = {{2, 0, 0}, {1, 1, 0}};
  arc.centre = {1, 0, 0};
  arc.radius = 1.0;
  Mat3 rotation;
  rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // x to y to z
  const Curve turned = rotated({arc}, rotation)[0];
  EXPECT_EQ(turned.points[0], Vec3(0, 2, 0));
  EXPECT_EQ(turned.centre, Vec3(0, 1, 0));
  EXPECT_EQ(turned.axis, Vec3(1, 0, 0));
  EXPECT_NEAR(lines::angle_of(turned), lines::angle_of(arc), 1e-12);
}

/// The first kind with faces above others.
constexpr int kFacesAbove = 11;

TEST(Roofs, HaveCreasesAndAnOutline) {
  for (int kind = 0; kind < kRoofKinds; ++kind) {
    Random random(1, static_cast<std::uint64_t>(kind));
    const Polyhedron roof = random_roof(kind, random);
    // Every face is plane and looks up.
    for (const std::vector<int>& face : roof.faces) {
      const auto corner = [&](std::size_t i) {
        return roof.corners[static_cast<std::size_t>(face[i % face.size()])];
      };
      const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
      EXPECT_GT(normal.z(), 0.1) << roof_kind_name(kind);
      for (std::size_t i = 0; i < face.size(); ++i) {
        EXPECT_LT(std::abs(normal.dot(corner(i) - corner(0))), 1e-12) << roof_kind_name(kind);
        // Convex, or straight where a corner of another face is.
        EXPECT_GT((corner(i + 1) - corner(i)).cross(corner(i + 2) - corner(i + 1)).dot(normal),
                  -1e-9);
      }
    }
    const std::vector<Curve> curves = lines_of(roof);
    std::size_t creases = 0, outline = 0;
    for (const Curve& curve : curves) {
      creases += curve.edge_class == kSharpEdge;
      outline += curve.edge_class == kBoundary;
    }
    EXPECT_GE(outline, 4u);
    // Euler's formula for a surface with one outline.
    if (kind >= kFacesAbove) continue;
    EXPECT_EQ(roof.corners.size() + roof.faces.size(), creases + outline + 1)
        << roof_kind_name(kind);
  }
}

TEST(Roofs, ShowTheUpperFaceWhereTwoAreAboveEachOther) {
  const auto counts = [](int kind) {
    Random random(2, static_cast<std::uint64_t>(kind));
    std::pair<std::size_t, std::size_t> count;  // creases, outline
    for (const Curve& curve : lines_of(random_roof(kind, random))) {
      ++(curve.edge_class == kSharpEdge ? count.first : count.second);
    }
    return count;
  };
  ASSERT_STREQ(roof_kind_name(kFacesAbove), "tee");
  // Ridge, ridge of the wing, two valleys; without the eaves under the wing.
  EXPECT_EQ(counts(kFacesAbove), std::pair(std::size_t{4}, std::size_t{11}));
  ASSERT_STREQ(roof_kind_name(kFacesAbove + 1), "dormer");
  EXPECT_EQ(counts(kFacesAbove + 1), std::pair(std::size_t{4}, std::size_t{10}));
  ASSERT_STREQ(roof_kind_name(kFacesAbove + 2), "levels");
  EXPECT_EQ(counts(kFacesAbove + 2), std::pair(std::size_t{0}, std::size_t{7}));
}

}  // namespace
}  // namespace pcednet::shapes
