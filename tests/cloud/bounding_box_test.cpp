#include "pcednet/cloud/bounding_box.h"

#include <cmath>
#include <vector>

#include "cloud/not_finite.h"
#include "support/expect_error.h"

namespace pcednet {
namespace {

TEST(BoundingBox, HoldsTheFinitePointsAlone) {
  const std::vector<Vec3> positions = {{1, -2, 3},         {kNan, 100, 100}, {-1, 4, 3},
                                       {0, 0, -kInfinity}, {0, 5, 3.5},      {0, kInfinity, 0}};
  const BoundingBox box = bounding_box(positions);
  EXPECT_FALSE(box.empty());
  EXPECT_EQ(box.min, Vec3(-1, -2, 3));
  EXPECT_EQ(box.max, Vec3(1, 5, 3.5));
  EXPECT_EQ(box.centre(), Vec3(0, 1.5, 3.25));
  EXPECT_DOUBLE_EQ(box.diagonal(), std::sqrt(4 + 49 + 0.25));
}

TEST(BoundingBox, OfNothingIsEmptyAndOfOnePointIsNot) {
  EXPECT_TRUE(bounding_box({}).empty());
  EXPECT_EQ(bounding_box({}).diagonal(), 0.0);
  EXPECT_TRUE(bounding_box(std::vector<Vec3>{{kNan, 0, 0}}).empty());
  const BoundingBox point = bounding_box(std::vector<Vec3>{{7, 8, 9}});
  EXPECT_FALSE(point.empty());
  EXPECT_EQ(point.diagonal(), 0.0);
  EXPECT_EQ(point.centre(), Vec3(7, 8, 9));
}

TEST(BoundingBox, GrowsByPointsAndBoxes) {
  BoundingBox box;
  box.add(BoundingBox());
  EXPECT_TRUE(box.empty());
  box.add(Vec3(1, -2, 3));
  box.add(BoundingBox{{-1, 0, 2}, {0, 4, 2.5}});
  box.add(BoundingBox());
  EXPECT_EQ(box.min, Vec3(-1, -2, 2));
  EXPECT_EQ(box.max, Vec3(1, 4, 3));
}

TEST(BoundingBox, RefusesCoordinatesWhoseSquaresOverflow) {
  EXPECT_NO_THROW(check_extent({}));
  EXPECT_NO_THROW(check_extent(std::vector<Vec3>{{1e150, -1e150, 0}, {kNan, 1e200, 0}}));
  EXPECT_NO_THROW(check_extent(std::vector<Vec3>{{kInfinity, 0, 0}}));
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, -1.5e150, 2}, {1e300, 0, 0}};
  EXPECT_ERROR(ErrorKind::kInsufficient, check_extent(positions));
  try {
    check_extent(positions);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("1.5e+150 at point 1;"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pcednet
