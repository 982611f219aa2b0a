#include <gtest/gtest.h>

#include "io/scratch.h"
#include "pcednet/io/ply/faces.h"

namespace pcednet::io {
namespace {

const std::vector<Vec3> kOffSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}};
const std::vector<Triangle> kOffTriangles = {{0, 1, 2}, {0, 2, 3}};
const std::string kOffVertices = "0 0 0\n1 0 0\n1 1 .5\n0 1 -0\n";
const std::string kOffFaces = "4 0 1 2 3\n";

TEST(Off, ReadsEveryWayToBegin) {
  const Scratch scratch;
  for (const char* start : {"OFF\n4 1 4\n", "OFF 4 1 4\n", "OFF4 1 0\r\n", "4 1\n",
                            "\xEF\xBB\xBF\n# made\nOFF # so\n\n4 1 0 # counts\n"}) {
    const auto loaded = scratch.read("a.off", start + kOffVertices + "\n" + kOffFaces);
    EXPECT_EQ(loaded.cloud.positions, kOffSquare) << start;
    EXPECT_FALSE(loaded.cloud.has_normals());
    EXPECT_EQ(triangles_of(loaded.cloud), kOffTriangles);
    EXPECT_TRUE(loaded.warnings.empty());
  }
  const auto commented =
      scratch.read("a.OFF", "#  made by\nOFF\n4 1 0\n" + kOffVertices + kOffFaces);
  EXPECT_EQ(commented.cloud.comments, std::vector<std::string>{"made by"});
}

TEST(Off, ReadsNormalsAndColoursThatTheKeywordAnnounces) {
  const Scratch scratch;
  const auto with =
      scratch.read("a.off", "STCNOFF\n2 0 0\n0 0 0 0 0 2 9 8 7 .5 .25\n1 0 0 0 3 0 6 5 4 0 1\n");
  EXPECT_EQ(with.cloud.normals, (std::vector<Vec3>{{0, 0, 1}, {0, 1, 0}}));
  EXPECT_EQ(with.cloud.colours, (std::vector<Rgb>{{9, 8, 7}, {6, 5, 4}}));
  EXPECT_TRUE(with.cloud.attributes.empty());
  ASSERT_EQ(with.warnings.size(), 1u);
  EXPECT_EQ(with.warnings[0], "2 texture coordinates are not kept");

  const auto fractions = scratch.read("a.off", "COFF\n1 0 0\n0 0 0 1 0.2 0 0.5\n");
  EXPECT_EQ(fractions.cloud.colours, (std::vector<Rgb>{{255, 51, 0}}));
  ASSERT_EQ(fractions.cloud.attributes.size(), 1u);
  EXPECT_EQ(fractions.cloud.attributes[0].name, "alpha");
  EXPECT_EQ(fractions.cloud.attributes[0].value(0), 0.5);
  EXPECT_TRUE(fractions.warnings.empty());

  const auto some = scratch.read("a.off", "COFF\n2 0 0\n0 0 0 1 0 0 0.5\n1 0 0 0 1 0\n");
  EXPECT_TRUE(some.cloud.attributes.empty());
  EXPECT_EQ(some.warnings, std::vector<std::string>{"alphas of 1 of 2 vertices are not kept"});
}

TEST(Off, WarnsOfWhatItLeavesOut) {
  const Scratch scratch;
  const auto loaded = scratch.read(
      "a.off", "OFF\n3 2 0\n0 0 0 1\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 1 2\nmore\n\n");
  EXPECT_EQ(loaded.warnings,
            (std::vector<std::string>{
                "1 vertices have more numbers than the keyword announces: not kept",
                "1 colours of faces are not kept", "1 lines after the last face were not read"}));
  EXPECT_EQ(loaded.cloud.size(), 3u);
  EXPECT_EQ(face_count(loaded.cloud), 2u);
}

TEST(Off, MayBeEmpty) {
  const Scratch scratch;
  const auto none = scratch.read("a.off", "OFF\n0 0 0\n");
  EXPECT_TRUE(none.cloud.empty() && none.cloud.foreign_elements.empty() && none.warnings.empty());
}

TEST(Off, RefusesABrokenFile) {
  const Scratch scratch;
  const auto refused = [&](const std::string& bytes, const std::string& part) {
    const std::string message =
        error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.off", bytes); });
    EXPECT_TRUE(contains(message, scratch.path("a.off").string() + part)) << message;
  };
  refused("", ": the file is empty");
  refused("# nothing\n", ":1: expected OFF and the counts");
  refused("OFF\n", ":1: ends before the counts");
  refused("4OFF\n1 0 0\n", ":1: expected OFF, or C, N or ST before it, not 4OFF");
  refused("OFF BINARY\n1 0 0\n", ":1: binary OFF is not read");
  refused("OFF\n1\n", ":2: expected the counts of vertices, faces and edges, not 1");
  refused("OFF\n-1 0 0\n", ":2: expected the counts");
  refused("mesh\n1 0 0\n", ":1: expected the counts of vertices, faces and edges, not mesh");
  refused("OFF\n4294967296 0 0\n", ":2: more than 2147483647 vertices");
  refused("OFF\n9 0 0\n" + kOffVertices, ":6: ends after 4 of 9 vertices");
  refused("OFF\n1 0 0\n1 2\n", ":3: expected 3 numbers of a vertex, not 2");
  refused("CNOFF\n1 0 0\n1 2 3 0 0 1 7 7\n", ":3: expected 9 numbers of a vertex, not 8");
  refused("OFF\n1 0 0\n1 2 z\n", ":3: expected a number, not z");
  refused("OFF\n4 2 0\n" + kOffVertices + kOffFaces, ":7: ends after 1 of 2 faces");
  refused("OFF\n4 1 0\n" + kOffVertices + "4 0 1 2\n",
          ":7: expected the number of a face's vertices");
  refused("OFF\n4 1 0\n" + kOffVertices + "3 0 1 4\n", ":7: names vertex 4 of 4");
  refused("OFF\n4 1 0\n" + kOffVertices + "3 0 1 -1\n", ":7: names vertex -1 of 4");
}

}  // namespace
}  // namespace pcednet::io
