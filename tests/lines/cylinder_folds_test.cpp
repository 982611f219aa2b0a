#include "pcednet/lines/exact/cylinder_folds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "exact_parts.h"

namespace pcednet::lines {
namespace {

constexpr double kBarLength = 30.0;

/// A bar along z between two flat ends.
struct Bar : PlanePart {
  std::function<bool(double x, double y)> is_inside;
  std::function<bool(double x, double y)> is_at_edge;  ///< along the bar

  void add_point(double x, double y, double z) {
    const double from_end = std::min(z, kBarLength - z);
    const bool is_edge = from_end < kNear || is_at_edge(x, y);
    add({x, y, z}, Vec3::UnitX(), is_edge);  // its normals are not used
  }
  void add_ends(double half) {
    for (const double z : {0.0, kBarLength}) {
      for (int i = 0; i < static_cast<int>(4.0 * half * half); ++i) {
        const double x = half * (2.0 * random.uniform() - 1.0);
        const double y = half * (2.0 * random.uniform() - 1.0);
        if (is_inside(x, y)) add_point(x, y, z);
      }
    }
  }
  /// From one angle to another, points up to `facet` within it.
  void add_cylinder(double x, double radius, double from, double to, double facet = 0.0) {
    for (int i = 0; i < static_cast<int>(radius * (to - from) * kBarLength); ++i) {
      const double angle = from + (to - from) * random.uniform();
      const double r = radius - facet * random.uniform();
      add_point(x + r * std::cos(angle), r * std::sin(angle), kBarLength * random.uniform());
    }
  }
  std::vector<Piece> folds_along() const {
    std::vector<Piece> found = folds();
    std::erase_if(found, [](const Piece& fold) { return std::abs(fold.fit.direction.z()) < 0.5; });
    return found;
  }
  void add_flat(double x, double half) {
    for (int i = 0; i < static_cast<int>(2.0 * half * kBarLength); ++i) {
      const double y = half * (2.0 * random.uniform() - 1.0);
      add_point(x, y, kBarLength * random.uniform());
    }
  }
};

/// A round bar of radius 6 with a flat at 60 degrees to it.
Bar flattened_bar(double facet = 0.0) {
  Bar bar;
  const double radius = 6.0, x = 3.0, y = std::sqrt(27.0);
  bar.is_inside = [=](double at_x, double at_y) {
    return std::hypot(at_x, at_y) < radius && at_x < x;
  };
  bar.is_at_edge = [=](double at_x, double at_y) {
    return std::hypot(at_x - x, std::abs(at_y) - y) < kNear;
  };
  bar.add_ends(radius);
  bar.add_cylinder(0.0, radius, kTurn / 6.0, kTurn * 5.0 / 6.0, facet);
  bar.add_flat(x, y);
  return bar;
}

/// Expects one segment as long as the bar at each of (x, y) and (x, -y).
void expect_two_long_folds(const std::vector<Piece>& folds, double x, double y, double within) {
  ASSERT_EQ(folds.size(), 2u);
  for (const Piece& fold : folds) {
    EXPECT_TRUE(fold.exact);
    EXPECT_GT(length_of(fold), 0.9 * kBarLength);
    for (const Vec3& end : fold.ends) {
      EXPECT_NEAR(end.x(), x, within);
      EXPECT_NEAR(std::abs(end.y()), y, within);
    }
  }
  EXPECT_LT(folds[0].ends[0].y() * folds[1].ends[0].y(), 0.0);
}

TEST(CylinderFolds, AreWhereAPlaneMeetsACylinder) {
  expect_two_long_folds(flattened_bar().folds_along(), 3.0, std::sqrt(27.0), 1e-4);
}

TEST(CylinderFolds, AreFoundAtFacetsOfACylinder) {
  expect_two_long_folds(flattened_bar(0.02).folds_along(), 3.0, std::sqrt(27.0), 0.05);
}

TEST(CylinderFolds, AreWhereCylindersMeet) {
  Bar bar;  // two arcs about axes 10 apart
  const double radius = 8.0, half = 5.0, y = std::sqrt(39.0), angle = std::asin(y / radius);
  bar.is_inside = [=](double at_x, double at_y) {
    return std::hypot(std::abs(at_x) + half, at_y) < radius;
  };
  bar.is_at_edge = [=](double at_x, double at_y) {
    return std::hypot(at_x, std::abs(at_y) - y) < kNear;
  };
  bar.add_ends(y);
  bar.add_cylinder(-half, radius, -angle, angle);
  bar.add_cylinder(half, radius, 0.5 * kTurn - angle, 0.5 * kTurn + angle);
  expect_two_long_folds(bar.folds_along(), 0.0, y, 1e-4);
}

TEST(CylinderFolds, AreNotWhereAPlaneTouchesACylinder) {
  Bar bar;  // half round, with a box of the same width: the planes y = 4 and -4 go on in the
            // cylinder
  const double radius = 4.0;
  bar.is_inside = [=](double at_x, double at_y) {
    return std::abs(at_y) < radius && (at_x > 0.0 || std::hypot(at_x, at_y) < radius);
  };
  bar.is_at_edge = [](double at_x, double) { return std::abs(at_x) < kNear; };
  bar.add_ends(radius);
  bar.add_cylinder(0.0, radius, 0.25 * kTurn, 0.75 * kTurn);
  for (const double y : {radius, -radius}) {
    bar.add_face({0.0, y, 0.0}, {radius, 0.0, 0.0}, {0.0, 0.0, kBarLength});
  }
  EXPECT_TRUE(bar.folds_along().empty());
}

TEST(CylinderFolds, AreTheSameForAnyOrderOfThePoints) {
  const Bar bar = flattened_bar();
  const std::vector<Piece> folds = bar.folds(), others = turned_round(bar).folds();
  ASSERT_EQ(folds.size(), others.size());
  for (std::size_t i = 0; i < folds.size(); ++i) EXPECT_EQ(folds[i].ends, others[i].ends);
}

}  // namespace
}  // namespace pcednet::lines
