#include "pcednet/lines/curves/split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcednet/core/random_vectors.h"
#include "support/expect_error.h"

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

double cost_of(std::span<const ChainNode> nodes, const Fit& fit) {
  const auto count = static_cast<double>(nodes.size());
  if (fit.kind == CurveKind::kPolyline) return 4.0 + 5.0 * count;
  const double sq = std::pow(fit.error / kTolerance, 2);
  return (fit.kind == CurveKind::kSegment ? 12.0 : 18.0) + count * std::min(sq, 9.0);
}

/// The least sum of costs over all ways to divide the chain.
double least_cost(std::span<const ChainNode> nodes) {
  std::vector<double> least = {0.0};
  for (std::size_t end = 1; end <= nodes.size(); ++end) {
    least.push_back(1e300);
    for (std::size_t start = 0; start < end; ++start) {
      const auto run = nodes.subspan(start, end - start);
      double cost = cost_of(run, {});
      if (run.size() >= 2) cost = std::min(cost, cost_of(run, fit_segment(run)));
      if (run.size() >= 4) cost = std::min(cost, cost_of(run, fit_arc(run)));
      least.back() = std::min(least.back(), least[start] + cost);
    }
  }
  return least.back();
}

TEST(Split, IsTheCheapestOfAllWays) {
  Random random(3);
  for (int kind = 0; kind < 24; ++kind) {
    Chain chain;
    Vec3 at = Vec3::Zero();
    double heading = 0.0, bend = 0.0;
    const double noise = 0.05 * (kind % 4), turn = 0.3 * (kind % 3);
    for (int i = 0; i < 48; ++i) {
      if (random.index(12) == 0) {
        heading += turn * random.normal();
        bend = 0.1 * random.uniform(-1.0, 1.0);
      }
      heading += bend;
      at += Vec3(std::cos(heading), std::sin(heading), 0);
      const Vec3 off = normal_vector(random);
      chain.nodes.push_back(node(at + noise * off, {std::cos(heading), std::sin(heading), 0}));
    }
    double cost = 0.0;
    for (const auto& run : split(chain, kTolerance)) {
      cost += cost_of(std::span(chain.nodes).subspan(run.first, run.last - run.first), run.fit);
    }
    EXPECT_NEAR(cost, least_cost(chain.nodes), 1e-9) << kind;
  }
}

TEST(Split, StopsWhenTold) {
  const Progress stopped = {.report = {}, .cancelled = [] { return true; }};
  EXPECT_ERROR(ErrorKind::kCancelled, split(bow(), kTolerance, &stopped));
}

TEST(Split, OfNothingIsNothing) {
  EXPECT_TRUE(split({}, kTolerance).empty());
}

}  // namespace
}  // namespace pcednet::lines
