#include "workbench/annotate/scene/file_classes.h"

#include <gtest/gtest.h>

#include "pcednet/cloud/class_table.h"

namespace pcednet::annotate {
namespace {

PointCloud six_points() {
  PointCloud cloud;
  for (int i = 0; i < 6; ++i) cloud.positions.push_back(Vec3(i, 0, 0));
  return cloud;
}

std::vector<std::string> names_of(const FileClasses& found) {
  std::vector<std::string> names;
  for (const FileClass& one : found.classes) names.push_back(one.name);
  return names;
}

using Bytes = std::vector<std::uint8_t>;
using Names = std::vector<std::string>;

TEST(FileClasses, AreTheLabelsWithTheirNamesAndCounts) {
  PointCloud cloud = six_points();
  EXPECT_TRUE(file_labels(cloud, "a.ply").ids.empty());
  cloud.labels = Bytes(6, kUnlabelled);
  EXPECT_TRUE(file_labels(cloud, "a.ply").ids.empty());
  cloud.labels = {2, 0, 0, 255, 2, 9};
  const FileClasses found = file_labels(cloud, "a.ply");
  EXPECT_EQ(found.ids, cloud.labels);
  EXPECT_EQ(names_of(found), (Names{"non-edge", "sharp-edge", "class 9"}));
  EXPECT_EQ(found.classes[1].points, 2u);
  EXPECT_EQ(found.classes[1].colour, (Rgb{168, 0, 0}));
}

TEST(FileClasses, AreNamedByTheCommentsOfOwnClasses) {
  PointCloud cloud = six_points();
  cloud.labels = {0, 0, 1, 1, 1, 0};
  cloud.comments = lines_of({{"wall", {1, 2, 3}}, {"pipe", {4, 5, 6}}}, kClassComment);
  EXPECT_EQ(names_of(file_labels(cloud, "a.ply")), (Names{"wall", "pipe"}));
}

TEST(FileClasses, OfAColumnAsCloudCompareKeepsIt) {
  PointCloud cloud = six_points();
  set_attribute(cloud, make_attribute("scalar_is_edge", std::vector<float>{0, 1, 1, 0, 0, 0}));
  EXPECT_EQ(file_labels(cloud, "a.ply").ids, (Bytes{0, 2, 2, 0, 0, 0}));
}

TEST(FileClasses, OfAResultAreThoseThatWerePainted) {
  PointCloud cloud = six_points();
  cloud.labels = {0, 0, 0, 0, 0, 2};
  for (const char* name : {"scalar_edge_class", "scalar_p_sharp", "scalar_p_smooth"}) {
    set_attribute(cloud, make_attribute(name, std::vector<float>{0, 0, 0, 0, 0, 0}));
  }
  set_attribute(cloud, make_attribute("scalar_edge_class", cloud.labels));
  EXPECT_EQ(file_labels(cloud, "a.ply").ids, cloud.labels);
  EXPECT_TRUE(file_labels(cloud, "a.ply").are_predicted);
  const Bytes painted = {255, 255, 2, 2, 0, 0};
  set_attribute(cloud, make_attribute("scalar_painted_label", painted));
  EXPECT_EQ(file_labels(cloud, "a.ply").ids, painted);
  EXPECT_FALSE(file_labels(cloud, "a.ply").are_predicted);
}

TEST(FileClasses, AColumnOfOtherNumbersIsPassedOver) {
  PointCloud cloud = six_points();
  set_attribute(cloud, make_attribute("edge_class", std::vector<float>{0.5f, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(file_labels(cloud, "a.ply").ids.empty());
  set_attribute(cloud, make_attribute("Classification", std::vector<float>{0.5f, 0, 2, 0, 0, 0}));
  EXPECT_TRUE(las_classes(cloud).ids.empty());
}

TEST(FileClasses, OfLasHaveTheNamesOfTheStandard) {
  PointCloud cloud = six_points();
  EXPECT_TRUE(las_classes(cloud).ids.empty());
  set_attribute(cloud, make_attribute("Classification", Bytes{1, 1, 1, 1, 1, 1}));
  EXPECT_TRUE(las_classes(cloud).ids.empty()) << "one class tells nothing";
  const std::vector<float> codes = {2, 6, 6, 70, 22, 2};
  erase_attribute(cloud, "Classification");
  set_attribute(cloud, make_attribute("scalar_Classification", codes));
  const FileClasses found = las_classes(cloud);
  EXPECT_EQ(found.ids, (Bytes{2, 6, 6, 70, 22, 2}));
  EXPECT_EQ(names_of(found),
            (Names{"2 ground", "6 building", "22 temporal exclusion", "class 70"}));
}

TEST(FileClasses, TellTheErrorsOfAPrediction) {
  EXPECT_EQ(error_of(kNonEdge, kSmoothEdge), 0);
  EXPECT_EQ(error_of(kSharpEdge, kSharpEdge), 1);
  EXPECT_EQ(error_of(kSharpEdge, kBoundary), 2);
  EXPECT_EQ(error_of(kSmoothEdge, kSharpEdge), 3);
  EXPECT_EQ(error_of(kUnlabelled, kSharpEdge), kUnlabelled);
  EXPECT_EQ(error_of(kSharpEdge, kUnlabelled), kUnlabelled);
}

}  // namespace
}  // namespace pcednet::annotate
