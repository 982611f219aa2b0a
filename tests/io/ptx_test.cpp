#include <gtest/gtest.h>

#include <cmath>

#include "io/scratch.h"
#include "pcednet/formats/write_cloud.h"

namespace pcednet::io {
namespace {

const std::string kAxes = "1 0 0\n0 1 0\n0 0 1\n";
const std::string kIdentity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

/// The header of a scan that is moved to (100, 200, 3) and turned from x to y.
std::string turned_header(const std::string& size) {
  return size + "100 200 3\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n100 200 3 1\n";
}

const std::string kCells = "1 0 0 .25\n0 0 0 0.500000\n0 2 0 1\n5 6 7 0\n";

const Attribute* attribute(const PointCloud& cloud, const char* name) {
  const Attribute* found = find_attribute(cloud, name);
  EXPECT_NE(found, nullptr) << name;
  return found;
}

TEST(Ptx, MovesTheGridOfAScanAndLeavesEmptyCellsOut) {
  const Scratch scratch;
  const auto loaded = scratch.read("a.ptx", turned_header("2\n2\n") + kCells);
  const std::vector<Vec3> expected = {{100, 201, 3}, {98, 200, 3}, {94, 205, 10}};
  EXPECT_EQ(loaded.cloud.positions, expected);
  EXPECT_EQ(attribute(loaded.cloud, "intensity")->value(0), 0.25);
  EXPECT_EQ(find_attribute(loaded.cloud, "scan"), nullptr);
  EXPECT_TRUE(loaded.cloud.colours.empty());
  ASSERT_EQ(loaded.cloud.scanners.size(), 1u);
  EXPECT_EQ(loaded.cloud.scanners[0], Vec3(100, 200, 3));
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_EQ(loaded.warnings[0], "1 cell at 0 0 0 holds no point: left out");
}

TEST(Ptx, JoinsScansOfOtherFields) {
  const Scratch scratch;
  const std::string coloured =
      "\r\n 2 \r\n2\r\n0 0 0\r\n" + kAxes + kIdentity +
      "1 1 1 .5 1 2 3\r\n2 2 2 .5 4 5 6\r\n3 3 3 .5 7 8 9\r\n4 4 4 1 255 0 0";
  const auto loaded = scratch.read("A.PTX", turned_header("2\n2\n") + kCells + coloured);
  const PointCloud& cloud = loaded.cloud;
  ASSERT_EQ(cloud.size(), 7u);
  EXPECT_EQ(cloud.positions[6], Vec3(4, 4, 4));
  EXPECT_EQ(cloud.colours[2], (Rgb{0, 0, 0}));
  EXPECT_EQ(cloud.colours[6], (Rgb{255, 0, 0}));
  EXPECT_EQ(attribute(cloud, "scan")->value(2), 0.0);
  EXPECT_EQ(attribute(cloud, "scan")->value(3), 1.0);
  EXPECT_EQ(scanner_of_points(cloud)[2], Vec3(100, 200, 3));
  EXPECT_EQ(scanner_of_points(cloud)[3], Vec3(0, 0, 0));
  ASSERT_EQ(loaded.warnings.size(), 2u);
  EXPECT_EQ(loaded.warnings[1], "1 of 2 scans have no colours: their points are black");

  formats::write_cloud(scratch.path("b.ply"), cloud);
  EXPECT_EQ(formats::read_cloud(scratch.path("b.ply")).cloud.scanners, cloud.scanners);
}

TEST(Ptx, KnowsAScannerOnlyWhereTheFileSaysSo) {
  const Scratch scratch;
  const std::string point = "1 2 3 .5\n";
  const auto scanner = [&](const std::string& header) {
    const auto loaded = scratch.read("a.ptx", header + point);
    EXPECT_EQ(loaded.cloud.size(), 1u);
    return loaded.cloud.scanners.at(0);
  };
  EXPECT_TRUE(std::isnan(scanner("1\n1\n0 0 0\n" + kAxes + kIdentity).x()));  // a list of points
  EXPECT_EQ(scanner("1\n1\n4 5 6\n" + kAxes + kIdentity), Vec3(4, 5, 6));
  EXPECT_EQ(scanner(turned_header("1\n1\n")), Vec3(100, 200, 3));
}

TEST(Ptx, ReadsPointsWithoutIntensity) {
  const Scratch scratch;
  const std::string header = "1\n1\n0 0 0\n" + kAxes + kIdentity;
  const auto plain = scratch.read("a.ptx", header + "1 2 3\n" + header + "4 5 6 7 8 9\n");
  EXPECT_EQ(plain.cloud.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(find_attribute(plain.cloud, "intensity"), nullptr);
  EXPECT_EQ(plain.cloud.colours[1], (Rgb{7, 8, 9}));
  EXPECT_TRUE(scratch.read("a.ptx", "0\n0\n0 0 0\n" + kAxes + kIdentity).cloud.empty());
}

TEST(Ptx, NamesTheLineOfAFault) {
  const Scratch scratch;
  const std::string header = "2\n2\n0 0 0\n" + kAxes + kIdentity;
  const auto message = [&](const std::string& text) {
    return error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.ptx", text); });
  };
  const auto expect = [&](const std::string& text, const char* part) {
    EXPECT_NE(message(text).find(part), std::string::npos) << message(text);
  };
  expect(header + "1 2 3 4\n5 6 7 8\n", "declares 2 columns of 2 rows, but ends after 2 points");
  expect(header + "1 2 3 4\n5 6\n", "a.ptx:12: 2 numbers: expected x y z");
  expect(header + "1 2 3 4\n5 6 x 8\n", "a.ptx:12: expected a number, not x");
  expect(header + kCells + "1 2 3 4\n", "a.ptx:15: expected the number of columns of a scan");
  expect("2\n2\n0 0\n", "a.ptx:3: expected the position of the scanner: 3 numbers");
  expect("2\n2\n0 0 nan\n", "a.ptx:3: expected the position of the scanner: 3 numbers");
  expect("2\n2\n0 0 0\n" + kAxes + "1 0 0 0\n", "ends before a row of the matrix");
  expect("1\n1\n0 0 0\n" + kAxes + "1 0 0 0\n2 0 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 4\n",
         "the matrix is singular");
  expect("99999999\n99999999999\n" + header.substr(4), "more than the file holds");
  expect("2\n", "ends before the number of rows");
  expect("\n", "expected the number of columns of a scan");
}

}  // namespace
}  // namespace pcednet::io
