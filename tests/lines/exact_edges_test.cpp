#include "pcednet/lines/exact/edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "exact_parts.h"

namespace pcednet::lines {
namespace {

double total_length(const std::vector<Piece>& pieces) {
  return std::accumulate(pieces.begin(), pieces.end(), 0.0, [](double sum, const Piece& piece) {
    return sum + (piece.ends[1] - piece.ends[0]).norm();
  });
}

/// Whether every fold lies on an edge of the box.
void expect_on_edges(const std::vector<Piece>& folds, const Vec3& corner, const Vec3& size,
                     double within = 1e-6) {
  for (const Piece& fold : folds) {
    for (const Vec3& end : fold.ends) {
      const Vec3 low = (end - corner).cwiseAbs(), high = (end - corner - size).cwiseAbs();
      const Vec3 off = low.cwiseMin(high);
      EXPECT_LT(off.sum() - off.maxCoeff(), within) << end.transpose();
    }
  }
}

TEST(ExactFolds, AreTheEdgesOfAThinPlate) {
  const Vec3 size(40.0, 30.0, 1.3);
  PlanePart plate;
  plate.add_box(Vec3::Zero(), size);
  for (std::size_t i = 0; i < plate.classes.size(); ++i) {
    if (i % 4 != 0) plate.classes[i] = kNonEdge;  // labels miss most of it
  }
  const std::vector<Piece> folds = plate.folds();
  expect_on_edges(folds, Vec3::Zero(), size);
  EXPECT_GT(total_length(folds), 0.9 * 4.0 * (40.0 + 30.0));
  for (const Piece& fold : folds) {
    EXPECT_TRUE(fold.exact);
    EXPECT_NEAR(dihedral_angle(fold.middle().side_a, fold.middle().side_b), 0.25 * kTurn, 1e-6);
  }
}

TEST(ExactFolds, AreNoneOnAWideCylinder) {
  constexpr double kRadius = 300.0;
  constexpr int kPoints = 60000;  // take 16 seconds if each grows the strip that it is on
  PlanePart part;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = kTurn * part.random.uniform();
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
    const double up = kPoints / (kTurn * kRadius) * part.random.uniform();
    part.add(kRadius * out + up * Vec3::UnitZ(), out, true);
  }
  EXPECT_TRUE(part.edges().pieces.empty());
}

TEST(ExactFolds, OfFewPointsReachFromVertexToVertex) {
  const Vec3 size(16.0, 3.4, 3.4);
  std::set<std::tuple<int, int, int, int>> whole;  // the part, and twice the middle's coordinates
  for (int part = 0; part < 8; ++part) {
    PlanePart rods;
    rods.random = Random(100 + part);
    rods.add_box(Vec3::Zero(), size);
    const std::vector<Piece> folds = rods.folds();
    expect_on_edges(folds, Vec3::Zero(), size, 2e-3);  // planes of a few points
    for (const Piece& fold : folds) {
      if (fold.ends[0].x() > 1.0 && fold.ends[0].x() < 15.0) continue;
      if (std::abs((fold.ends[1] - fold.ends[0]).norm() - 3.4) > 0.01) continue;
      const Vec3 middle = (fold.ends[0] + fold.ends[1]) / 3.4;
      whole.emplace(part, std::lround(middle.x()), std::lround(middle.y()),
                    std::lround(middle.z()));
    }
  }
  EXPECT_GE(whole.size(), 18u);  // of the 64 around the ends; none without vertices
}

/// How many of the four edges across a plate are folds as long as it is thick.
std::size_t across_plate(double thickness, std::uint64_t seed) {
  const Vec3 size(40.0, 30.0, thickness);
  PlanePart plate;
  plate.random = Random(seed);
  plate.add_box(Vec3::Zero(), size);
  const std::vector<Piece> folds = plate.folds();
  expect_on_edges(folds, Vec3::Zero(), size, 2e-3);
  std::set<std::pair<int, int>> corners;
  for (const Piece& fold : folds) {
    const Vec3 length = (fold.ends[1] - fold.ends[0]).cwiseAbs();
    if (std::abs(length.z() - thickness) > 0.01) continue;
    corners.emplace(fold.ends[0].x() > 20.0, fold.ends[0].y() > 15.0);
  }
  return corners.size();
}

TEST(ExactFolds, AcrossAThinPlateReachFromSideToSide) {
  for (const double thickness : {1.4, 2.0, 3.0}) {
    std::size_t found = 0;
    for (std::uint64_t seed = 300; seed < 310; ++seed) found += across_plate(thickness, seed);
    EXPECT_GE(found, 30u) << thickness;  // of 40; half of them if near points must be there
  }
}

TEST(ExactFolds, AreNoneWhereThePlatesCornerIsCutOff) {
  PlanePart plate;  // by 1.2 spacings: two points at most are on the cut
  const double cut = 1.2;
  const auto wall = [&](double x, double y, double to_x, double to_y) {
    plate.add_face({x, y, 0.0}, {to_x - x, to_y - y, 0.0}, {0.0, 0.0, 2.0});
  };
  for (const double z : {0.0, 2.0})
    plate.add_face({cut, cut, z}, {30.0, 0.0, 0.0}, {0.0, 30.0, 0.0});
  wall(cut, 0.0, 30.0, 0.0), wall(0.0, cut, 0.0, 30.0);
  for (const double height : {0.5, 1.5}) {
    plate.add({0.5 * cut, 0.5 * cut, height}, Vec3(-1.0, -1.0, 0.0).normalized(), true);
  }
  for (const Piece& fold : plate.folds()) {
    EXPECT_GT(std::max(fold.ends[0].head<2>().norm(), fold.ends[1].head<2>().norm()), 1.0);
  }
}

TEST(ExactFolds, NeedPointsThatMayBeOfAnEdge) {
  PlanePart box;
  box.add_box(Vec3::Zero(), {20.0, 20.0, 20.0}, false);
  EXPECT_TRUE(box.folds().empty());
}

TEST(ExactFolds, EndAtASlot) {
  PlanePart halves;
  const Vec3 size(15.0, 20.0, 10.0), second(18.0, 0.0, 0.0);
  halves.add_box(Vec3::Zero(), size);
  halves.add_box(second, size);
  const std::vector<Piece> folds = halves.folds();
  EXPECT_GE(folds.size(), 20u);
  for (const Piece& fold : folds) {
    const bool in_first = fold.ends[0].x() < 15.1, ends_in_first = fold.ends[1].x() < 15.1;
    EXPECT_EQ(in_first, ends_in_first);
  }
}

TEST(ExactFolds, AreNoLineAcrossAPlaneThatGoesOn) {
  PlanePart rib;  // on a plate, which it divides
  rib.add_face({-20.0, -20.0, 0.0}, {20.0, 0.0, 0.0}, {0.0, 40.0, 0.0});
  rib.add_face({1.5, -20.0, 0.0}, {20.0, 0.0, 0.0}, {0.0, 40.0, 0.0});
  for (const double x : {0.0, 1.5}) {
    rib.add_face({x, -10.0, 0.0}, {0.0, 20.0, 0.0}, {0.0, 0.0, 8.0});
  }
  rib.add_face({0.0, -20.0, 0.0}, {1.5, 0.0, 0.0}, {0.0, 10.0, 0.0});  // the plate beyond the rib
  rib.add_face({0.0, 10.0, 0.0}, {1.5, 0.0, 0.0}, {0.0, 10.0, 0.0});
  const std::vector<Piece> folds = rib.folds();
  double at_foot = 0.0;
  for (const Piece& fold : folds) {
    for (const Vec3& end : fold.ends) EXPECT_LT(std::abs(end.y()), 10.5);
    if (std::abs(fold.middle().at.z()) < 1e-6) at_foot += total_length({fold});
  }
  EXPECT_GT(at_foot, 0.8 * 2.0 * 20.0);
}

TEST(ExactFolds, LeaveRoundEdgesAlone) {
  EXPECT_TRUE(column(0, 12.0, 15.0).folds().empty());
  EXPECT_LT(total_length(column(48, 12.0, 15.0).folds()), 0.05 * kTurn * 12.0);
  EXPECT_GT(total_length(column(6, 12.0, 15.0).folds()), 0.8 * (6 * 12.0));
}

/// Where the edges of a unit grid cross the surface of a drum with blurred rims.
PlanePart blurred_drum(double radius, double half_height) {
  const auto depths = [&](const Vec3& p) {
    return Eigen::Vector2d(radius - std::hypot(p.x(), p.y()), half_height - std::abs(p.z()));
  };
  const auto is_inside = [&](const Vec3& p) {
    return (-2.0 * depths(p)).array().exp().sum() < 1.0;
  };
  PlanePart part;
  const int end = static_cast<int>(radius) + 2;
  for (int i = 0; i < 8 * end * end * end; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 a(i % (2 * end) - end, i / (2 * end) % (2 * end) - end, i / (4 * end * end) - end);
      Vec3 b = a + Vec3::Unit(axis);
      if (is_inside(a) == is_inside(b)) continue;
      for (int halving = 0; halving < 40; ++halving) {
        const Vec3 middle = 0.5 * (a + b);
        (is_inside(middle) == is_inside(a) ? a : b) = middle;
      }
      part.add(a, Vec3::Unit(axis), depths(a).maxCoeff() < 3.0);
    }
  }
  return part;
}

TEST(ExactFolds, AreNotWhereTheLayersOfAGridMeet) {
  EXPECT_TRUE(blurred_drum(9.0, 6.3).folds().empty());
}

TEST(ExactFolds, ReplaceTheCreasesThere) {
  PlanePart box;
  box.add_box(Vec3::Zero(), {20.0, 20.0, 20.0});
  const std::vector<Piece> folds = box.folds();
  ASSERT_FALSE(folds.empty());
  const ChainNode& node = folds[0].middle();
  Crease on{.at = node.at,
            .along = -node.along,
            .side_a = node.side_b,
            .side_b = node.side_a,
            .spacing = 1.0,
            .probability = 1.0f,
            .edge_class = kSharpEdge};
  Crease across = on, beside = on;
  across.along = node.side_a;
  beside.at += 1.2 * node.side_a;
  std::vector<Crease> creases = {on, across, beside};
  erase_explained(creases, {folds, {}, {}});
  ASSERT_EQ(creases.size(), 2u);
  EXPECT_EQ(creases[0].along, across.along);
  EXPECT_EQ(creases[1].at, beside.at);
}

TEST(ExactFolds, AreTheSameForAnyOrderOfThePoints) {
  PlanePart part;
  part.add_box(Vec3::Zero(), {30.0, 12.0, 1.5});
  const std::vector<Piece> folds = part.folds(), others = turned_round(part).folds();
  ASSERT_EQ(folds.size(), others.size());
  for (std::size_t i = 0; i < folds.size(); ++i) EXPECT_EQ(folds[i].ends, others[i].ends);
}

}  // namespace
}  // namespace pcednet::lines
