#include <gtest/gtest.h>

#include "labelled_cube.h"
#include "pcednet/detect/boundary.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/result_cloud.h"
#include "pcednet/detect/train.h"
#include "pcednet/nn/safetensors.h"
#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::detect {
namespace {

/// Four classes of a cube: the edges, and the faces by their own directions do not differ, so by
/// the distance from the edges: 5 within, 2 beside, 0 in the middle.
PointCloud labelled() {
  PointCloud cloud = cube(3000, 1);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::uint8_t& label = cloud.labels[i];
    label = label == kNonEdge ? 0 : label == kSmoothEdge ? 2 : 5;
  }
  return cloud;
}

TrainedModel train_own(const char* classes) {
  const PointCloud cloud = labelled();
  TrainOptions options;
  options.table = parse_classes(classes);
  options.training.epochs = 8;
  options.context = true;
  const TrainingCloud training{"cube", prepare(cloud), cloud.labels};
  return train("own", {&training, 1}, options);
}

EdgeModel own_model(const char* classes = "ground,wall,pipe,a,b,rail=#102030") {
  return train_own(classes).model;
}

class OwnClasses : public testing::Test, protected test::OwnFolder {};

TEST_F(OwnClasses, GetAnOutputEachThatPointsHave) {
  const EdgeModel model = own_model();
  EXPECT_EQ(model.classes, (std::vector<std::uint8_t>{0, 2, 5}));
  EXPECT_EQ(model.network.class_names, (std::vector<std::string>{"ground", "pipe", "rail"}));
  EXPECT_FALSE(model.context.has_value());  // which is of edges
  const PointCloud cloud = labelled();
  const Classification found = classify(prepare(cloud), model);
  std::size_t right = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) right += found.classes[i] == cloud.labels[i];
  EXPECT_GT(static_cast<double>(right) / static_cast<double>(cloud.size()), 0.8);
  EXPECT_EQ(found.p_sharp, std::vector<float>(cloud.size(), 0.0f));
  for (const float p : found.p_class) EXPECT_GE(p, 1.0f / 3 - 1e-5f);
}

TEST_F(OwnClasses, HaveNoContextForOneReason) {
  const TrainedModel trained = train_own("ground,wall,pipe,a,b,rail");
  EXPECT_EQ(trained.no_context, "");  // the first network's doubts do not matter
  EXPECT_EQ(
      trained.notes,
      (std::vector<std::string>{"no context network was trained: context is of edge classes"}));
}

TEST_F(OwnClasses, KeepNamesAndColoursInTheModelFile) {
  const auto file = path("own.safetensors");
  const EdgeModel model = own_model();
  save_model(file, model, Overwrite::kYes);
  const EdgeModel again = load_model(file);
  EXPECT_EQ(again.table, model.table);
  EXPECT_EQ(again.classes, model.classes);
  EXPECT_EQ(again.table[5].colour, (Rgb{16, 32, 48}));
  const PointCloud cloud = labelled();
  EXPECT_EQ(classify(prepare(cloud), again).classes, classify(prepare(cloud), model).classes);
}

TEST_F(OwnClasses, OfADamagedModelFileAreRefused) {
  const auto file = path("damaged.safetensors");
  save_model(file, own_model(), Overwrite::kYes);
  const nn::Safetensors sound = nn::read_safetensors(file);
  const std::pair<const char*, const char*> damages[] = {{"classes", "0 2 6"},
                                                         {"classes", "0 2"},
                                                         {"classes", "2 0 5"},
                                                         {"classes", "0 2 x"},
                                                         {"class_table", ""},
                                                         {"class_table", "0 #000000 a\n"},
                                                         {"format", "pcednet-edge-model-1"}};
  for (const auto& [key, value] : damages) {
    nn::Safetensors content = sound;
    content.metadata[key] = value;
    nn::write_safetensors(file, content, Overwrite::kYes);
    EXPECT_ERROR(ErrorKind::kModelMismatch, load_model(file));
  }
}

TEST_F(OwnClasses, GoIntoTheCloudInPlaceOfEdges) {
  PointCloud cloud = labelled();
  const EdgeModel model = own_model();
  const PreparedCloud prepared = prepare(cloud);
  set_attribute(cloud, make_attribute("scalar_edge_class", cloud.labels));  // of an earlier model
  set_attribute(cloud, make_attribute("scalar_p_sharp", std::vector<float>(cloud.size())));
  cloud.comments = {"kept", "pcednet class 0 #ffffff old"};
  const Classification found = classify(prepared, model);
  add_result(cloud, prepared, found, model);
  EXPECT_EQ(cloud.labels, found.classes);
  EXPECT_EQ(find_attribute(cloud, "scalar_edge_class"), nullptr);
  EXPECT_EQ(find_attribute(cloud, "scalar_p_sharp"), nullptr);
  ASSERT_NE(find_attribute(cloud, "scalar_class"), nullptr);
  EXPECT_EQ(find_attribute(cloud, "scalar_class")->value(7), found.classes[7]);
  EXPECT_FLOAT_EQ(static_cast<float>(find_attribute(cloud, "scalar_p_class")->value(7)),
                  found.p_class[7]);
  EXPECT_EQ(classes_of(cloud.comments), model.table);
  EXPECT_EQ(cloud.comments.front(), "kept");
  EXPECT_EQ(cloud.colours[7], model.table[found.classes[7]].colour);
}

TEST_F(OwnClasses, BesideThoseOfEdgesLeaveTheseTheirColumnsAndBoundary) {
  PointCloud cloud = labelled();
  const EdgeModel model = own_model("edges,pipe,rail");
  EXPECT_EQ(model.classes, (std::vector<std::uint8_t>{0, 2, 5}));
  const PreparedCloud prepared = prepare(cloud);
  Classification found = classify(prepared, model);
  for (std::size_t i = 0; i < 20; ++i) found.classes[i] = 5;
  const auto before = found.classes;
  mark_boundary(prepared, found);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(found.classes[i], 5);
  add_result(cloud, prepared, found, model);
  EXPECT_NE(find_attribute(cloud, "scalar_edge_class"), nullptr);
  EXPECT_NE(find_attribute(cloud, "scalar_p_sharp"), nullptr);
  EXPECT_EQ(find_attribute(cloud, "scalar_class"), nullptr);
}

}  // namespace
}  // namespace pcednet::detect
