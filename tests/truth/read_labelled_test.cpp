#include "workbench/truth/read_labelled.h"

#include <gtest/gtest.h>

#include "io/scratch.h"
#include "pcednet/core/error.h"
#include "support/expect_error.h"
#include "workbench/truth/abc_features.h"
#include "workbench/truth/colour_labels.h"

namespace pcednet::truth {
namespace {

using io::contains;
using io::error_of;
using io::LoadedCloud;
using io::Scratch;

constexpr const char* kMesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\n";
constexpr const char* kFeatures =
    "curves:\n"
    "- location: [0, 0, 0]\n"
    "  sharp: true\n"
    "  type: Line\n"
    "  vert_indices: [0, 1]\n"
    "  vert_parameters: [3, 4]\n"
    "- sharp: false\n"
    "  vert_indices: [2]\n"
    "- vert_indices:\n"
    "  - 4\n"
    "  sharp: true\n"
    "  nested:\n"
    "    vert_indices: [3]\n"
    "surfaces:\n"
    "- vert_indices: [3, 2]\n"
    "  sharp: true\n";
using Labels = std::vector<std::uint8_t>;
const Labels kExpected = {2, 2, 0, 0, 2};

TEST(AbcFeatures, MarkTheVerticesOfSharpCurves) {
  const Scratch scratch;
  EXPECT_EQ(read_abc_labels(scratch.file("f.yml", kFeatures), 5), kExpected);
}

TEST(AbcFeatures, AreFoundWhereTheDataSetHasThem) {
  const Scratch scratch;
  for (const auto& [mesh, features] : {std::pair{"same/a.obj", "same/a.yml"},
                                       {"b/1_trimesh_0.obj", "b/1_features_0.yml"},
                                       {"c/obj/7/2_trimesh_0.obj", "c/feat/7/2_features_0.yml"}}) {
    const auto file = scratch.file(mesh, kMesh);
    EXPECT_TRUE(find_abc_features(file).empty()) << mesh;
    scratch.file(features, kFeatures);
    const LoadedCloud loaded = read_labelled(file);
    EXPECT_EQ(loaded.cloud.labels, kExpected) << mesh;
    EXPECT_TRUE(contains(loaded.warnings.back(), "labels from")) << mesh;
  }
}

TEST(ReadLabelled, TakesAColumnThatSaysWhetherAPointIsAnEdge) {
  const Scratch scratch;
  const auto file =
      scratch.file("a.csv", "x,y,z,red,green,blue,edge\n0,0,0,9,9,9,0\n1,0,0,9,9,9,1\n");
  const LoadedCloud loaded = read_labelled(file);
  EXPECT_EQ(loaded.cloud.labels, (Labels{0, 2}));
  EXPECT_EQ(loaded.warnings.back(), "labels from its column edge");
}

/// Three points with a label and other columns, as a result of a classification.
std::string result(const std::string& columns, const std::string& rows) {
  return "ply\nformat ascii 1.0\ncomment pcednet model general\nelement vertex 3\nproperty float "
         "x\n"
         "property float y\nproperty float z\nproperty uchar label\n" +
         columns + "end_header\n" + rows;
}

TEST(ReadLabelled, TakesNoResultForATruth) {
  const Scratch scratch;
  const auto read = [&](const std::string& columns, const std::string& rows) {
    return read_labelled(scratch.file("a.ply", result(columns, rows)));
  };
  const std::string input = "property uchar scalar_input_label\n";
  const LoadedCloud given = read(input, "0 0 0 2 1\n1 0 0 2 0\n0 1 0 0 255\n");
  EXPECT_EQ(given.cloud.labels, (Labels{1, 0, 255}));
  EXPECT_TRUE(contains(given.warnings.back(), "scalar_input_label"));
  const LoadedCloud painted = read(input + "property uchar scalar_painted_label\n",
                                   "0 0 0 2 1 255\n1 0 0 2 0 2\n0 1 0 0 255 0\n");
  EXPECT_EQ(painted.cloud.labels, (Labels{255, 2, 0}));
  const LoadedCloud neither = read("", "0 0 0 2\n1 0 0 2\n0 1 0 0\n");
  EXPECT_EQ(neither.cloud.labels, (Labels{2, 2, 0}));
  EXPECT_TRUE(contains(neither.warnings.back(), "no truth"));
}

TEST(ReadLabelled, TakesNoResultInTextOrColoursForATruth) {
  const Scratch scratch;
  const std::string columns = "# pcednet model general\n//X Y Z label scalar_input_label\n";
  const LoadedCloud text =
      read_labelled(scratch.file("a.xyz", columns + "0 0 0 2 1\n1 0 0 2 0\n0 1 0 0 255\n"));
  EXPECT_EQ(text.cloud.labels, (Labels{1, 0, 255}));
  const std::string coloured =
      "v 0 0 0 1 1 1\nv 1 0 0 0.659 0 0\nv 0 1 0 0.659 0 0\nv 0 0 1 1 1 1\n";
  for (const bool is_result : {false, true}) {
    const std::string comment = is_result ? "# pcednet model general\n" : "";
    const LoadedCloud loaded = read_labelled(scratch.file("a.obj", comment + coloured));
    EXPECT_EQ(loaded.cloud.labels, (Labels{0, 2, 2, 0}));
    EXPECT_EQ(contains(loaded.warnings.back(), "no truth"), is_result);
  }
}

TEST(AbcFeatures, RefuseWhatTheyCannotBe) {
  const Scratch scratch;
  const auto message = [&](const std::string& text) -> std::string {
    try {
      read_abc_labels(scratch.file("f.yml", text), 5);
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_TRUE(contains(message("curves:\n- vert_indices: [5]\n"), "f.yml:2"));
  EXPECT_TRUE(contains(message("curves:\n- vert_indices: [-1]\n"), "5 vertices"));
  EXPECT_TRUE(contains(message("surfaces: []\n"), "no curves"));
  EXPECT_TRUE(contains(message(""), "no curves"));
  EXPECT_TRUE(contains(message("curves: [}"), "f.yml:1"));
  EXPECT_NE(message(std::string(100000, '[')), "none");
}

PointCloud painted(const std::vector<std::array<std::uint8_t, 3>>& colours) {
  PointCloud cloud;
  cloud.positions.assign(colours.size(), Vec3::Zero());
  for (const auto& c : colours) cloud.colours.push_back({c[0], c[1], c[2]});
  return cloud;
}

TEST(ColourLabels, ReadTheColoursOfThePaper) {
  EXPECT_EQ(labels_of_colours(painted({{255, 255, 255}, {255, 196, 93}, {168, 0, 0}})),
            (Labels{0, 1, 2}));
  EXPECT_EQ(labels_of_colours(painted({{255, 0, 0}, {90, 90, 90}, {255, 0, 0}})),
            (Labels{2, 0, 2}));
  EXPECT_EQ(labels_of_colours(painted({{168, 0, 0}, {0, 80, 160}, {255, 255, 255}})),
            (Labels{2, kBoundary, 0}));
}

TEST(ColourLabels, LeavePhotographsAlone) {
  EXPECT_TRUE(labels_of_colours(painted({{255, 255, 255}, {255, 196, 93}})).empty());  // no red
  EXPECT_TRUE(labels_of_colours(painted({{168, 0, 0}})).empty());
  EXPECT_TRUE(labels_of_colours(painted({{168, 0, 0}, {255, 255, 255}, {9, 9, 9}})).empty());
  EXPECT_TRUE(labels_of_colours(painted({{168, 0, 0}, {0, 120, 0}})).empty());
  EXPECT_TRUE(labels_of_colours({}).empty());
}

TEST(ReadLabelled, TakesTheCodesOfLas) {
  const Scratch scratch;
  const auto file = scratch.file(
      "a.csv", "x,y,z,label,Classification\n0,0,0,1,2\n1,0,0,1,64\n0,1,0,1,6\n0,0,1,1,1\n");
  const LoadedCloud loaded = read_labelled(file, {{0, 2}, {0, 6}, {2, 64}});
  EXPECT_EQ(loaded.cloud.labels, (Labels{0, 2, 0, kUnlabelled}));
  EXPECT_EQ(loaded.warnings.back(), "labels from its field Classification");
  EXPECT_EQ(read_labelled(file, {}).cloud.labels, (Labels{1, 1, 1, 1}));
  EXPECT_TRUE(error_of(ErrorKind::kInsufficient,
                       [&] {
                         read_labelled(file, {{2, 65}});
                       })
                  .ends_with("a.csv: no point has one of the codes given; its field Classification "
                             "holds 1, 2, 6, 64"));
  const auto without = scratch.file("b.csv", "x,y,z,label\n0,0,0,1\n");
  EXPECT_TRUE(error_of(ErrorKind::kInsufficient, [&] {
                read_labelled(without, {{2, 64}});
              }).ends_with("has no field Classification"));
}

TEST(ReadLabelled, TellsWhereThereAreNone) {
  const Scratch scratch;
  const auto said = [&](const char* codes) {
    return error_of(ErrorKind::kInsufficient, [&] { read_labelled(scratch.file("a.csv", codes)); });
  };
  EXPECT_TRUE(contains(said("x,y,z,Classification\n0,0,0,2\n1,0,0,64\n"), "--las-classification"));
  EXPECT_FALSE(contains(said("x,y,z,Classification\n0,0,0,2\n1,0,0,2\n"), "--las-classification"));
  EXPECT_ERROR(ErrorKind::kInsufficient, read_labelled(scratch.file("a.obj", kMesh)));
  EXPECT_ERROR(ErrorKind::kInsufficient, read_labelled(scratch.file("a.xyz", "0 0 0\n1 1 1\n")));
}

}  // namespace
}  // namespace pcednet::truth
