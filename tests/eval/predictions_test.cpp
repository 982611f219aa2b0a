#include "pcednet/eval/predictions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "pcednet/io/npy.h"
#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::eval {
namespace {

namespace fs = std::filesystem;
using Classes = std::vector<std::uint8_t>;

class Predicted : public testing::Test, protected test::OwnFolder {
 protected:
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  const ClassTable own_ = {{.name = "ground"}, {.name = "wall"}, {.name = "pipe"}};
  std::vector<Vec3> positions_ = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
};

TEST_F(Predicted, AClassPerPointInTheOrderOfTheCloud) {
  EXPECT_EQ(read_predictions(write("a.txt", "0\n1\n2\n-1\n"), positions_).classes,
            (Classes{0, 1, 2, 255}));
  EXPECT_EQ(read_predictions(write("a.u8", std::string("\2\0\1\0", 4)), positions_).classes,
            (Classes{2, 0, 1, 0}));
  EXPECT_ERROR(ErrorKind::kInsufficient, read_predictions(write("b.u8", "\2"), positions_));
  EXPECT_ERROR(ErrorKind::kInsufficient, read_predictions(write("b.txt", "0\n1\n2\n"), positions_));
  const auto error =
      test::error_of([&] { read_predictions(write("c.txt", "0\n1\n700\n2\n"), positions_); });
  ASSERT_TRUE(error) << "700 is no class";
  EXPECT_NE(std::string(error->what()).find("c.txt:3: expected a class"), std::string::npos);
  std::string points = "300\n";  // as many follow: no label
  for (int i = 0; i < 300; ++i) points += "0 0 0\n";
  EXPECT_EQ(read_predictions(write("d.txt", points), positions_).classes, (Classes{2, 0, 0, 0}));
}

TEST_F(Predicted, AColumnThatSaysWhetherAPointIsAnEdge) {
  const auto file = write("a.csv", "x,y,z,is_edge\n0,0,0,0\n1,0,0,1\n2,0,0,1\n3,0,0,0\n");
  const Predictions found = read_predictions(file, positions_);
  EXPECT_EQ(found.classes, (Classes{0, 2, 2, 0}));
  EXPECT_EQ(found.note, "labels from its column is_edge");
}

TEST_F(Predicted, ArraysOfClassesOrOfScores) {
  const auto npy = [&](const std::vector<std::size_t>& shape, const std::vector<float>& values,
                       const ClassTable& table = edge_classes()) {
    io::NpyWriter writer(folder_ / "a.npy", shape, ScalarType::kFloat32, Overwrite::kYes);
    writer.append(std::span(values));
    writer.commit();
    return read_predictions(folder_ / "a.npy", positions_, table).classes;
  };
  EXPECT_EQ(npy({4}, {0, 2, 1, -1}), (Classes{0, 2, 1, 255}));
  EXPECT_EQ(npy({4, 3}, {.1f, .2f, .7f, 5, 4, 3, 0, 9, 0, 1, 1, 1}), (Classes{2, 0, 1, 0}));
  EXPECT_EQ(npy({4, 2}, {.9f, .1f, .1f, .9f, 0, 1, 1, 0}), (Classes{0, 2, 2, 0}));
  EXPECT_ERROR(ErrorKind::kInsufficient, npy({3}, {0, 0, 0}));
  EXPECT_ERROR(ErrorKind::kInsufficient, npy({4}, {0, .5f, 0, 0}));
  for (const std::size_t columns : {255u, 256u, 300u}) {
    std::vector<float> scores(4 * columns, 0.0f);
    for (std::size_t row = 0; row < 4; ++row) scores[row * columns + columns - 1 - row] = 1.0f;
    const ClassTable many(columns, PointClass{});
    if (columns == 255) {
      EXPECT_EQ(npy({4, columns}, scores, many), (Classes{254, 253, 252, 251}));
    } else {
      EXPECT_ERROR(ErrorKind::kInsufficient, npy({4, columns}, scores, many));
    }
  }
  EXPECT_EQ(npy({4, 2}, {.9f, .1f, .1f, .9f, 0, 1, 1, 0}, own_), (Classes{0, 1, 1, 0}));
  const auto said = [&](const std::vector<std::size_t>& shape, const std::vector<float>& values) {
    const auto error = test::error_of([&] { npy(shape, values); });
    return error ? std::string(error->what()) : std::string();
  };
  EXPECT_NE(said({4}, {0, 2, 7, 0}).find("a.npy: row 2 is 7, no class: there are 0 to 3"),
            std::string::npos);
  EXPECT_NE(said({4}, {0, NAN, 0, 0}).find("a.npy: row 1 is nan, no class"), std::string::npos);
  EXPECT_NE(said({4, 2}, {0, 1, 1, 0, 0, 1, 1, NAN}).find("row 3 is nan"), std::string::npos);
  EXPECT_NE(said({4, 5}, {1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0})
                .find("row 1 is 4, no class"),
            std::string::npos);
}

TEST_F(Predicted, NumbersThatAreNoClassesAreNamedByTheirPlace) {
  const auto said = [&](const std::string& name, const std::string& text,
                        const ClassTable& table = edge_classes()) {
    const auto file = write(name, text);
    const auto error = test::error_of([&] { read_predictions(file, positions_, table); });
    return error ? std::string(error->what()) : std::string();
  };
  EXPECT_NE(said("a.txt", "0\n1\n7\n2\n").find("a.txt:3: expected a class in 0 ... 3, or 255"),
            std::string::npos);
  EXPECT_NE(said("b.txt", "0\nnan\n1\n2\n").find("b.txt:2: expected a class"), std::string::npos);
  EXPECT_NE(said("a.u8", std::string("\2\0\1\7", 4)).find("byte 3: expected a class"),
            std::string::npos);
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar label\nend_header\n";
  EXPECT_NE(said("a.ply", header + "0 0 0 2\n1 0 0 9\n").find("point 1 is 9, no class"),
            std::string::npos);
  EXPECT_NE(said("c.txt", "0\n1\n3\n2\n", own_).find("c.txt:3: expected a class in 0 ... 2"),
            std::string::npos);
  EXPECT_EQ(said("d.txt", "0\n1\n255\n-1\n", own_), "");
}

TEST_F(Predicted, TrueIsSharp) {
  std::string header = "{'descr': '|b1', 'fortran_order': False, 'shape': (4,), }";
  header.resize(117, ' ');
  const auto file = write(
      "a.npy", std::string("\x93NUMPY\1\0\x76\0", 10) + header + "\n" + std::string("\1\0\0\1", 4));
  EXPECT_EQ(read_predictions(file, positions_).classes, (Classes{2, 0, 0, 2}));
}

TEST_F(Predicted, AnotherSamplingGivesTheLabelOfItsNearestPoint) {
  const auto file = write("a.ply",
                          "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\n"
                          "property float y\nproperty float z\nproperty uchar label\nend_header\n"
                          "0.1 0 0 2\n-4 0 0 1\n1.2 0 0 0\n2 0.1 0 1\n3 0 0.3 2\n");
  const Predictions found = read_predictions(file, positions_);
  EXPECT_EQ(found.classes, (Classes{2, 0, 1, 2}));
  EXPECT_FALSE(found.note.empty());
  positions_[1].y() = NAN;
  EXPECT_EQ(read_predictions(file, positions_).classes, (Classes{2, 255, 1, 2}));
}

TEST_F(Predicted, TheSamePointsInAnotherOrderKeepTheirLabels) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nproperty uchar label\nend_header\n";
  const Predictions other_order = read_predictions(
      write("a.ply", header + "3 0 0 2\n1 0 0 1\n0 0 0.00001 0\n2 0 0 1\n"), positions_);
  EXPECT_EQ(other_order.classes, (Classes{0, 1, 1, 2}));
  EXPECT_NE(other_order.note.find("another order"), std::string::npos);
  // Centred and scaled: nothing tells that the order is another one.
  const Predictions elsewhere = read_predictions(
      write("b.ply", header + "-1 0 0 2\n-0.5 0 0 1\n0.5 0 0 0\n1 0 0 1\n"), positions_);
  EXPECT_EQ(elsewhere.classes, (Classes{2, 1, 0, 1}));
  EXPECT_TRUE(elsewhere.note.empty());
}

TEST_F(Predicted, PointsWithoutLabelsAreOnEdges) {
  const Predictions found =
      read_predictions(write("a.xyz", "0.9 0 0\n1.1 0 0\n3.1 0 0\n"), positions_);
  EXPECT_EQ(found.classes, (Classes{0, 2, 0, 2}));
  EXPECT_NE(found.note.find("edge points"), std::string::npos);
}

TEST_F(Predicted, PointsWithoutLabelsAreNoneOfOwnClasses) {
  const auto points = write("a.xyz", "0.9 0 0\n1.1 0 0\n");
  const auto error = test::error_of([&] { read_predictions(points, positions_, own_); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::kInsufficient);
  EXPECT_NE(std::string(error->what()).find("has no labels"), std::string::npos) << error->what();
  const ClassTable both = parse_classes("edges, pipe");
  EXPECT_EQ(read_predictions(points, positions_, both).classes, (Classes{0, 2, 0, 0}));
}

TEST_F(Predicted, AreFoundByTheStemOfTheCloud) {
  const fs::path cloud = write("a.ply", "ply\n");
  EXPECT_TRUE(find_predictions(folder_, "a", cloud).empty());
  write("a_output.xyz", "");
  EXPECT_EQ(find_predictions(folder_, "a", cloud), folder_ / "a_output.xyz");
  write("a_edges.laz", "LASF");
  EXPECT_EQ(find_predictions(folder_, "a", cloud), folder_ / "a_edges.laz");
  write("a.npy", "");
  EXPECT_EQ(find_predictions(folder_, "a", cloud), folder_ / "a.npy");
}

}  // namespace
}  // namespace pcednet::eval
