#include "pcednet/detect/train.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <tuple>

#include "labelled_cube.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/result_cloud.h"
#include "pcednet/nn/model_file.h"
#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::detect {
namespace {

PointCloud permuted(const PointCloud& cloud) {
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random(9).shuffle(std::span(order));
  PointCloud result;
  for (const std::size_t i : order) {
    result.positions.push_back(cloud.positions[i]);
    result.normals.push_back(cloud.normals[i]);
    result.labels.push_back(cloud.labels[i]);
  }
  return result;
}

/// Normals that make every answer of its own doubtful.
PointCloud noisy(PointCloud cloud) {
  Random random(8);
  for (Vec3& n : cloud.normals) {
    n = (n + 0.3 * normal_vector(random)).normalized();
  }
  return cloud;
}

TrainOptions quick(int classes) {
  TrainOptions options;
  options.architecture.classes = classes;
  options.training.epochs = 8;
  return options;
}

TrainedModel train_on(const PointCloud& cloud, const TrainOptions& options) {
  const TrainingCloud training{"cube", prepare(cloud), cloud.labels};
  return train("test", {&training, 1}, options);
}

double accuracy(const PointCloud& cloud, const EdgeModel& model) {
  const auto found = classify(prepare(cloud), model).classes;
  std::size_t right = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    right += (found[i] != kNonEdge) == (cloud.labels[i] != kNonEdge);
  }
  return static_cast<double>(right) / static_cast<double>(found.size());
}

TEST(TrainEdges, LearnsTheEdgesOfACubeItHasNotSeen) {
  const auto trained = train_on(cube(4000, 1), quick(3));
  EXPECT_GT(accuracy(cube(3000, 2), trained.model), 0.93);
}

TEST(TrainEdges, GivesTheSameModelForAnyThreadsAndOrder) {
  const PointCloud cloud = cube(1500, 1);
  const auto reference = train_on(cloud, quick(3)).model.network.network.parameters;
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    EXPECT_EQ(train_on(cloud, quick(3)).model.network.network.parameters, reference) << threads;
  }
  set_thread_count(0);
  EXPECT_EQ(train_on(permuted(cloud), quick(3)).model.network.network.parameters, reference);
}

TEST(TrainEdges, TakesSmoothEdgesForNonEdgesWithTwoClasses) {
  const PointCloud cloud = cube(1500, 1);
  const auto model = train_on(cloud, quick(2)).model;
  const auto result = classify(prepare(cloud), model);
  EXPECT_EQ(result.counts.smooth, 0u);
  EXPECT_GT(result.counts.sharp, 0u);
  EXPECT_EQ(*std::max_element(result.p_smooth.begin(), result.p_smooth.end()), 0.0f);
}

TEST(TrainEdges, TakesBoundaryForNonEdge) {
  PointCloud cloud = cube(1500, 1);
  const auto reference = train_on(cloud, quick(3)).model.network.network.parameters;
  for (std::size_t i = 0; i < cloud.size(); i += 3) {
    if (cloud.labels[i] == kNonEdge) cloud.labels[i] = kBoundary;
  }
  EXPECT_EQ(train_on(cloud, quick(3)).model.network.network.parameters, reference);
}

TEST(TrainEdges, LearnsAtTheSpacingItselfIfAsked) {
  const PointCloud cloud = cube(1500, 1);
  TrainOptions options = quick(3);
  const auto by_extent = train_on(cloud, options).model;
  options.descriptor.range.s_max_ratio = 8.0;
  const auto rounded = train_on(cloud, options).model;
  options.descriptor.range.rounded = false;
  const auto model = train_on(cloud, options).model;
  EXPECT_NE(model.network.network.parameters, rounded.network.network.parameters);
  EXPECT_EQ(model.descriptor, rounded.descriptor);
  const TrainingCloud training{"cube", prepare(cloud), cloud.labels};
  const Samples samples = make_samples({&training, 1}, options.descriptor);
  const auto of_samples = train("test", samples, options).model;
  EXPECT_EQ(of_samples.network.network.parameters, model.network.network.parameters);
  EXPECT_EQ(of_samples.descriptor, rounded.descriptor);
  options.descriptor.range.s_max_ratio = 0.0;
  EXPECT_EQ(train_on(cloud, options).model.network.network.parameters,
            by_extent.network.network.parameters);
}

TEST(TrainEdges, NamesTheCloudWithoutLabels) {
  PointCloud cloud = cube(100, 1);
  std::fill(cloud.labels.begin(), cloud.labels.end(), kUnlabelled);
  const auto error = test::error_of([&] { train_on(cloud, quick(3)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::kInsufficient);
  EXPECT_NE(std::string(error->what()).find("cube"), std::string::npos);
}

TEST(TrainEdges, NamesAMissingClassByItsLabel) {
  PointCloud cloud = cube(300, 1);
  for (const auto& [without, classes, said] :
       {std::tuple(kSharpEdge, 2, "no point is labelled sharp-edge (2)"),
        std::tuple(kSmoothEdge, 3, "no point is labelled smooth-edge (1)")}) {
    PointCloud poor = cloud;
    std::replace(poor.labels.begin(), poor.labels.end(), std::uint8_t{without},
                 std::uint8_t{kUnlabelled});
    const auto error = test::error_of([&, classes = classes] { train_on(poor, quick(classes)); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->kind(), ErrorKind::kInsufficient);
    EXPECT_STREQ(error->what(), said);
  }
}

TEST(TrainEdges, LearnsFromTheAnswersAroundAPoint) {
  TrainOptions options;
  options.context = true;
  const auto trained = train_on(noisy(cube(4000, 1)), options);
  ASSERT_TRUE(trained.model.context.has_value());
  EdgeModel without = trained.model;
  without.context.reset();
  const PointCloud unseen = noisy(cube(3000, 2));
  EXPECT_GT(accuracy(unseen, trained.model), accuracy(unseen, without) + 0.003);
}

TEST(TrainEdges, KeepsTheNetworkWhereThereIsNothingToLookAtTwice) {
  // A class of one point: too sure of the others to find any of them doubtful.
  PointCloud cloud = cube(400, 1);
  for (std::uint8_t& label : cloud.labels) label = label == kSharpEdge ? kSharpEdge : kUnlabelled;
  cloud.labels[std::find(cloud.labels.begin(), cloud.labels.end(), kUnlabelled) -
               cloud.labels.begin()] = kNonEdge;
  TrainOptions options;
  options.architecture.classes = 2;
  options.context = true;
  options.training.epochs = 200;
  const auto trained = train_on(cloud, options);
  EXPECT_FALSE(trained.model.context.has_value());
  EXPECT_EQ(trained.no_context, "none is labelled non-edge (0)");
  EXPECT_GT(trained.epochs, 0);
}

TEST(TrainEdges, KeepsTheNetworkWhenStoppedBeforeItsContext) {
  const PointCloud cloud = cube(1500, 1);
  auto options = quick(2);
  options.context = true;
  bool stop = false;
  const Progress progress = {
      .report = [&](const std::string& stage, double) { stop = stop || stage == "look around"; },
      .cancelled = [&] { return stop; }};
  // A cloud more, so that there is a next one to stop before.
  std::vector<TrainingCloud> clouds;
  for (int i = 0; i < 2; ++i) clouds.push_back({"cube", prepare(cloud), cloud.labels});
  const auto trained = train("test", clouds, options, {}, &progress);
  EXPECT_TRUE(trained.cancelled);
  EXPECT_FALSE(trained.model.context.has_value());
  EXPECT_EQ(trained.epochs, 8);
}

TEST(TrainEdges, GivesTheSameContextNetworkForAnyThreadsAndOrder) {
  auto options = quick(2);
  options.context = true;
  const PointCloud cloud = cube(1500, 1);
  const auto reference = train_on(cloud, options).model.context->network.parameters;
  set_thread_count(8);
  EXPECT_EQ(train_on(permuted(cloud), options).model.context->network.parameters, reference);
  set_thread_count(0);
}

class EdgeModelFile : public testing::Test, protected test::OwnFolder {
 protected:
  const std::filesystem::path path_ = path("a.safetensors");
};

TEST_F(EdgeModelFile, KeepsEverythingThatClassificationNeeds) {
  auto options = quick(3);
  options.descriptor.scales = 8;
  options.descriptor.features = gls::FeatureSet::kInvariant7;
  options.descriptor.side_gate = -0.25;
  options.training.seed = 77;
  const PointCloud cloud = cube(1500, 3);
  const EdgeModel model = train_on(cloud, options).model;
  save_model(path_, model, Overwrite::kNo);
  const EdgeModel loaded = load_model(path_);
  EXPECT_EQ(loaded.name, "test");
  EXPECT_EQ(loaded.seed, 77u);
  EXPECT_EQ(loaded.descriptor.scales, 8);
  EXPECT_EQ(loaded.descriptor.side_gate, -0.25);
  EXPECT_EQ(loaded.descriptor.features, gls::FeatureSet::kInvariant7);
  EXPECT_EQ(classify(prepare(cloud), loaded).p_sharp, classify(prepare(cloud), model).p_sharp);
}

TEST_F(EdgeModelFile, KeepsADescriptionWithTwoGates) {
  auto options = quick(2);
  options.descriptor.side_gate = 0.4;
  options.descriptor.second_gate = -0.3;
  const PointCloud cloud = cube(1500, 3);
  const EdgeModel model = train_on(cloud, options).model;
  EXPECT_EQ(model.network.network.parameters.size(), 2182u);
  save_model(path_, model, Overwrite::kNo);
  const EdgeModel loaded = load_model(path_);
  EXPECT_EQ(loaded.descriptor, model.descriptor);
  EXPECT_EQ(classify(prepare(cloud), loaded).p_sharp, classify(prepare(cloud), model).p_sharp);
  // Turned normals change nothing.
  PointCloud turned = cloud;
  for (Vec3& normal : turned.normals) normal = -normal;
  EXPECT_EQ(classify(prepare(turned), loaded).p_sharp, classify(prepare(cloud), loaded).p_sharp);
}

TEST_F(EdgeModelFile, KeepsTheContextNetwork) {
  auto options = quick(3);
  options.context = true;
  const PointCloud cloud = cube(1500, 3);
  const EdgeModel model = train_on(cloud, options).model;
  save_model(path_, model, Overwrite::kNo);
  const EdgeModel loaded = load_model(path_);
  ASSERT_TRUE(loaded.context.has_value());
  EXPECT_EQ(loaded.context->network.parameters, model.context->network.parameters);
  EXPECT_EQ(classify(prepare(cloud), loaded).p_sharp, classify(prepare(cloud), model).p_sharp);
}

TEST_F(EdgeModelFile, RefusesAContextNetworkForOtherClasses) {
  auto options = quick(3);
  options.context = true;
  EdgeModel model = train_on(cube(800, 3), options).model;
  options.architecture.classes = 2;
  model.context = train_on(cube(800, 3), options).model.context;
  save_model(path_, model, Overwrite::kNo);
  const auto error = test::error_of([&] { load_model(path_); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::kModelMismatch);
  EXPECT_NE(std::string(error->what()).find("context"), std::string::npos);
}

TEST_F(EdgeModelFile, RefusesADescriptorThatIsNotPossible) {
  EdgeModel model = train_on(cube(800, 3), quick(3)).model;
  model.descriptor.side_gate = 0.4;
  model.descriptor.range.s_max_ratio = 8.0;
  save_model(path_, model, Overwrite::kNo);
  const nn::Safetensors content = nn::read_safetensors(path_);
  EXPECT_EQ(load_model(path_).descriptor, model.descriptor);
  for (const auto& [key, value] : {std::pair("descriptor_side_gate", "nan"),
                                   {"descriptor_side_gate", "-1.5"},
                                   {"descriptor_s_max_ratio", "inf"},
                                   {"descriptor_s_max_ratio", "-8"},
                                   {"descriptor_s_max_fraction", "0"},
                                   {"descriptor_projection_steps", "-1"}}) {
    nn::Safetensors changed = content;
    changed.metadata[key] = value;
    nn::write_safetensors(path_, changed, Overwrite::kYes);
    const auto error = test::error_of([&] { load_model(path_); });
    ASSERT_TRUE(error) << key << " " << value;
    EXPECT_EQ(error->kind(), ErrorKind::kModelMismatch) << key << " " << value;
    EXPECT_NE(std::string(error->what()).find(path_.string()), std::string::npos);
  }
}

TEST_F(EdgeModelFile, RefusesANetworkWithoutItsDescriptor) {
  nn::write_safetensors(path_, nn::to_safetensors(train_on(cube(800, 3), quick(3)).model.network));
  const auto error = test::error_of([&] { load_model(path_); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::kModelMismatch);
  EXPECT_NE(std::string(error->what()).find(path_.string()), std::string::npos);
}

TEST(ClassifyEdges, LeavesWhatHasNoPlaceUnlabelledAndKeepsOldLabels) {
  PointCloud cloud = cube(1200, 4);
  const EdgeModel model = train_on(cloud, quick(3)).model;
  const auto old_labels = cloud.labels;
  cloud.positions[10] = Vec3::Constant(std::nan(""));
  const PreparedCloud prepared = prepare(cloud);
  const auto result = classify(prepared, model);
  EXPECT_EQ(result.classes[10], kUnlabelled);
  EXPECT_EQ(result.counts.unlabelled, 1u);
  add_result(cloud, prepared, result, model);
  EXPECT_EQ(cloud.labels, result.classes);
  const Attribute* kept = find_attribute(cloud, "scalar_input_label");
  ASSERT_NE(kept, nullptr);
  EXPECT_EQ(kept->value(5), old_labels[5]);
}

TEST(ClassifyEdges, KeepsOldLabelsBesideAClassOfAnotherProgram) {
  PointCloud cloud = cube(1200, 4);
  const EdgeModel model = train_on(cloud, quick(3)).model;
  for (const char* name : {"scalar_class", "scalar_edge_class"}) {
    PointCloud labelled = cloud;
    set_attribute(labelled, make_attribute(name, std::vector<float>(cloud.size(), 7.0f)));
    const PreparedCloud prepared = prepare(labelled);
    EXPECT_TRUE(add_result(labelled, prepared, classify(prepared, model), model).labels) << name;
    ASSERT_NE(find_attribute(labelled, "scalar_input_label"), nullptr) << name;
  }
}

TEST(PrepareCloud, RefusesWhatHasNoSurface) {
  const PointCloud empty;
  EXPECT_ERROR(ErrorKind::kInsufficient, prepare(empty));
  PointCloud line;
  for (int i = 0; i < 50; ++i) line.positions.emplace_back(i, 0, 0);
  EXPECT_ERROR(ErrorKind::kInsufficient, prepare(line));
}

TEST(PrepareCloud, EstimatesNormalsOutwardsWhereThereAreNone) {
  PointCloud cloud = cube(3000, 5);
  const auto truth = std::exchange(cloud.normals, {});
  const PreparedCloud prepared = prepare(cloud);
  ASSERT_EQ(prepared.normals.size(), cloud.size());
  EXPECT_FALSE(prepared.notes.empty());
  std::size_t outwards = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) outwards += prepared.normals[i].dot(truth[i]) > 0;
  EXPECT_GT(outwards, cloud.size() * 98 / 100);
}

}  // namespace
}  // namespace pcednet::detect
