#include "pcednet/lines/roofs/outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "pcednet/core/random.h"
#include "pcednet/lines/curves/support_line.h"

namespace pcednet::lines {
namespace {

using Vec2 = Eigen::Vector2d;

std::vector<Vec2> points_in_rectangle(std::size_t count, double width, double height) {
  Random random(7);
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(0.0, width);
    points.emplace_back(x, random.uniform(0.0, height));
  }
  return points;
}

TEST(Outlines, AreTheEdgesOfTheAlphaShape) {
  const double radius = 0.8;
  const std::vector<Vec2> points = points_in_rectangle(150, 10.0, 6.0);
  // By definition: a disc through both points, on the right of the way from a to b, holds none.
  std::set<std::pair<std::size_t, std::size_t>> expected, found;
  for (std::size_t a = 0; a < points.size(); ++a) {
    for (std::size_t b = 0; b < points.size(); ++b) {
      const Vec2 way = points[b] - points[a];
      if (a == b || way.norm() >= 2.0 * radius) continue;
      const Vec2 right = Vec2(way.y(), -way.x()).normalized();
      const Vec2 centre = 0.5 * (points[a] + points[b]) +
                          std::sqrt(radius * radius - 0.25 * way.squaredNorm()) * right;
      bool empty = true;
      for (std::size_t i = 0; i < points.size(); ++i) {
        empty = empty && (i == a || i == b || (points[i] - centre).norm() > radius);
      }
      if (empty) expected.emplace(a, b);
    }
  }
  for (const auto& chain : outlines(points, radius)) {
    for (std::size_t i = 0; i < chain.size(); ++i) {
      found.emplace(chain[i].index, chain[(i + 1) % chain.size()].index);
      EXPECT_NEAR(chain[i].outward.norm(), 1.0, 1e-12);
    }
  }
  EXPECT_GT(expected.size(), 30u);
  EXPECT_EQ(found, expected);
}

TEST(Outlines, AreNoneOfLonelyPoints) {
  EXPECT_TRUE(outlines({}, 1.0).empty());
  EXPECT_TRUE(outlines(std::vector<Vec2>{{0, 0}}, 1.0).empty());
  EXPECT_TRUE(outlines(std::vector<Vec2>{{0, 0}, {5, 0}}, 1.0).empty());
}

TEST(StraightParts, AreTheSidesOfARectangle) {
  const std::vector<Vec2> points = points_in_rectangle(600, 10.0, 6.0);
  const double spacing = std::sqrt(0.1);
  std::vector<Vec2> outline;
  for (const auto& chain : outlines(points, 2.5 * spacing)) {
    if (chain.size() < 20) continue;
    ASSERT_TRUE(outline.empty());
    // From its point nearest to a corner, and back to it.
    std::size_t start = 0;
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if (points[chain[i].index].norm() < points[chain[start].index].norm()) start = i;
    }
    for (std::size_t k = 0; k <= chain.size(); ++k) {
      outline.push_back(points[chain[(start + k) % chain.size()].index]);
    }
  }
  const auto lines = straight_parts(outline, spacing, 0.0);
  ASSERT_EQ(lines.size(), 4u);
  const Vec2 normals[] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
  const double offsets[] = {0.0, 10.0, 6.0, 0.0};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_GT(lines[i].normal.dot(normals[i]), 0.995);
    for (std::size_t k = lines[i].first; k <= lines[i].last; ++k) {
      EXPECT_LE(lines[i].normal.dot(outline[k]), lines[i].offset);
    }
    const auto exact = turned(lines[i], normals[i], outline, spacing);
    ASSERT_TRUE(exact);
    EXPECT_NEAR(exact->offset, offsets[i], 0.3 * spacing);
    EXPECT_LE(exact->offset, offsets[i]);
    const Vec2 aside = (normals[i] + 0.2 * Vec2(-normals[i].y(), normals[i].x())).normalized();
    EXPECT_FALSE(turned(lines[i], aside, outline, spacing));
  }
}

}  // namespace
}  // namespace pcednet::lines
