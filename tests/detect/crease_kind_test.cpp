#include "pcednet/detect/crease_kind.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "labelled_cube.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/train.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kKindPoints = 6000;

/// Edges everywhere, as likely sharp as smooth.
Classification undecided(std::size_t points) {
  Classification found = nothing_found(points);
  found.classes.assign(points, kSmoothEdge);
  found.p_sharp.assign(points, 0.4f);
  found.p_smooth.assign(points, 0.4f);
  return found;
}

TEST(CreaseKind, TellsSharpEdgeFromWhatIsBeside) {
  const PointCloud cloud = cube(kKindPoints, 1);
  const double unit = 1.2 * std::sqrt(6.0 / kKindPoints);
  Classification found = undecided(kKindPoints);
  apply_crease_kind(cloud.positions, spatial::curve_order(cloud.positions), unit, kLeastEdge,
                    found);
  std::size_t near = 0, near_sharp = 0, beside = 0, beside_smooth = 0;
  for (std::size_t i = 0; i < kKindPoints; ++i) {
    EXPECT_NEAR(found.p_sharp[i] + found.p_smooth[i], 0.8f, 1e-6f);
    Vec3 away = (0.5 - cloud.positions[i].cwiseAbs().array()).matrix();
    std::sort(away.data(), away.data() + 3);
    const double distance = away[1] / unit;
    near += distance < 0.4, near_sharp += distance < 0.4 && found.classes[i] == kSharpEdge;
    const bool is_beside = distance > 0.56 && distance < 1.4;
    beside += is_beside, beside_smooth += is_beside && found.classes[i] == kSmoothEdge;
  }
  EXPECT_GT(near_sharp, near * 95 / 100);
  EXPECT_GT(beside_smooth, beside * 95 / 100);
}

TEST(CreaseKind, LeavesAloneWhatIsNoEdgeOrOfAnotherClass) {
  const PointCloud cloud = cube(kKindPoints, 2);
  Classification found = undecided(kKindPoints);
  found.classes[0] = kUnlabelled, found.classes[1] = kBoundary + 1;
  for (std::size_t i = 2; i < kKindPoints; ++i) {
    found.classes[i] = kNonEdge;
    found.p_sharp[i] = found.p_smooth[i] = i % 2 == 0 ? 0.001f : 0.2f;
  }
  const Classification before = found;
  apply_crease_kind(cloud.positions, spatial::curve_order(cloud.positions),
                    1.2 * std::sqrt(6.0 / kKindPoints), kLeastEdge, found);
  EXPECT_EQ(found.classes, before.classes);
  for (std::size_t i = 0; i < kKindPoints; ++i) {
    if (i >= 2 && i % 2 == 1) continue;
    EXPECT_EQ(found.p_sharp[i], before.p_sharp[i]) << i;
  }
  EXPECT_NE(found.p_sharp, before.p_sharp);
  found = before;
  apply_crease_kind(cloud.positions, spatial::curve_order(cloud.positions),
                    1.2 * std::sqrt(6.0 / kKindPoints), 0.5f, found);
  EXPECT_EQ(found.p_sharp, before.p_sharp);
}

EdgeModel trained(int classes) {
  const PointCloud cloud = cube(2000, 1);
  TrainOptions options;
  options.descriptor.scales = 4;
  options.architecture.classes = classes;
  options.training.epochs = 2;
  const TrainingCloud training{"cube", prepare(cloud), cloud.labels};
  return train("cube", {&training, 1}, options).model;
}

TEST(CreaseKind, IsAskedForByNetworksForExactPointsOfThreeClasses) {
  PointCloud cloud = cube(3000, 3);
  cloud.normals.clear();
  const PreparedCloud prepared = prepare(cloud);
  ASSERT_TRUE(prepared.decision.exact);
  const auto found_with = [&](const EdgeModel& model) { return classify(prepared, model); };
  for (const int classes : {2, 3}) {
    const EdgeModel alone = trained(classes);
    EdgeModel exact = alone, estimated = alone;
    join_expert(exact, alone, {.exact = true});
    join_expert(estimated, alone, {.estimated = true});
    const Classification by_networks = found_with(alone), found = found_with(exact);
    EXPECT_EQ(found_with(estimated).p_sharp, by_networks.p_sharp);
    EXPECT_EQ(found.p_sharp == by_networks.p_sharp, classes == 2);
    const DescribedCloud described = describe(prepared, exact.descriptor);
    const Classification again = classify(described, cloud.positions, exact);
    EXPECT_EQ(again.p_sharp, found.p_sharp);
    EXPECT_EQ(again.classes, found.classes);
  }
}

}  // namespace
}  // namespace pcednet::detect
