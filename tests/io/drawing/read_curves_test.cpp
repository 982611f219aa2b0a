#include <gtest/gtest.h>

#include "io/scratch.h"
#include "pcednet/io/drawing/read_curves.h"

namespace pcednet::io {
namespace {

using lines::Curve;

std::vector<Curve> read(const Scratch& scratch, const std::string& name, std::string_view bytes) {
  return read_curves(scratch.file(name, bytes));
}

std::string fault(const Scratch& scratch, const std::string& name, std::string_view bytes,
                  ErrorKind kind = ErrorKind::kUnreadable) {
  return error_of(kind, [&] { read(scratch, name, bytes); });
}

using Points = std::vector<Vec3>;

TEST(ReadCurves, ReadsEveryLOfAnObjAsACurve) {
  const Scratch scratch;
  const auto curves =
      read(scratch, "a.OBJ",
           "# lines\nl 1 2 3\nv 1 0 0\nv 2.5 0 0 1\nv 500000.125 -3e1 7\ng boundary\n"
           "l -1/1 -3 \\\n -2\no smooth-edge\nl 1/ 2\ng other\nl 3 2 2\n");
  ASSERT_EQ(curves.size(), 4u);
  const Vec3 a(1, 0, 0), b(2.5, 0, 0), c(500000.125, -30, 7);
  EXPECT_EQ(curves[0].points, (Points{a, b, c}));
  EXPECT_EQ(curves[1].points, (Points{c, a, b}));
  EXPECT_EQ(curves[2].points, (Points{a, b}));
  EXPECT_EQ(curves[3].points, (Points{c, b}));
  EXPECT_EQ(curves[0].edge_class, kSharpEdge);
  EXPECT_EQ(curves[1].edge_class, kBoundary);
  EXPECT_EQ(curves[2].edge_class, kSmoothEdge);
  EXPECT_EQ(curves[3].edge_class, kSharpEdge);
  for (const Curve& curve : curves) {
    EXPECT_EQ(curve.kind, lines::CurveKind::kPolyline);
    EXPECT_FALSE(curve.closed);
  }
}

TEST(ReadCurves, ALineThatReturnsIsClosed) {
  const Scratch scratch;
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const auto loop = read(scratch, "a.obj", vertices + "l 1 2 3 1\n");
  ASSERT_EQ(loop.size(), 1u);
  EXPECT_TRUE(loop[0].closed);
  EXPECT_EQ(loop[0].points.size(), 3u);
  const auto there_and_back = read(scratch, "a.obj", vertices + "l 1 2 1\n");
  EXPECT_FALSE(there_and_back.at(0).closed);
  EXPECT_EQ(there_and_back[0].points.size(), 3u);
}

TEST(ReadCurves, NamesTheLineOfAnObjThatCannotBeRead) {
  const Scratch scratch;
  const std::string vertices = "v 0 0 0\nv 1 0 0\n";
  EXPECT_TRUE(contains(fault(scratch, "a.obj", vertices + "l 1 3\nl 1 2\n"),
                       "a.obj:3: names v number 3 of 2"));
  for (const char* index :
       {"0", "-3", "x", "1.5", "99999999999999999999", "-9223372036854775808"}) {
    const std::string said = fault(scratch, "a.obj", vertices + "\nl 1 " + index + "\n");
    EXPECT_TRUE(contains(said, "a.obj:4: expected the index of a v")) << said;
  }
  EXPECT_TRUE(
      contains(fault(scratch, "a.obj", vertices + "l 9223372036854775807 1"), ":3: names v"));
  EXPECT_TRUE(contains(fault(scratch, "a.obj", vertices + "l 1\n"), "a.obj:3: expected l"));
  EXPECT_TRUE(contains(fault(scratch, "a.obj", vertices + "l 2 2\n"), "a.obj:3: the line is"));
  for (const char* vertex : {"v nan 0 0", "v 0 inf 0", "v 1e200 0 0"}) {
    const std::string said = fault(scratch, "a.obj", std::string(vertex) + "\nv 1 1 1\nl 1 2");
    EXPECT_TRUE(contains(said, "a.obj:1: a coordinate")) << said;
  }
  EXPECT_TRUE(contains(fault(scratch, "a.obj", "v 1 2\n"), "a.obj:1: v with 2 numbers"));
  EXPECT_TRUE(contains(fault(scratch, "a.obj", "v 1 2 1e999\n"), "a.obj:1"));
  EXPECT_TRUE(contains(fault(scratch, "a.obj", vertices, ErrorKind::kInsufficient), "no lines"));
  EXPECT_TRUE(read(scratch, "a.obj", "# nothing\n").empty());
  EXPECT_TRUE(contains(fault(scratch, "a.dxf", "0\nEOF\n"), ".obj and .ply"));
}

constexpr std::string_view kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
    "property double z\nelement edge 5\nproperty int vertex1\nproperty int vertex2\n"
    "property uchar class\nproperty int curve\nend_header\n"
    "500000.125 0 0\n1 0 0\n1 1 0\n0 1 0\n"
    "0 1 2 0\n1 2 2 0\n2 3 1 1\n3 1 1 1\n1 2 1 1\n";

TEST(ReadCurves, JoinsTheEdgesOfAPlyThatFollowOneAnother) {
  const Scratch scratch;
  const auto curves = read(scratch, "a.ply", kPly);
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].points, (Points{{500000.125, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
  EXPECT_EQ(curves[0].edge_class, kSharpEdge);
  EXPECT_FALSE(curves[0].closed);
  EXPECT_EQ(curves[1].points, (Points{{1, 1, 0}, {0, 1, 0}, {1, 0, 0}}));
  EXPECT_EQ(curves[1].edge_class, kSmoothEdge);
  EXPECT_TRUE(curves[1].closed);
}

TEST(ReadCurves, ReadsPlyEdgesOfOtherPrograms) {
  const Scratch scratch;
  const std::string header =
      "ply\nformat binary_big_endian 1.0\nelement edge 2\nproperty list uchar float weights\n"
      "property ushort vertex2\nproperty ushort vertex1\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  const std::string edges =
      packed_reversed(std::uint8_t{1}, 0.5F, std::uint16_t{1}, std::uint16_t{0}) +
      packed_reversed(std::uint8_t{0}, std::uint16_t{1}, std::uint16_t{2});
  const auto curves =
      read(scratch, "a.ply",
           header + edges + packed_reversed(0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F));
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].points, (Points{{0, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(curves[1].points, (Points{{1, 1, 0}, {1, 0, 0}}));
}

std::string with(std::string_view text, std::string_view part, std::string_view other) {
  std::string result(text);
  return result.replace(result.find(part), part.size(), other);
}

TEST(ReadCurves, NamesTheRowOfAPlyThatCannotBeRead) {
  const Scratch scratch;
  EXPECT_TRUE(contains(fault(scratch, "a.ply", with(kPly, "2 3 1 1\n", "2 4 1 1\n")),
                       "a.ply: row 3 of element edge names vertex 4 of 4"));
  EXPECT_TRUE(contains(fault(scratch, "a.ply", with(kPly, "2 3 1 1\n", "-1 3 1 1\n")), "row 3"));
  EXPECT_TRUE(contains(fault(scratch, "a.ply", with(kPly, "500000.125", "nan")),
                       "row 1 of element edge: vertex 0 is not finite"));
  EXPECT_TRUE(
      contains(fault(scratch, "a.ply", with(kPly, "0 1 2 0\n1 2 2 0\n", "1 1 2 0\n1 2 2 1\n")),
               "row 1 of element edge: the line is a single point"));
  EXPECT_TRUE(contains(fault(scratch, "a.ply", with(kPly, "edge 5", "edge 99999999999")), "edge"));
  EXPECT_TRUE(
      contains(fault(scratch, "a.ply", with(kPly, "vertex1", "corner"), ErrorKind::kInsufficient),
               "vertex1"));
  EXPECT_TRUE(
      contains(fault(scratch, "a.ply", with(kPly, "edge 5", "eggs 5"), ErrorKind::kInsufficient),
               "no lines"));
}

/// Every prefix is read or refused with a message that names the file.
TEST(ReadCurves, SurvivesTruncation) {
  const Scratch scratch;
  constexpr std::string_view kObj = "v 0 0 0\nv 1e1 0 0\nv 0 1 0\ng boundary\nl 1 2 -1\nl 3 1\n";
  for (const auto& [name, whole] : {std::pair{"a.obj", kObj}, std::pair{"a.ply", kPly}}) {
    std::size_t refused = 0;
    for (std::size_t length = 0; length < whole.size(); ++length) {
      try {
        for (const Curve& curve : read(scratch, name, whole.substr(0, length))) {
          EXPECT_GE(curve.points.size(), 2u);
        }
      } catch (const Error& error) {
        ++refused;
        EXPECT_TRUE(contains(error.what(), name)) << error.what();
      }
    }
    EXPECT_GT(refused, whole.size() / 2) << name;
  }
}

}  // namespace
}  // namespace pcednet::io
