#include <gtest/gtest.h>

#include "labelled_cube.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/part_of_cloud.h"
#include "pcednet/detect/train.h"
#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kFewer = 1500;

EdgeModel trained(const std::string& name, std::uint64_t seed, double gate = 0.4) {
  const PointCloud cloud = cube(2000, seed);
  TrainOptions options;
  options.descriptor.scales = 4;
  options.descriptor.side_gate = gate;
  options.training.epochs = 2;
  options.training.seed = seed;
  options.context = true;
  const TrainingCloud training{name, prepare(cloud), cloud.labels};
  return train(name, {&training, 1}, options).model;
}

struct ExpertsTest : testing::Test {
  static void SetUpTestSuite() {
    main_ = new EdgeModel(trained("main", 1));
    few_ = new EdgeModel(trained("few", 2));
    both_ = new EdgeModel(*main_);
    join_expert(*both_, *few_, {.below = kFewer});
  }
  static void TearDownTestSuite() { delete main_, delete few_, delete both_; }

  static std::vector<float> found_in(const PointCloud& cloud, const EdgeModel& model) {
    return classify(prepare(cloud), model).p_sharp;
  }

  static inline EdgeModel *main_, *few_, *both_;
};

TEST_F(ExpertsTest, DecideForCloudsOfFewerPointsAlone) {
  const PointCloud below = cube(kFewer - 1, 3), at = cube(kFewer, 3);
  ASSERT_NE(found_in(below, *main_), found_in(below, *few_));
  EXPECT_EQ(found_in(below, *both_), found_in(below, *few_));
  EXPECT_EQ(found_in(at, *both_), found_in(at, *main_));
}

TEST_F(ExpertsTest, DoNotCountCopies) {
  PointCloud cloud = cube(kFewer - 1, 3);
  const PointCloud other = cube(kFewer, 3);
  cloud.labels.clear();
  for (std::size_t i = 0; i < kFewer - 1; ++i) {
    cloud.positions.push_back(cloud.positions[i]);
    cloud.normals.push_back(cloud.normals[i]);
  }
  const Classification found = classify(prepare(cloud), *both_);
  EXPECT_EQ(found.expert, CloudKind{.below = kFewer});
  EXPECT_EQ(found.p_sharp, found_in(cloud, *few_));
  EXPECT_FALSE(classify(prepare(other), *both_).expert);
}

TEST_F(ExpertsTest, LeaveACloudOfGivenScalesToTheOthers) {
  const PointCloud below = cube(kFewer - 1, 3);
  EdgeModel model = *both_;
  model.descriptor.range.s_max = 0.5;
  EXPECT_TRUE(classify(prepare(below), model).expert);
  model.descriptor.range.s_min = 0.05;
  EXPECT_FALSE(classify(prepare(below), model).expert);
}

TEST_F(ExpertsTest, LeaveAPartOfALargeCloudToTheOthers) {
  const PointCloud few = cube(kFewer / 2, 3);
  PreparedCloud part = prepare(few);
  PartOfCloud of{.pyramids = {{}},  // the exact engine uses no levels
                 .points = 10 * kFewer,
                 .wanted = std::vector<std::uint8_t>(few.size(), 1)};
  part.part = &of;
  const auto found_with = [&](EdgeModel model) {
    model.descriptor.engine = gls::Engine::kExact;
    return classify(part, model).p_sharp;
  };
  EXPECT_EQ(found_with(*both_), found_with(*main_));
  of.points = kFewer - 1;
  EXPECT_EQ(found_with(*both_), found_with(*few_));
}

TEST_F(ExpertsTest, StayInTheFile) {
  const test::OwnFolder folder;
  save_model(folder.path("a"), *both_, Overwrite::kNo);
  const EdgeModel read = load_model(folder.path("a"));
  ASSERT_EQ(read.experts.size(), 1u);
  EXPECT_EQ(read.experts[0].kind, CloudKind{.below = kFewer});
  const PointCloud cloud = cube(kFewer - 1, 3), larger = cube(kFewer, 3);
  EXPECT_EQ(found_in(cloud, read), found_in(cloud, *few_));
  EXPECT_EQ(found_in(larger, read), found_in(larger, *main_));
}

TEST_F(ExpertsTest, TheFirstWhoseKindACloudIsOfDecides) {
  EdgeModel model = *main_;
  join_expert(model, *few_, {.below = kFewer, .estimated = true});
  join_expert(model, *main_, {.below = kFewer});
  PointCloud cloud = with_own_normals(cube(kFewer - 1, 3));
  EXPECT_EQ(classify(prepare(cloud), model).expert, CloudKind{.below = kFewer});
  EXPECT_EQ(found_in(cloud, model), found_in(cloud, *main_));
  cloud.normals.clear();
  EXPECT_EQ(found_in(cloud, model), found_in(cloud, *few_));
}

TEST_F(ExpertsTest, DecideAlikeForADescribedCloud) {
  EdgeModel model = *main_;
  join_expert(model, *few_, {.below = kFewer, .estimated = true});
  PointCloud cloud = cube(kFewer - 1, 3);
  cloud.normals.clear();
  const PreparedCloud prepared = prepare(cloud);
  const DescribedCloud described = describe(prepared, model.descriptor);
  EXPECT_EQ(classify(described, cloud.positions, model).p_sharp, found_in(cloud, *few_));
}

TEST_F(ExpertsTest, OfSeveralKindsStayInTheFile) {
  EdgeModel model = *main_;
  join_expert(model, *few_, {.below = 10, .estimated = false});
  join_expert(model, *few_, {.estimated = true, .exact = true});
  const test::OwnFolder folder;
  save_model(folder.path("a"), model, Overwrite::kNo);
  const EdgeModel read = load_model(folder.path("a"));
  ASSERT_EQ(read.experts.size(), 2u);
  EXPECT_EQ(read.experts[0].kind, model.experts[0].kind);
  EXPECT_EQ(read.experts[1].kind, model.experts[1].kind);
  EXPECT_EQ(read.experts[1].network.network.parameters, few_->network.network.parameters);
}

TEST_F(ExpertsTest, AreLeftWithoutContextNetworkToo) {
  EdgeModel model = *both_, few = *few_;
  drop_context(model);
  drop_context(few);
  const PointCloud cloud = cube(kFewer - 1, 3);
  EXPECT_EQ(found_in(cloud, model), found_in(cloud, few));
}

TEST_F(ExpertsTest, AreRefusedIfTheyWantAnotherDescription) {
  EdgeModel model = *main_;
  EXPECT_ERROR(ErrorKind::kModelMismatch,
               join_expert(model, trained("other", 2, -0.3), {.below = kFewer}));
  EXPECT_TRUE(model.experts.empty());
}

TEST_F(ExpertsTest, AreRefusedIfTheyHaveOtherClassesOfTheSameNumber) {
  EdgeModel model = *main_, others = *few_;
  others.table = parse_classes("wall,roof,ground");
  EXPECT_ERROR(ErrorKind::kModelMismatch, join_expert(model, others, {.below = kFewer}));
  EXPECT_TRUE(model.experts.empty());
}

}  // namespace
}  // namespace pcednet::detect
