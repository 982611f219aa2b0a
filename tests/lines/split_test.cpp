#include "pcednet/lines/split.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pcednet::lines {
namespace {

constexpr double kTolerance = 0.2;

ChainNode node(const Vec3& at, const Vec3& along) {
  return {.at = at,
          .along = along,
          .side_a = Vec3::UnitZ(),
          .side_b = -Vec3::UnitZ(),
          .spacing = 1.0,
          .edge_points = 1.0};
}

/// Nodes one apart: straight for 20, a quarter turn of radius 10, straight for 20.
Chain bow() {
  Chain chain;
  for (int i = 0; i < 20; ++i) chain.nodes.push_back(node({i - 20.0, 0, 0}, Vec3::UnitX()));
  for (int i = 0; i < 16; ++i) {
    const double t = i / 10.0;
    chain.nodes.push_back(
        node({10 * std::sin(t), 10 - 10 * std::cos(t), 0}, {std::cos(t), std::sin(t), 0}));
  }
  for (int i = 0; i < 20; ++i) chain.nodes.push_back(node({10, 10.3 + i, 0}, Vec3::UnitY()));
  return chain;
}

TEST(Split, FindsTheArcBetweenTwoSegments) {
  const auto runs = split(bow(), kTolerance);
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0].fit.kind, CurveKind::kSegment);
  EXPECT_EQ(runs[1].fit.kind, CurveKind::kArc);
  EXPECT_EQ(runs[2].fit.kind, CurveKind::kSegment);
  EXPECT_NEAR(static_cast<double>(runs[1].first), 20.0, 3.0);
  EXPECT_NEAR(static_cast<double>(runs[2].first), 36.0, 3.0);
  EXPECT_NEAR(runs[1].fit.radius, 10.0, 0.5);
  EXPECT_LT((runs[1].fit.point - Vec3(0, 10, 0)).norm(), 0.6);
  EXPECT_NEAR(runs[1].fit.direction.z(), 1.0, 1e-6);  // the way of the nodes about it
}

TEST(Split, LeavesAStraightChainWhole) {
  Chain chain;
  for (int i = 0; i < 300; ++i) {
    chain.nodes.push_back(node({1.0 * i, 0.1 * std::sin(2.3 * i), 0}, Vec3::UnitX()));
  }
  const auto runs = split(chain, kTolerance);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].fit.kind, CurveKind::kSegment);
  EXPECT_EQ(runs[0].last, 300u);
}

TEST(Split, TakesAClosedChainForACircleIfItIsOne) {
  Chain circle{.nodes = {}, .closed = true}, square{.nodes = {}, .closed = true};
  for (int i = 0; i < 60; ++i) {
    const double t = i * std::numbers::pi / 30;
    circle.nodes.push_back(
        node({9 * std::cos(t), 9 * std::sin(t), 1}, {-std::sin(t), std::cos(t), 0}));
  }
  const auto runs = split(circle, kTolerance);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].fit.kind, CurveKind::kArc);
  EXPECT_NEAR(runs[0].fit.radius, 9.0, 1e-6);
  for (int side = 0; side < 4; ++side) {
    const double t = side * std::numbers::pi / 2;
    const Vec3 along(std::cos(t), std::sin(t), 0), out(std::sin(t), -std::cos(t), 0);
    for (int i = 0; i < 15; ++i) {
      square.nodes.push_back(node((i - 7.0) * along + 8.0 * out, along));
    }
  }
  EXPECT_EQ(split(square, kTolerance).size(), 4u);
}

TEST(Split, OfNothingIsNothing) {
  EXPECT_TRUE(split({}, kTolerance).empty());
}

}  // namespace
}  // namespace pcednet::lines
