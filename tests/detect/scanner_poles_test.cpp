#include "pcednet/detect/points/scanner_poles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "pcednet/core/random_vectors.h"
#include "pcednet/detect/averages.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

const Vec3 kScanner(100.0, 50.0, 1.5);
constexpr int kColumns = 400, kRows = 150;
constexpr double kRowAngle = 2.7 / kRows;

struct Scan {
  std::vector<Vec3> positions, scanners;

  WithoutPoles thinned() const {
    return without_poles(positions, scanners, spatial::curve_order(positions));
  }
};

/// A room of 6 by 6 by 3 metres in equal steps of both angles.
Scan scan_of_room(double noise) {
  Random random(4);
  Scan scan;
  for (int column = 0; column < kColumns; ++column) {
    for (int row = 0; row < kRows; ++row) {
      const double turn = 2.0 * std::numbers::pi * column / kColumns, up = -1.2 + kRowAngle * row;
      const Vec3 beam(std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn), std::sin(up));
      const double range =
          std::min({3.0 / std::abs(beam.x()), 3.0 / std::abs(beam.y()), 1.5 / std::abs(beam.z())});
      scan.positions.push_back(kScanner + (range + noise * random.normal()) * beam);
    }
  }
  scan.scanners.assign(scan.positions.size(), kScanner);
  return scan;
}

Vec3 beam_to(const Vec3& position) {
  return (position - kScanner).normalized();
}

/// The share of the points of the ceiling above the scanner with a normal that is not upright.
double wrong_above(const PreparedCloud& prepared) {
  double count = 0.0, wrong = 0.0;
  for (std::size_t i = 0; i < prepared.positions.size(); ++i) {
    if (beam_to(prepared.positions[i]).z() < 0.95) continue;
    count += 1.0;
    wrong += std::abs(prepared.normals[i].z()) < 0.8 ? 1.0 : 0.0;
  }
  return wrong / count;
}

TEST(ScannerPoles, LoseTheirCrowds) {
  const Scan scan = scan_of_room(0.003);
  const WithoutPoles thinned = scan.thinned();
  EXPECT_TRUE(thinned.are_many());
  EXPECT_GT(thinned.crowded, scan.positions.size() / 40);
  EXPECT_LT(thinned.crowded, scan.positions.size() / 8);
  EXPECT_EQ(thinned.crowded, scan.positions.size() - thinned.kept.size());
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const Vec3& kept = scan.positions[thinned.kept[thinned.average_of[i]]];
    if (kept == scan.positions[i]) continue;
    const Vec3 beam = beam_to(scan.positions[i]);
    EXPECT_GT(std::abs(beam.z()), std::sin(std::numbers::pi / 3.0) - 1e-3);
    EXPECT_LT((beam - beam_to(kept)).norm(), 0.6 * kRowAngle);
  }
}

TEST(ScannerPoles, DoNotDependOnTheOrderOfPoints) {
  Scan scan = scan_of_room(0.003);
  const auto positions_of = [](const Scan& of) {
    std::vector<Vec3> kept = spatial::in_order(of.positions, of.thinned().kept);
    std::sort(kept.begin(), kept.end(), [](const Vec3& a, const Vec3& b) {
      return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
    });
    return kept;
  };
  const auto kept = positions_of(scan);
  std::reverse(scan.positions.begin(), scan.positions.end());
  EXPECT_EQ(positions_of(scan), kept);
}

TEST(ScannerPoles, AreLeftAloneWithoutCrowds) {
  Scan scan = scan_of_room(0.003);
  scan.scanners.assign(scan.positions.size(), Vec3::Constant(NAN));
  EXPECT_FALSE(scan.thinned().are_many());  // nobody knows where it stood
  Random random(5);
  for (Vec3& position : scan.positions) {  // without rows
    position = uniform_vector(random, kScanner + Vec3(-3, -3, 1.5), kScanner + Vec3(3, 3, 1.5));
  }
  scan.scanners.assign(scan.positions.size(), kScanner);
  EXPECT_FALSE(scan.thinned().are_many());
  scan.positions.resize(3), scan.scanners.resize(3);
  EXPECT_FALSE(scan.thinned().are_many());
}

TEST(ScannerPoles, GetTheNormalsOfTheCeiling) {
  const Scan scan = scan_of_room(0.006);
  const PointArrays arrays = {.positions = scan.positions, .scanners = scan.scanners};
  EXPECT_GT(wrong_above(prepare(arrays, {})), 0.3);
  const PreparedCloud prepared = prepare(arrays, {.average_noise = true});
  ASSERT_TRUE(prepared.is_averaged());
  EXPECT_LT(wrong_above(prepared), 0.02);
  EXPECT_EQ(prepared.scanners.size(), prepared.positions.size());
  EXPECT_EQ(
      of_all_points(prepared, std::vector<Vec3>(prepared.normals.begin(), prepared.normals.end()))
          .size(),
      scan.positions.size());
}

}  // namespace
}  // namespace pcednet::detect
