#include "pcednet/formats/labels.h"

#include <gtest/gtest.h>

#include "io/scratch.h"
#include "pcednet/formats/write_cloud.h"

namespace pcednet::io {
namespace {

using Labels = std::vector<std::uint8_t>;

TEST(Labels, ReadsEveryKindOfFile) {
  const Scratch scratch;
  const Labels expected = {0, 2, 255, 1};
  EXPECT_EQ(formats::read_labels(scratch.file("a.u8", std::string("\0\2\xFF\1", 4))), expected);
  for (const char* name : {"a.txt", "a.csv", "a.lbl", "a.seg"}) {
    EXPECT_EQ(formats::read_labels(scratch.file(name, "# classes\n0\n2\r\n-1\n\n1")), expected)
        << name;
  }
  EXPECT_EQ(formats::read_labels(scratch.file("marked.txt", "\xEF\xBB\xBF\x30\n2\n-1\n1\n")),
            expected);
  PointCloud cloud;
  cloud.positions.resize(4, Vec3::Zero());
  cloud.labels = {1, 1, 1, 1};
  for (const char* name : {"scalar_edge_class", "edge_class"}) {
    for (const std::string format : {"a.ply", "a.pcd", "a.csv"}) {
      cloud.attributes = {make_attribute(name, expected)};
      formats::write_cloud(scratch.path(format), cloud, {.overwrite = Overwrite::kYes});
      EXPECT_EQ(formats::read_labels(scratch.path(format)), expected) << format;
    }
  }
  cloud.attributes.clear();
  cloud.labels = expected;
  formats::write_cloud(scratch.path("b.txt"), cloud);
  EXPECT_EQ(formats::read_labels(scratch.path("b.txt")), expected);
  EXPECT_EQ(formats::read_labels(scratch.file("none.u8", "")), Labels{});
}

TEST(Labels, AreFoundInTheColumnsOfOtherPrograms) {
  PointCloud cloud;
  cloud.positions.resize(4, Vec3::Zero());
  const auto column = [&](const char* name, const std::vector<float>& values) {
    cloud.attributes = {make_attribute("intensity", values), make_attribute(name, values)};
    return formats::edge_column_of(cloud);
  };
  for (const char* name : {"is_edge", "Edge", "edge_label", "scalar_is_edge", "scalar_Edge"}) {
    const auto two = column(name, {0, 1, 1, -1});
    ASSERT_TRUE(two) << name;
    EXPECT_EQ(two->classes, (Labels{0, 2, 2, 255})) << name;
    EXPECT_EQ(two->column, name);
    EXPECT_EQ(column(name, {0, 1, 2, 3})->classes, (Labels{0, 1, 2, 3})) << name;
    EXPECT_FALSE(column(name, {0, 1, 0.5F, 0})) << "a probability";
    EXPECT_FALSE(column(name, {0, 1, 2, 4})) << "a number of an edge";
  }
  for (const char* name : {"label", "scalar_Label"}) {
    EXPECT_EQ(column(name, {0, 1, 1, -1})->classes, (Labels{0, 1, 1, 255})) << name;
    EXPECT_FALSE(column(name, {0, 1, 2, 4})) << name;
  }
  EXPECT_FALSE(column("EdgeOfFlightLine", {0, 1, 0, 1}));
  EXPECT_FALSE(column("classification", {0, 1, 2, 3}));
  EXPECT_EQ(formats::doubtful_column_of(cloud), "classification");
  EXPECT_FALSE(column("Class", {0, 1, 2, 7}));
  EXPECT_EQ(formats::doubtful_column_of(cloud), "");
}

TEST(Labels, RefusesWhatHoldsNone) {
  const Scratch scratch;
  const std::string message = error_of(
      ErrorKind::kUnreadable, [&] { formats::read_labels(scratch.file("a.txt", "1\n256\n")); });
  EXPECT_TRUE(contains(message, "a.txt:2: expected a label")) << message;
  error_of(ErrorKind::kUnreadable, [&] { formats::read_labels(scratch.file("a.lbl", "1 2\n")); });
  error_of(ErrorKind::kUnreadable, [&] { formats::read_labels(scratch.path("missing.u8")); });
  error_of(ErrorKind::kInsufficient,
           [&] { formats::read_labels(scratch.file("b.xyz", "1 2 3\n")); });
  PointCloud cloud;
  cloud.positions = {Vec3(1, 2, 3)};
  cloud.attributes = {make_attribute("edge_class", std::vector<float>{0.5F})};
  error_of(ErrorKind::kInsufficient, [&] { formats::labels_of(cloud, "c.ply"); });
}

}  // namespace
}  // namespace pcednet::io
