#include <gtest/gtest.h>

#include <cmath>

#include "io/sample_cloud.h"
#include "io/scratch.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/ply/faces.h"

namespace pcednet::io {
namespace {

TEST(Obj, AveragesTheNormalsOfAVertexOverItsCorners) {
  const Scratch scratch;
  const auto loaded = scratch.read("a.obj",
                                   "# a roof\nmtllib x.mtl\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0\n"
                                   "v 5 5 5\nvn 0 0 2\nvn 0 3 0\nvt 0 0\n"
                                   "f 1//1 2/1/1 3//1\nf -4//-1 -2/1/-2 \\\n -3//2\n");
  ASSERT_EQ(loaded.cloud.size(), 4u);
  const double half = std::sqrt(0.5);
  EXPECT_LT((loaded.cloud.normals[0] - Vec3(0, half, half)).norm(), 1e-15);
  EXPECT_LT((loaded.cloud.normals[1] - Vec3(0, half, half)).norm(), 1e-15);
  EXPECT_EQ(loaded.cloud.normals[2], Vec3(0, 0, 1));
  EXPECT_EQ(loaded.cloud.normals[3], Vec3(0, 0, 0));
  EXPECT_EQ(loaded.cloud.comments, std::vector<std::string>{"a roof"});
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_TRUE(contains(loaded.warnings[0], "1 of 4 normals"));
}

TEST(Obj, KeepsFacesAsPlyHasThem) {
  const Scratch scratch;
  const auto loaded = scratch.read(
      "a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf -1 -2 -4\np 1 2\nl 4\n");
  EXPECT_EQ(triangles_of(loaded.cloud), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {3, 2, 0}}));
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_TRUE(contains(loaded.warnings[0], "2 points (p) are not kept"));
  formats::write_cloud(scratch.path("a.ply"), loaded.cloud);
  EXPECT_EQ(triangles_of(formats::read_cloud(scratch.path("a.ply")).cloud),
            triangles_of(loaded.cloud));
}

TEST(Obj, KeepsLinesAsPlyHasThem) {
  const Scratch scratch;
  const PointCloud cloud =
      scratch.read("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2/1 -1\nl 3 1\nf 1 2 3\n").cloud;
  ASSERT_EQ(cloud.foreign_elements.size(), 2u);
  EXPECT_EQ(cloud.foreign_elements[1].header,
            "element edge 3\nproperty int vertex1\nproperty int vertex2\n");
  formats::write_cloud(scratch.path("a.ply"), cloud, {.ascii = true});
  EXPECT_TRUE(bytes_of(scratch.path("a.ply")).ends_with("\n0 1\n1 2\n2 0\n"));
  EXPECT_EQ(face_count(cloud), 1u);
  EXPECT_EQ(face_count(formats::read_cloud(scratch.path("a.ply")).cloud), 1u);
  EXPECT_EQ(formats::losses("a.obj", cloud),
            (std::vector<std::string>{"element face 1", "element edge 3"}));
}

TEST(Obj, RefusesFacesOfOtherVertices) {
  PointCloud cloud;
  cloud.positions.resize(3);
  cloud.foreign_elements = {make_face_element({3}, {0, 1, 3})};
  EXPECT_TRUE(contains(error_of(ErrorKind::kUnreadable, [&] { triangles_of(cloud); }), "vertex 3"));
}

TEST(Obj, ReadsFacesWhoseNormalsAreMissing) {
  const Scratch scratch;
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
  const std::vector<Triangle> one = {{0, 1, 2}};
  for (const char* face : {"f 1// 2// 3//", "f 1/1/ 2/1/ 3/1/", "f 1/ 2/ 3/", "f 1 2 3"}) {
    const auto loaded = scratch.read("a.obj", vertices + face + "\nf 3//1 2 1\n");
    EXPECT_EQ(triangles_of(loaded.cloud).at(0), one[0]) << face;
    ASSERT_EQ(loaded.cloud.normals.size(), 3u);
    EXPECT_EQ(loaded.cloud.normals[2], Vec3(0, 0, 1));
    EXPECT_TRUE(loaded.cloud.normals[0].isZero(0.0));
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_TRUE(contains(loaded.warnings[0], "2 of 3 normals"));
  }
  for (const char* bad :
       {"0", "2", "-2", "x", "1.5", "99999999999999999999", "-9223372036854775808", "1/"}) {
    const auto loaded =
        scratch.read("a.obj", vertices + "f 1//1 2//1 3//1\nf 1 2//" + bad + " 3/1/" + bad + "\n");
    EXPECT_EQ(triangles_of(loaded.cloud), (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}})) << bad;
    EXPECT_EQ(loaded.cloud.normals, std::vector<Vec3>(3, Vec3(0, 0, 1)));
    ASSERT_EQ(loaded.warnings.size(), 1u) << bad;
    EXPECT_EQ(loaded.warnings[0],
              "2 corners of faces name none of the 1 normals, the first in line 7: read without "
              "normal");
  }
  const auto none = scratch.read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//2 3//3\n");
  EXPECT_FALSE(none.cloud.has_normals());
  EXPECT_EQ(triangles_of(none.cloud), one);
  EXPECT_EQ(none.warnings.size(), 1u);
}

TEST(Obj, PairsNormalsWithVerticesWhereNoFaceDoes) {
  const Scratch scratch;
  const auto equal = scratch.read("a.obj", "v 0 0 0\nv 1 0 0\nvn 0 0 1\nvn 0 2 0\nf 1 2 1\n");
  EXPECT_EQ(equal.cloud.normals.at(1), Vec3(0, 1, 0));
  const auto unequal = scratch.read("b.obj", "v 0 0 0\nv 1 0 0\nvn 0 0 1\n");
  EXPECT_FALSE(unequal.cloud.has_normals());
  EXPECT_EQ(unequal.warnings.size(), 1u);
}

TEST(Obj, ReadsColoursOfBothRanges) {
  const Scratch scratch;
  const auto unit = scratch.read("a.obj", "v 0 0 0 1 0 0.2\nv 1 0 0 0 1 0\n");
  EXPECT_EQ(unit.cloud.colours.at(0), (Rgb{255, 0, 51}));
  const auto bytes = scratch.read("b.obj", "v 0 0 0 255 0 51\nv 1 0 0 0 1 0\n");
  EXPECT_EQ(bytes.cloud.colours.at(0), (Rgb{255, 0, 51}));
  const auto some = scratch.read("c.obj", "v 0 0 0 255 0 51\nv 1 0 0\n");
  EXPECT_TRUE(some.cloud.colours.empty());
  EXPECT_EQ(some.warnings.size(), 1u);
}

TEST(Obj, GivesBackWhatItCanHold) {
  const Scratch scratch;
  PointCloud cloud = sample_cloud();
  cloud.position_type = ScalarType::kFloat64;
  cloud.positions[0] = Vec3(512049.781, 5403059.52, 0.1);
  formats::write_cloud(scratch.path("a.obj"), cloud);
  const PointCloud back = formats::read_cloud(scratch.path("a.obj")).cloud;
  EXPECT_TRUE(same_bits(back.positions, cloud.positions));
  EXPECT_EQ(back.colours, cloud.colours);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_LT((back.normals.at(i) - cloud.normals[i]).norm(), 1.5e-7);  // float and back
  }
  const auto lost = formats::losses("a.obj", cloud);
  EXPECT_EQ(lost,
            (std::vector<std::string>{
                "attributes intensity, scalar_p_sharp, scalar_edge_class, quality", "labels"}));
  cloud.attributes.resize(1);
  EXPECT_EQ(formats::losses("a.obj", cloud).front(), "attribute intensity");
}

TEST(Obj, NamesTheLineOfABrokenStatement) {
  const Scratch scratch;
  const auto unreadable = [&](const std::string& bytes, const std::string& part) {
    const std::string message =
        error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.obj", bytes); });
    EXPECT_TRUE(contains(message, scratch.path("a.obj").string() + part)) << message;
  };
  unreadable("v 1 2\n", ":1: v with 2 numbers");
  unreadable("v 1 2 3\nv 1 2 z\n", ":2: expected a number");
  unreadable("v 1 2 1e999\n", ":1: 1e999 is beyond the largest double");
  unreadable("vn 1 2\n", ":1: expected vn");
  unreadable("v 1 2 3\nf 1 2 1\n", ":2: names v number 2 of 1");
  for (const char* bad :
       {"0", "-2", "x", "1.5", "99999999999999999999", "-9223372036854775808", "/1", "//1"}) {
    unreadable(std::string("v 1 2 3\nvn 0 0 1\nf 1 ") + bad + "\n",
               ":3: expected the index of a v, not");
  }
  EXPECT_TRUE(scratch.read("b.obj", "# nothing\n").cloud.empty());
  EXPECT_TRUE(scratch.read("b.obj", "# nothing\n").cloud.empty());
}

}  // namespace
}  // namespace pcednet::io
