#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/scratch.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/ply/faces.h"

namespace pcednet::io {
namespace {

/// A row of a binary STL; its normal is nonsense, which readers pass over.
std::string stl_row(const Vec3& a, const Vec3& b, const Vec3& c, std::uint16_t attributes = 0) {
  std::string row = packed(NAN, 7.0F, 0.0F);
  for (const Vec3& p : {a, b, c}) {
    for (int axis = 0; axis < 3; ++axis) row += packed(static_cast<float>(p[axis]));
  }
  return row + packed(attributes);
}

/// Two triangles of a square, the second of which says 0 as -0.
std::string square_rows() {
  return stl_row({0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}) +
         stl_row({-0.0, 0, 0}, {1, 1, 0.5}, {0, 1, -0.0});
}

std::string binary_stl(const std::string& start, std::uint32_t count, const std::string& rows) {
  std::string header = start;
  header.resize(80, start.empty() ? '\0' : ' ');
  return header + packed(count) + rows;
}

const std::vector<Vec3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}};
const std::vector<Triangle> kTriangles = {{0, 1, 2}, {0, 2, 3}};

const std::string kFacet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 1 1 .5\n endloop\n"
    "endfacet\n";
const std::string kSecond =
    "  FACET NORMAL nan -nan(ind) 0\r\n\tOuter Loop\r\n VERTEX -0.0 0 0\r\nvertex 1e0 +1 "
    "5e-1\r\n\r\n"
    "vertex 0 1 0\r\nendloop\r\nendfacet\r\n";

TEST(Stl, MergesEqualCornersOfABinaryFile) {
  const Scratch scratch;
  for (const char* start : {"", "solid made by a program"}) {
    const auto loaded = scratch.read("a.stl", binary_stl(start, 2, square_rows()));
    EXPECT_EQ(loaded.cloud.positions, kSquare) << start;
    EXPECT_EQ(loaded.cloud.position_type, ScalarType::kFloat32);
    EXPECT_FALSE(loaded.cloud.has_normals());
    EXPECT_EQ(triangles_of(loaded.cloud), kTriangles);
    EXPECT_TRUE(loaded.warnings.empty());
  }
}

TEST(Stl, ReadsTextInAnyCapitalsAndOfSeveralSolids) {
  const Scratch scratch;
  for (const std::string& text :
       {"solid a b\n" + kFacet + kSecond + "endsolid a b\n",
        "\xEF\xBB\xBF\n SOLID\n" + kFacet + "ENDSOLID\nsolid b\n" + kSecond + "endsolid b\n"}) {
    const auto loaded = scratch.read("a.STL", text);
    EXPECT_EQ(loaded.cloud.positions, kSquare);
    EXPECT_EQ(loaded.cloud.position_type, ScalarType::kFloat64);
    EXPECT_EQ(triangles_of(loaded.cloud), kTriangles);
    EXPECT_TRUE(loaded.warnings.empty());
  }
}

TEST(Stl, ComesBackThroughPly) {
  const Scratch scratch;
  const auto loaded = scratch.read("a.stl", binary_stl("", 2, square_rows()));
  formats::write_cloud(scratch.path("a.ply"), loaded.cloud);
  const PointCloud back = formats::read_cloud(scratch.path("a.ply")).cloud;
  EXPECT_EQ(back.positions, kSquare);
  EXPECT_EQ(triangles_of(back), kTriangles);
}

TEST(Stl, WarnsOfWhatItLeavesOut) {
  const Scratch scratch;
  const auto more = scratch.read("a.stl", binary_stl("", 1, square_rows()));
  ASSERT_EQ(more.warnings.size(), 1u);
  EXPECT_EQ(more.warnings[0], "50 bytes after the last triangle were not read");
  EXPECT_EQ(more.cloud.size(), 3u);
  const auto coloured =
      scratch.read("a.stl", binary_stl("", 1, stl_row({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1)));
  ASSERT_EQ(coloured.warnings.size(), 1u);
  EXPECT_TRUE(contains(coloured.warnings[0], "of 1 triangles are not kept"));
  const auto open = scratch.read("a.stl", "solid a\n" + kFacet);
  ASSERT_EQ(open.warnings.size(), 1u);
  EXPECT_TRUE(contains(open.warnings[0], "without endsolid"));
  EXPECT_EQ(open.cloud.size(), 3u);
}

TEST(Stl, KeepsCornersThatAreNotFinite) {
  const Scratch scratch;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto loaded =
      scratch.read("a.stl", binary_stl("", 2,
                                       stl_row({nan, 0, 0}, {1, 0, 0}, {0, 1, 0}) +
                                           stl_row({nan, 0, 0}, {INFINITY, 0, 0}, {1, 0, 0})));
  EXPECT_EQ(triangles_of(loaded.cloud), (std::vector<Triangle>{{0, 1, 2}, {0, 3, 1}}));
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_EQ(loaded.warnings[0], "2 of 4 positions are not finite");
}

TEST(Stl, MayBeEmpty) {
  const Scratch scratch;
  EXPECT_TRUE(scratch.read("a.stl", binary_stl("", 0, "")).cloud.empty());
  const auto text = scratch.read("a.stl", "solid a\nendsolid a\n");
  EXPECT_TRUE(text.cloud.empty() && text.cloud.foreign_elements.empty());
}

TEST(Stl, RefusesABrokenFile) {
  const Scratch scratch;
  const auto refused = [&](const std::string& bytes, const std::string& part) {
    const std::string message =
        error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.stl", bytes); });
    EXPECT_TRUE(contains(message, scratch.path("a.stl").string() + part)) << message;
  };
  refused("", ": the file is empty");
  refused("s", ": ends after 1 bytes");
  refused(std::string(83, 'x'), ": ends after 83 bytes");
  refused(binary_stl("", 3, square_rows()), ": declares 3 triangles of 50 bytes, but ends 100");
  refused(binary_stl("solid", 3, square_rows()), ": declares 3 triangles");
  refused(binary_stl("", 0xffffffffU, square_rows()), ": declares 4294967295 triangles");
  refused("solid a\nfacet\nvertex 1 2\n", ":3: expected vertex x y z");
  refused("solid a\nfacet\nvertex 1 2 z\n", ":3: expected a number, not z");
  refused("solid a\nfacet\nvertex 1 2 3\nendfacet\n", ":4: a facet of 1 vertices, not 3");
  refused("solid a\nfacet\nendfacet\n", ":3: a facet of 0 vertices, not 3");
  refused("solid a\n" + kFacet + "vertex 1 2 3\n", ":9: ends within a facet");
  refused("solid a\nvertex 1 2 3\nendsolid\n", ":3: endsolid within a facet");
  refused("solid a\nvertex 1 2 3\nvertex 1 2 3\nvertex 1 2 3\nvertex 1 2 3\n",
          ":5: a facet of more than 3 vertices");
  refused("solid a\n" + kFacet + "endso", ":9: expected a statement of STL, not endso");
}

}  // namespace
}  // namespace pcednet::io
