#include "pcednet/gls/neighbourhood.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gls/test_clouds.h"

namespace pcednet::gls {
namespace {

TEST(Neighbourhood, OfEachRadiusIsAPrefixOnceOrderedByShell) {
  test::Stream stream(4);
  for (const std::size_t count : {4u, 16u, 128u}) {
    std::vector<double> radii;
    for (std::size_t s = 1; s <= count; ++s) radii.push_back(0.25 * static_cast<double>(s));
    std::vector<spatial::Neighbour> neighbours, scratch;
    for (std::uint32_t i = 0; i < 500; ++i) {
      // Every fourth lies at a radius exactly.
      double distance = radii.back() * stream.uniform();
      if (i % 4 == 0) distance = std::floor(distance * 4) / 4;
      neighbours.push_back({i, distance * distance});
    }
    order_by_shell(radii, neighbours, scratch);
    ASSERT_EQ(neighbours.size(), 500u);
    std::size_t begin = 0;
    for (const double radius : radii) {
      std::size_t end = begin;
      while (end < 500 && neighbours[end].sq_distance < radius * radius) ++end;
      for (std::size_t i = end; i < 500; ++i) {
        ASSERT_GE(neighbours[i].sq_distance, radius * radius);
      }
      for (std::size_t i = begin + 1; i < end; ++i) {
        ASSERT_LT(neighbours[i - 1].index, neighbours[i].index) << "the order within a shell";
      }
      begin = end;
    }
    EXPECT_EQ(begin, 500u);
  }
}

TEST(Neighbourhood, GateClosesLinearly) {
  const Vec3 up(0, 0, 1);
  const auto tilted = [](double cosine) { return Vec3(std::sqrt(1 - cosine * cosine), 0, cosine); };
  EXPECT_EQ(side_gate(tilted(-0.2), up, -0.2), 0.0);
  EXPECT_EQ(side_gate(tilted(-0.9), up, -0.2), 0.0);
  EXPECT_NEAR(side_gate(tilted(-0.05), up, -0.2), 0.5, 1e-15);
  EXPECT_EQ(side_gate(tilted(0.2), up, -0.2), 1.0);
}

}  // namespace
}  // namespace pcednet::gls
