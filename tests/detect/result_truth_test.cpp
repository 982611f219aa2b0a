#include "pcednet/detect/result_truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pcednet/detect/result_cloud.h"

namespace pcednet::detect {
namespace {

using Labels = std::vector<std::uint8_t>;

/// Three points that are classified, with labels and, if it is given, a painted label each.
PointCloud classified(const Labels& labels, const Labels& painted = {}) {
  PointCloud cloud;
  cloud.positions.assign(3, Vec3::Zero());
  cloud.labels = labels;
  EdgeModel model;
  model.name = "any";
  Classification found;
  found.classes = {2, 2, 0};
  found.p_sharp = found.p_smooth = {0, 0, 0};
  add_result(cloud, std::span<const Vec3>(), found, model);
  if (!painted.empty()) set_attribute(cloud, make_attribute("scalar_painted_label", painted));
  return cloud;
}

TEST(ResultTruth, IsTheLabelsThatWerePaintedOrThoseOfTheInput) {
  const auto given = truth_of_result(classified({1, 0, 255}));
  ASSERT_TRUE(given);
  EXPECT_EQ(given->labels, (Labels{1, 0, 255}));
  EXPECT_NE(given->note.find("scalar_input_label"), std::string::npos);
  const auto painted = truth_of_result(classified({1, 0, 255}, {255, 2, 0}));
  ASSERT_TRUE(painted);
  EXPECT_EQ(painted->labels, (Labels{255, 2, 0}));
  EXPECT_NE(painted->note.find("scalar_painted_label"), std::string::npos);
  EXPECT_EQ(truth_of_result(classified({1, 0, 255}, {255, 255, 255}))->labels, (Labels{1, 0, 255}))
      << "nothing is painted";
}

TEST(ResultTruth, IsNoneWhereAResultHasItsOwnLabelsAlone) {
  const auto truth = truth_of_result(classified({}));
  ASSERT_TRUE(truth);
  EXPECT_TRUE(truth->labels.empty());
  EXPECT_NE(truth->note.find("no truth"), std::string::npos);
}

TEST(ResultTruth, TakesColumnsOfOneLabelAPoint) {
  PointCloud cloud = classified({});
  set_attribute(cloud, make_attribute("scalar_input_label", std::vector<float>{1, 0, 2}));
  EXPECT_EQ(truth_of_result(cloud)->labels, (Labels{1, 0, 2}));
  for (const float wrong : {0.5f, -1.0f, 256.0f, std::nanf("")}) {
    set_attribute(cloud, make_attribute("scalar_input_label", std::vector<float>{1, wrong, 2}));
    EXPECT_TRUE(truth_of_result(cloud)->labels.empty()) << wrong;
  }
  set_attribute(cloud, make_attribute("scalar_input_label", Labels{1, 0, 2, 1, 0, 2}));
  cloud.attributes.back().components = 2;
  EXPECT_TRUE(truth_of_result(cloud)->labels.empty());
}

TEST(ResultTruth, IsOfResultsAlone) {
  PointCloud cloud = classified({1, 0, 255});
  cloud.comments.clear();
  EXPECT_TRUE(truth_of_result(cloud)) << "by its columns, as other programs drop the comments";
  cloud.attributes.pop_back();
  ASSERT_FALSE(find_attribute(cloud, "scalar_p_sharp") && find_attribute(cloud, "scalar_p_smooth"));
  EXPECT_FALSE(truth_of_result(cloud));
}

TEST(ResultTruth, IsTheColumnThatWasCorrected) {
  PointCloud cloud = classified({});
  cloud.comments.clear();
  set_attribute(cloud, make_attribute("scalar_p_sharp", std::vector<float>{.9f, .8f, .1f}));
  set_attribute(cloud, make_attribute("scalar_edge_class", std::vector<float>{0, 2, 0}));
  auto truth = truth_of_result(cloud);
  EXPECT_EQ(truth->labels, (Labels{0, 2, 0}));
  EXPECT_NE(truth->note.find("scalar_edge_class, which was corrected"), std::string::npos);
  set_attribute(cloud, make_attribute("scalar_edge_class", Labels{2, 2, 0}));
  cloud.labels = {2, 0, 255};
  truth = truth_of_result(cloud);
  EXPECT_EQ(truth->labels, (Labels{2, 0, 255}));
  EXPECT_NE(truth->note.find("label, which was corrected"), std::string::npos);
  cloud.labels.clear();  // as in LAS
  EXPECT_EQ(truth_of_result(cloud)->labels, (Labels{2, 2, 0}));
}

}  // namespace
}  // namespace pcednet::detect
