#include "pcednet/detect/estimates.h"

#include <gtest/gtest.h>

#include "detect/labelled_cube.h"
#include "pcednet/detect/averages.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/detect/result_cloud.h"

namespace pcednet::detect {
namespace {

/// A cube with noise that is classified and has lost its comments.
PointCloud result_without_comments(double noise, bool with_normals) {
  PointCloud cloud = cube(20000, 3);
  Random random(4);
  for (Vec3& p : cloud.positions) p += noise * normal_vector(random);
  if (!with_normals) cloud.normals.clear();
  const PreparedCloud prepared = prepare(cloud, {.average_noise = true});
  Classification found;
  found.classes.assign(prepared.positions.size(), kNonEdge);
  found.p_sharp = found.p_smooth = std::vector<float>(found.classes.size(), 0.0f);
  PointCloud result = cloud;
  add_result(result, prepared, found, EdgeModel{});
  result.comments.clear();
  return result;
}

TEST(Estimates, AreKnownInResultsThatLostTheirComments) {
  for (const double noise : {0.004, 0.03}) {
    PointCloud result = result_without_comments(noise, false);
    for (std::size_t i = 0; i < result.size(); i += 2) result.normals[i] *= -1.0;
    EXPECT_TRUE(has_lost_comments(result));
    mark_estimates(result);
    EXPECT_TRUE(has_estimated_normals(result)) << noise;
  }
}

TEST(Estimates, AreNotNormalsThatWereGiven) {
  for (const double noise : {0.0, 0.004}) {
    PointCloud result = result_without_comments(noise, true);
    mark_estimates(result);
    EXPECT_FALSE(has_estimated_normals(result)) << noise;
  }
}

TEST(Estimates, AreLookedForInResultsThatLostTheirCommentsAlone) {
  PointCloud result = result_without_comments(0.004, false);
  result.comments = {"pcednet model general"};
  EXPECT_FALSE(has_lost_comments(result));
  result.comments.clear();
  erase_attribute(result, "scalar_p_sharp");
  EXPECT_FALSE(has_lost_comments(result));
  mark_estimates(result);
  EXPECT_FALSE(has_estimated_normals(result));
  EXPECT_FALSE(are_estimates(PointCloud{}));
}

}  // namespace
}  // namespace pcednet::detect
