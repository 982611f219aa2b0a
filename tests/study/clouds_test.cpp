#include "workbench/study/clouds.h"

#include <gtest/gtest.h>

#include "detect/labelled_cube.h"
#include "pcednet/detect/result_cloud.h"
#include "support/expect_error.h"

namespace pcednet::study {
namespace {

PointCloud cube_of(const ClassTable& table) {
  PointCloud cloud = cube(50, 1);
  detect::add_class_comments(cloud, table);
  return cloud;
}

TEST(StudyClouds, AreOfEdgeClasses) {
  const ClassTable edges = edge_classes();
  EXPECT_EQ(make_study_cloud("a", "", cube(50, 1)).cloud.size(), 50u);
  EXPECT_EQ(make_study_cloud("a", "", cube_of(edges)).cloud.size(), 50u);
  ClassTable coloured(edges.begin(), edges.begin() + 3);
  coloured[1].colour = {1, 2, 3};
  EXPECT_EQ(make_study_cloud("a", "", cube_of(coloured)).cloud.size(), 50u);
  for (const char* others : {"ground, wall, pipe", "edges, pipe", "non-edge, sharp-edge"}) {
    const auto error = test::error_of(
        [&] { make_study_cloud("a", "folder/a.ply", cube_of(parse_classes(others))); });
    ASSERT_TRUE(error) << others;
    EXPECT_EQ(error->kind(), ErrorKind::kInsufficient);
    EXPECT_EQ(std::string(error->what()), std::string("folder/a.ply: its classes are ") + others +
                                              "; a study is of edge classes");
  }
}

TEST(StudyClouds, HavePointsAndLabels) {
  PointCloud bare = cube(50, 1);
  bare.labels.clear();
  EXPECT_ERROR(ErrorKind::kInsufficient, make_study_cloud("a", "", bare));
  EXPECT_ERROR(ErrorKind::kInsufficient, make_study_cloud("a", "", {}));
}

}  // namespace
}  // namespace pcednet::study
