#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pcednet/core/random.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::lines {
namespace {

/// A panel .8 high that stands on level ground, 8 before a scanner at a height of 1.7: its shadow
/// goes from 8 to 15.1.
struct PanelScan {
  const Vec3 scanner = {100.0, 50.0, 1.7};
  std::vector<Vec3> positions = {}, normals = {};
  std::vector<std::uint8_t> classes = {};

  PanelScan() {
    constexpr double kStep = 0.006;
    Random random(21);
    for (double down = 0.08; down < 0.5; down += kStep) {
      for (double turn = -0.5; turn < 0.5; turn += kStep) {
        const Vec3 beam(std::cos(down) * std::cos(turn), std::cos(down) * std::sin(turn),
                        -std::sin(down));
        const Vec3 on_panel = 8.0 / beam.x() * beam;
        const bool is_panel =
            std::abs(on_panel.y()) < 1.5 && on_panel.z() > -1.7 && on_panel.z() < 0.8 - 1.7;
        const double range = is_panel ? on_panel.norm() : 1.7 / std::sin(down);
        positions.push_back(scanner + (range + 0.002 * random.normal()) * beam);
        normals.push_back(is_panel ? Vec3(-Vec3::UnitX()) : Vec3(Vec3::UnitZ()));
        classes.push_back(kNonEdge);
      }
    }
  }

  struct Lengths {
    double shadow = 0.0, panel = 0.0, outline = 0.0;
  };
  Lengths lengths(std::span<const Vec3> scanners) const {
    Lengths found;
    const EdgePoints points = {
        .positions = positions, .normals = normals, .classes = classes, .scanners = scanners};
    for (const Curve& curve : find_lines(points, {.boundaries = true})) {
      const Vec3 middle = 0.5 * (curve.points.front() + curve.points.back()) - scanner;
      const double away = std::hypot(middle.x(), middle.y());
      double& its = middle.z() > -1.6                                               ? found.panel
                    : middle.x() > 8.3 && away < 16.5 && std::abs(middle.y()) < 3.5 ? found.shadow
                                                                                    : found.outline;
      its += length_of(curve);
    }
    return found;
  }
};

TEST(Shadows, AreNoBoundariesWhereTheScannerIsKnown) {
  const PanelScan scan;
  const auto unknown = scan.lengths({});
  EXPECT_GT(unknown.shadow, 15.0);  // two sides and the end
  EXPECT_GT(unknown.panel, 4.0);    // two sides and the top
  const std::vector<Vec3> scanners(scan.positions.size(), scan.scanner);
  const auto known = scan.lengths(scanners);
  EXPECT_LT(known.shadow, 1.0);
  EXPECT_NEAR(known.panel, unknown.panel, 0.1);
  EXPECT_NEAR(known.outline, unknown.outline, 0.1 * unknown.outline);
}

TEST(Shadows, OfAScannerThatIsNotKnownAreBoundaries) {
  const PanelScan scan;
  const std::vector<Vec3> unknown(scan.positions.size(), Vec3::Constant(NAN));
  EXPECT_EQ(scan.lengths(unknown).shadow, scan.lengths({}).shadow);
}

/// A column of radius .4 or, instead, a flat panel of that half width at a slant of 75 degrees, 2
/// high and 6 before the scanner.
struct UprightScan {
  Vec3 scanner = {10.0, 20.0, 1.5};
  std::vector<Vec3> positions = {}, normals = {};

  explicit UprightScan(bool is_column) {
    constexpr double kStep = 0.006, kRadius = 0.4;
    const Vec3 slanted(std::cos(1.31), std::sin(1.31), 0.0), along(-slanted.y(), slanted.x(), 0.0);
    Random random(23);
    for (double up = -0.24; up < 0.08; up += kStep) {
      for (double turn = -0.1; turn < 0.1; turn += kStep) {
        const Vec3 level(std::cos(turn), std::sin(turn), 0.0);
        const double across = 6.0 * level.y();
        if (is_column && std::abs(across) >= kRadius) continue;
        const double range = is_column
                                 ? 6.0 * level.x() - std::sqrt(kRadius * kRadius - across * across)
                                 : 6.0 * slanted.x() / slanted.dot(level);
        const Vec3 at = range * level - Vec3(6.0, 0.0, 0.0);
        if (!is_column && std::abs(at.dot(along)) > kRadius) continue;
        positions.push_back(scanner + range * (1.0 + 3e-4 * random.normal()) *
                                          (level + std::tan(up) * Vec3::UnitZ()));
        normals.push_back(is_column ? Vec3(at.normalized()) : slanted);
      }
    }
  }

  /// The length of upright boundaries.
  double length(bool is_told) const {
    const std::vector<std::uint8_t> classes(positions.size(), kNonEdge);
    std::vector<Vec3> scanners;
    if (is_told) scanners.assign(positions.size(), scanner);
    const EdgePoints points = {
        .positions = positions, .normals = normals, .classes = classes, .scanners = scanners};
    double length = 0.0;
    for (const Curve& curve : find_lines(points, {.boundaries = true})) {
      const Vec3 whole = curve.points.back() - curve.points.front();
      if (std::abs(whole.z()) > 0.9 * whole.norm()) length += length_of(curve);
    }
    return length;
  }
};

TEST(Shadows, OfTheColumnThatCastsThemAreNoBoundariesOfIt) {
  const UprightScan column(true);
  EXPECT_GT(column.length(false), 3.0);
  EXPECT_LT(column.length(true), 0.2);
}

TEST(Shadows, AreNotTheEndsOfAPanelSeenAslant) {
  const UprightScan panel(false);
  EXPECT_GT(panel.length(false), 3.0);
  EXPECT_EQ(panel.length(true), panel.length(false));
}

/// Level ground around a scanner that sees nothing more than 60 degrees below it.
EdgePoints ground_around(const Vec3& scanner, double from_turn, std::vector<Vec3>& positions,
                         std::vector<Vec3>& normals, std::vector<std::uint8_t>& classes) {
  constexpr double kStep = 0.012;
  Random random(22);
  for (double down = 0.3; down < std::numbers::pi / 3.0; down += kStep) {
    for (double turn = from_turn; turn < std::numbers::pi; turn += kStep) {
      const Vec3 beam(std::cos(down) * std::cos(turn), std::cos(down) * std::sin(turn),
                      -std::sin(down));
      const double range = scanner.z() / std::sin(down) + 0.002 * random.normal();
      positions.push_back(scanner + range * beam);
    }
  }
  normals.assign(positions.size(), Vec3::UnitZ());
  classes.assign(positions.size(), kNonEdge);
  return {.positions = positions, .normals = normals, .classes = classes};
}

/// The length of the boundaries within 1.3 of the scanner.
double length_below(const Vec3& scanner, const EdgePoints& points) {
  double length = 0.0;
  for (const Curve& curve : find_lines(points, {.boundaries = true})) {
    double farthest = 0.0;
    for (const Vec3& at : sampled(curve, 0.01)) {
      farthest = std::max(farthest, (at - scanner).head<2>().norm());
    }
    if (farthest < 1.3) length += length_of(curve);
  }
  return length;
}

TEST(Shadows, OfTheTripodAreNoBoundaries) {
  const Vec3 scanner(10.0, 20.0, 1.5);
  std::vector<Vec3> positions, normals;
  std::vector<std::uint8_t> classes;
  EdgePoints points = ground_around(scanner, -std::numbers::pi, positions, normals, classes);
  EXPECT_GT(length_below(scanner, points), 4.0);  // a circle of radius .87
  const std::vector<Vec3> scanners(positions.size(), scanner);
  points.scanners = scanners;
  EXPECT_EQ(length_below(scanner, points), 0.0);
}

TEST(Shadows, AreNotTheEndOfAPartOfAScan) {
  const Vec3 scanner(10.0, 20.0, 1.5);
  std::vector<Vec3> positions, normals;
  std::vector<std::uint8_t> classes;
  EdgePoints points = ground_around(scanner, 2.0, positions, normals, classes);
  const std::vector<Vec3> scanners(positions.size(), scanner);
  points.scanners = scanners;
  EXPECT_GT(length_below(scanner, points), 0.8);
}

}  // namespace
}  // namespace pcednet::lines
