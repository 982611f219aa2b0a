#include "pcednet/detect/piece.h"

#include <gtest/gtest.h>

#include "labelled_cube.h"
#include "pcednet/core/error.h"
#include "pcednet/core/random.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/part_of_cloud.h"
#include "pcednet/detect/train.h"
#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kBelowForExpert = 1500;

/// A square of rough ground.
PointCloud ground(std::size_t points, std::uint64_t seed) {
  Random random(seed);
  PointCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const double x = random.uniform(), y = random.uniform();
    cloud.positions.emplace_back(x, y, 0.03 * random.normal());
  }
  return cloud;
}

PointCloud without_normals(PointCloud cloud) {
  cloud.normals.clear();
  return cloud;
}

EdgeModel trained_on(const std::vector<PointCloud>& clouds, std::uint64_t seed,
                     const char* classes) {
  TrainOptions options;
  options.descriptor.scales = 4;
  options.training.epochs = 8;
  options.training.seed = seed;
  options.table = parse_classes(classes);
  if (options.table.size() == 2) options.architecture.classes = 2;
  std::vector<TrainingCloud> training;
  for (const PointCloud& cloud : clouds) {
    training.push_back({"cloud", prepare(cloud), cloud.labels});
  }
  return train("model", training, options).model;
}

struct PieceTest : testing::Test {
  static void SetUpTestSuite() {
    PointCloud whole = without_normals(cube(1200, 1)), piece = ground(1200, 1);
    main_ = new EdgeModel(trained_on({cube(2000, 1)}, 1, "edges"));
    few_ = new EdgeModel(trained_on({cube(2000, 1)}, 2, "edges"));
    whole.labels.assign(whole.size(), 0);
    piece.labels.assign(piece.size(), 1);
    pieces_ = new EdgeModel(trained_on({whole, piece}, 3, "whole,piece"));
    both_ = new EdgeModel(*main_);
    join_expert(*both_, *few_, {.below = kBelowForExpert, .estimated = true});
    join_pieces(*both_, *pieces_);
  }
  static void TearDownTestSuite() { delete main_, delete few_, delete pieces_, delete both_; }

  static std::vector<float> found_in(const PointCloud& cloud, const EdgeModel& model) {
    return classify(prepare(cloud), model).p_sharp;
  }

  static inline EdgeModel *main_, *few_, *pieces_, *both_;
};

TEST_F(PieceTest, CountsAsALargeCloud) {
  const PointCloud whole = without_normals(cube(1000, 7)), piece = ground(1000, 7);
  ASSERT_NE(found_in(piece, *main_), found_in(piece, *few_));
  EXPECT_EQ(found_in(whole, *both_), found_in(whole, *few_));
  EXPECT_EQ(found_in(piece, *both_), found_in(piece, *main_));
  EXPECT_FALSE(classify(prepare(piece), *both_).expert);
}

TEST_F(PieceTest, IsOneForADescribedCloudToo) {
  for (const PointCloud& cloud : {without_normals(cube(1000, 7)), ground(1000, 7)}) {
    const DescribedCloud described = describe(prepare(cloud), both_->descriptor);
    EXPECT_EQ(classify(described, cloud.positions, *both_).p_sharp, found_in(cloud, *both_));
  }
}

TEST_F(PieceTest, IsNotAskedWhereNoExpertDependsOnIt) {
  EdgeModel model = *main_;
  join_expert(model, *few_, {.below = kBelowForExpert, .estimated = true});
  join_expert(model, *few_, {.estimated = true});
  join_pieces(model, *pieces_);
  const PointCloud piece = ground(1000, 7);
  const auto prepared = prepare(piece);
  EXPECT_EQ(traits_for(model, prepared).points, CloudTraits{}.points);  // the other expert
  model.experts[0].kind = {.below = 500, .estimated = true};
  EXPECT_EQ(traits_for(model, prepared).points, 1000u);
}

TEST_F(PieceTest, IsDecidedByTheWholeForItsParts) {
  const PointCloud piece = ground(1000, 7);
  PreparedCloud part = prepare(piece);
  PartOfCloud of{
      .pyramids = {{}}, .points = 1000, .wanted = std::vector<std::uint8_t>(piece.size(), 1)};
  part.part = &of;
  EXPECT_EQ(traits_for(*both_, part).points, 1000u);
}

TEST_F(PieceTest, HasItsNetworkInTheFile) {
  const test::OwnFolder folder;
  save_model(folder.path("a"), *both_, Overwrite::kNo);
  const EdgeModel read = load_model(folder.path("a"));
  ASSERT_TRUE(read.pieces);
  EXPECT_EQ(read.pieces->network.parameters, pieces_->network.network.parameters);
  for (const PointCloud& cloud : {without_normals(cube(1000, 7)), ground(1000, 7)}) {
    EXPECT_EQ(found_in(cloud, read), found_in(cloud, *both_));
  }
  EXPECT_FALSE(suited_to(read, {}).pieces);
}

TEST_F(PieceTest, IsToldByAModelOfItsClassesAlone) {
  EdgeModel model = *main_;
  EXPECT_ERROR(ErrorKind::kModelMismatch, join_pieces(model, *few_));
  EdgeModel others = *pieces_;
  others.table[1].name = "part";
  EXPECT_ERROR(ErrorKind::kModelMismatch, join_pieces(model, others));
  others = *pieces_;
  others.descriptor.side_gate = 0.1;
  EXPECT_ERROR(ErrorKind::kModelMismatch, join_pieces(model, others));
  EXPECT_FALSE(model.pieces);
}

}  // namespace
}  // namespace pcednet::detect
