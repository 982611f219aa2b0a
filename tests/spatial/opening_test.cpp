#include "pcednet/spatial/opening.h"

#include <gtest/gtest.h>

#include <vector>

namespace pcednet::spatial {
namespace {

using std::numbers::pi;

TEST(Opening, IsTheWidestAngleBetweenNeighbouringDirections) {
  std::vector<double> angles = {2.0, -1.0, 0.5};
  const Opening opening = widest_opening(angles);
  EXPECT_DOUBLE_EQ(opening.width, 2.0 * pi - 3.0);
  EXPECT_DOUBLE_EQ(opening.middle, 0.5 * (2.0 + 2.0 * pi - 1.0));
}

TEST(Opening, MayLieBetweenTheFirstAndTheLast) {
  std::vector<double> angles = {3.0, -3.0, -1.0};
  const Opening opening = widest_opening(angles);
  EXPECT_DOUBLE_EQ(opening.width, 4.0);
  EXPECT_DOUBLE_EQ(opening.middle, 1.0);
}

TEST(Opening, OfOneDirectionIsAllAround) {
  std::vector<double> angles = {0.25};
  const Opening opening = widest_opening(angles);
  EXPECT_DOUBLE_EQ(opening.width, 2.0 * pi);
  EXPECT_DOUBLE_EQ(opening.middle, 0.25 + pi);
}

}  // namespace
}  // namespace pcednet::spatial
