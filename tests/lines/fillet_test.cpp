#include "pcednet/lines/exact/fillet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "exact_parts.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::lines {
namespace {

constexpr double kRight = 0.25 * std::numbers::pi;  ///< half of a right angle

/// The corner of two surfaces, one point per square spacing, beside an edge of this length.
struct Corner2 {
  double half_angle, length;
  Random random = Random(3);
  std::vector<CornerPoint> points = {};

  /// Points of a curve in the corner: its length, and the place at a share of it.
  template <typename Place>
  void add(double curve, const Place& place) {
    for (int i = 0; i < static_cast<int>(curve * length); ++i) {
      const double along = length * random.uniform();
      points.push_back({along, place(random.uniform())});
    }
  }
  /// Both lines, from so far from the corner on.
  void add_lines(double from) {
    for (const double side : {1.0, -1.0}) {
      add(3.0 - from, [&](double share) {
        const double at = from + share * (3.0 - from);
        return Eigen::Vector2d(at * std::cos(half_angle), side * at * std::sin(half_angle));
      });
    }
  }
  void add_arc(double radius) {
    const double half_turn = 0.5 * std::numbers::pi - half_angle;
    add(2.0 * half_turn * radius, [&](double share) {
      const double angle = half_turn * (2.0 * share - 1.0);
      return Eigen::Vector2d(radius / std::sin(half_angle) - radius * std::cos(angle),
                             radius * std::sin(angle));
    });
  }
  void add_chamfer(double cut) {
    const double half = cut * std::sin(half_angle);
    add(2.0 * half, [&](double share) {
      return Eigen::Vector2d(cut * std::cos(half_angle), half * (2.0 * share - 1.0));
    });
  }
  std::optional<Fillet> fillet() const { return find_fillet(points, half_angle); }
};

TEST(Fillet, IsAnArcThatTouchesBothLines) {
  for (const double radius : {0.25, 0.6, 1.0, 1.8}) {
    Corner2 corner{kRight, 40.0};
    corner.add_lines(radius);
    corner.add_arc(radius);
    const auto fillet = corner.fillet();
    ASSERT_TRUE(fillet) << radius;
    EXPECT_NEAR(fillet->radius, radius, 1e-6);
    EXPECT_NEAR(fillet->depth, radius * (std::sqrt(2.0) - 1.0), 1e-6);
    ASSERT_EQ(fillet->intervals.size(), 1u) << radius;
    EXPECT_GT(fillet->intervals[0].length(), 30.0) << radius;
  }
}

TEST(Fillet, IsFoundAtObtuseAndAcuteAngles) {
  for (const double half_angle : {0.4, 0.6, 1.0}) {
    Corner2 corner{half_angle, 40.0};
    const double radius = 0.8 * std::tan(half_angle);
    corner.add_lines(0.8);
    corner.add_arc(radius);
    const auto fillet = corner.fillet();
    ASSERT_TRUE(fillet) << half_angle;
    EXPECT_NEAR(fillet->radius, radius, 1e-6);
  }
}

TEST(Fillet, IsNoSharpCorner) {
  Corner2 corner{kRight, 40.0};
  corner.add_lines(0.0);
  EXPECT_FALSE(corner.fillet());
}

TEST(Fillet, IsNoChamfer) {
  for (const double half_angle : {0.5, kRight, 1.2}) {
    for (const double cut : {0.3, 0.6, 1.2}) {
      Corner2 corner{half_angle, 40.0};
      corner.add_lines(cut);
      corner.add_chamfer(cut);
      EXPECT_FALSE(corner.fillet()) << half_angle << " " << cut;
    }
  }
}

TEST(Fillet, NeedsBothLines) {
  Corner2 corner{kRight, 40.0};
  corner.add_lines(0.6);
  corner.add_arc(0.6);
  std::erase_if(corner.points, [](const CornerPoint& point) { return point.at.y() < -0.45; });
  EXPECT_FALSE(corner.fillet());
}

/// A bar along x with rounded edges: square, 6 wide.
PlanePart rounded_bar(double radius) {
  PlanePart bar;
  constexpr double kLong = 40.0, kWide = 6.0;
  const double flat = kWide - 2.0 * radius;
  for (int side = 0; side < 4; ++side) {
    const double turn = 0.5 * std::numbers::pi * side;
    const Vec3 out(0.0, std::cos(turn), std::sin(turn)), left(0.0, -std::sin(turn), std::cos(turn));
    bar.add_face(0.5 * kWide * out - 0.5 * flat * left, kLong * Vec3::UnitX(), flat * left);
    for (int i = 0; i < static_cast<int>(0.5 * std::numbers::pi * radius * kLong); ++i) {
      const double angle = 0.5 * std::numbers::pi * bar.random.uniform();
      const Vec3 normal = std::cos(angle) * out + std::sin(angle) * left;
      bar.add(0.5 * flat * (out + left) + radius * normal +
                  kLong * bar.random.uniform() * Vec3::UnitX(),
              normal, true);
    }
  }
  return bar;
}

/// The lengths of the curves of a bar by class.
std::map<EdgeClass, double> lengths_of(const std::vector<Curve>& curves) {
  std::map<EdgeClass, double> lengths;
  for (const Curve& curve : curves) lengths[curve.edge_class] += length_of(curve);
  return lengths;
}

TEST(Fillet, MakesTheEdgesOfABarSmooth) {
  for (const double radius : {0.4, 0.6, 1.0}) {
    const PlanePart bar = rounded_bar(radius);
    std::vector<float> p_sharp;
    for (const std::uint8_t label : bar.classes)
      p_sharp.push_back(label == kSharpEdge ? 0.9f : 0.0f);
    const std::vector<Curve> curves =
        find_lines({bar.positions, bar.normals, bar.classes, p_sharp}, {});
    std::map<EdgeClass, double> lengths = lengths_of(curves);
    EXPECT_GT(lengths[kSmoothEdge], 140.0) << radius;  // of 160
    EXPECT_LT(lengths[kSharpEdge], 8.0) << radius;
    for (const Curve& curve : curves) {
      if (curve.edge_class != kSmoothEdge) continue;
      const double off_axis = std::hypot(curve.points[0].y(), curve.points[0].z());
      EXPECT_NEAR(off_axis, std::sqrt(2.0) * (3.0 - radius) + radius, 1e-2) << radius;
    }
  }
}

TEST(Fillet, StaysSharpWhereLabelsWithoutProbabilitiesSaySo) {
  const PlanePart bar = rounded_bar(0.6);
  std::map<EdgeClass, double> lengths =
      lengths_of(find_lines({bar.positions, bar.normals, bar.classes}, {}));
  EXPECT_GT(lengths[kSharpEdge], 140.0);
  EXPECT_EQ(lengths[kSmoothEdge], 0.0);
}

TEST(Fillet, IsTheSameForAnyOrderOfThePoints) {
  const PlanePart bar = rounded_bar(0.6), turned = turned_round(bar);
  const std::vector<Piece> one = bar.edges().rounded, other = turned.edges().rounded;
  ASSERT_EQ(one.size(), 4u);
  ASSERT_EQ(other.size(), 4u);
  for (const Piece& piece : one) {
    EXPECT_TRUE(std::ranges::any_of(other, [&](const Piece& same) {
      return (same.fit.point - piece.fit.point).norm() < 1e-6;
    }));
  }
}

}  // namespace
}  // namespace pcednet::lines
