#include "pcednet/io/scanners.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pcednet::io {
namespace {

TEST(Scanners, ReplaceOnlyTheCommentsOfOthers) {
  PointCloud cloud;
  cloud.comments = {"made by hand", "scanner X330, serial 7", "scanner 1: a b c"};
  add_scanner({1, 2, 3}, cloud);
  add_scanner(Vec3::Constant(NAN), cloud);
  add_scanner({4.5, 5, -6}, cloud);
  EXPECT_TRUE(are_same(scanners_of_comments(cloud.comments), cloud.scanners));

  set_scanners({{7, 8, 9}}, cloud);
  EXPECT_EQ(cloud.scanners, (std::vector<Vec3>{{7, 8, 9}}));
  EXPECT_EQ(cloud.comments, (std::vector<std::string>{"made by hand", "scanner X330, serial 7",
                                                      "scanner 1: a b c", "scanner 0: 7 8 9"}));
}

}  // namespace
}  // namespace pcednet::io
