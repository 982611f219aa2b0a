#include <gtest/gtest.h>

#include <cmath>

#include "io/e57/e57_writer.h"
#include "pcednet/core/random.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/e57/pages.h"

namespace pcednet::io {
namespace {

const std::string kScaled = "type=\"ScaledInteger\" scale=\"0.001\" offset=\"2600000\"";

/// A pose that turns by a quarter about z, then moves.
std::string quarter_turn(const std::string& x, const std::string& y, const std::string& z) {
  return "<pose type=\"Structure\"><rotation><w>0.70710678118654752</w><x/><y/>"
         "<z>0.70710678118654752</z></rotation><translation><x>" +
         x + "</x><y>" + y + "</y><z>" + z + "</z></translation></pose>";
}

E57TestScan two_points(const std::string& xml = "") {
  return {xml,
          {e57_single("cartesianX", {1.5F, 4.25F}), e57_single("cartesianY", {2.0F, -5.0F}),
           e57_single("cartesianZ", {3.0F, 0.1F})},
          2};
}

TEST(E57, ChecksumsByTheKnownValue) {
  const std::string digits = "123456789";
  EXPECT_EQ(crc32c(std::as_bytes(std::span(digits))), 0xE3069283);
}

TEST(E57, ReadsFloatsBitForBit) {
  const Scratch scratch;
  const PointCloud cloud = scratch.read("a.e57", e57_file({two_points()})).cloud;
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.positions[0], Vec3(1.5, 2.0, 3.0));
  EXPECT_EQ(cloud.positions[1], Vec3(4.25, -5.0, 0.1F));
  EXPECT_EQ(cloud.position_type, ScalarType::kFloat32);
  EXPECT_TRUE(scanner_of_points(cloud).empty());
}

TEST(E57, ReadsIntegersOfEveryWidthCutAnywhere) {
  const Scratch scratch;
  Random random(7);
  for (unsigned bits = 0; bits <= 64; ++bits) {
    const std::uint64_t mask = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    const auto least = std::numeric_limits<std::int64_t>::min() + (bits < 64 ? 5 : 0);
    const auto largest = static_cast<std::int64_t>(static_cast<std::uint64_t>(least) + mask);
    std::vector<std::int64_t> values;
    std::vector<double> zeros(200, 0.0);
    for (int i = 0; i < 200; ++i) {
      const std::uint64_t drawn = (std::uint64_t{random.index(1U << 31)} << 33) ^
                                  (std::uint64_t{random.index(1U << 31)} << 16) ^
                                  random.index(1U << 16);
      values.push_back(
          static_cast<std::int64_t>(static_cast<std::uint64_t>(least) + (drawn & mask)));
    }
    const E57TestScan scan{
        "",
        {e57_double("cartesianX", zeros), e57_integer("code", least, largest, values),
         e57_double("cartesianY", zeros), e57_double("cartesianZ", zeros)},
        200};
    const PointCloud cloud = scratch.read("a.e57", e57_file({scan}, 5)).cloud;
    const Attribute* code = find_attribute(cloud, "code");
    ASSERT_NE(code, nullptr);
    ASSERT_EQ(code->type, ScalarType::kInt64);
    EXPECT_EQ(code->bytes, make_attribute("code", values).bytes) << bits << " bits";
  }
}

TEST(E57, ScalesIntegersAsTheStandardSays) {
  const Scratch scratch;
  const E57TestScan scan{
      "",
      {e57_integer("cartesianX", -500000000, 500000000, {123456789, -1}, kScaled),
       e57_integer("cartesianY", 0, 0, {0, 0}, kScaled),
       e57_integer("cartesianZ", 7, 8, {7, 8}, kScaled)},
      2};
  const PointCloud cloud = scratch.read("a.e57", e57_file({scan})).cloud;
  EXPECT_EQ(cloud.positions[0], Vec3(123456789 * 0.001 + 2600000, 2600000, 7 * 0.001 + 2600000));
  EXPECT_EQ(cloud.positions[1].x(), -1 * 0.001 + 2600000);
  EXPECT_EQ(cloud.position_type, ScalarType::kFloat64);
}

TEST(E57, MovesEveryScanByItsPose) {
  const Scratch scratch;
  const PointCloud cloud =
      scratch
          .read("a.e57", e57_file({two_points(quarter_turn("2600000.5", "1200000.25", "400")),
                                   two_points("<name>hall</name>")}))
          .cloud;
  ASSERT_EQ(cloud.size(), 4u);
  EXPECT_LT((cloud.positions[0] - Vec3(2600000.5 - 2.0, 1200000.25 + 1.5, 403.0)).norm(), 1e-9);
  EXPECT_EQ(cloud.positions[2], Vec3(1.5, 2.0, 3.0));
  const Attribute* scan = find_attribute(cloud, "scan");
  ASSERT_NE(scan, nullptr);
  EXPECT_EQ(scan->value(1), 0.0);
  EXPECT_EQ(scan->value(2), 1.0);
  ASSERT_EQ(cloud.scanners.size(), 2u);
  EXPECT_EQ(cloud.scanners[0], Vec3(2600000.5, 1200000.25, 400.0));
  EXPECT_FALSE(cloud.scanners[1].allFinite());  // no pose, no rows: perhaps no scan at all
}

TEST(E57, KeepsTheScannersInAnotherFormat) {
  const Scratch scratch;
  const PointCloud cloud =
      scratch.read("a.e57", e57_file({two_points(quarter_turn("1", "2", "0.1"))})).cloud;
  formats::write_cloud(scratch.path("a.ply"), cloud);
  const PointCloud again = formats::read_cloud(scratch.path("a.ply")).cloud;
  ASSERT_EQ(again.scanners.size(), 1u);
  EXPECT_EQ(again.scanners[0], Vec3(1, 2, 0.1));
  EXPECT_EQ(scanner_of_points(again).size(), 2u);
}

TEST(E57, ReadsSphericalPointsAndLeavesOutInvalidOnes) {
  const Scratch scratch;
  const E57TestScan scan{"",
                         {e57_double("sphericalRange", {2.0, 3.0, 4.0}),
                          e57_double("sphericalAzimuth", {M_PI / 2, 0.0, 0.0}),
                          e57_double("sphericalElevation", {0.0, 0.0, M_PI / 2}),
                          e57_integer("sphericalInvalidState", 0, 2, {0, 2, 0}),
                          e57_integer("rowIndex", 0, 99, {5, 6, 7})},
                         3};
  const LoadedCloud loaded = scratch.read("a.e57", e57_file({scan}));
  ASSERT_EQ(loaded.cloud.size(), 2u);
  EXPECT_LT((loaded.cloud.positions[0] - Vec3(0, 2, 0)).norm(), 1e-15);
  EXPECT_LT((loaded.cloud.positions[1] - Vec3(0, 0, 4)).norm(), 1e-15);
  EXPECT_EQ(find_attribute(loaded.cloud, "rowIndex")->value(1), 7.0);
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_TRUE(contains(loaded.warnings[0], "1 points are marked invalid"));
  EXPECT_EQ(scanner_of_points(loaded.cloud)[1], Vec3(0, 0, 0));
}

TEST(E57, ReadsNormalsColoursAndIntensity) {
  const Scratch scratch;
  E57TestScan scan = two_points(
      quarter_turn("0", "0", "0") +
      "<colorLimits><colorRedMinimum/><colorRedMaximum>65535</colorRedMaximum></colorLimits>");
  scan.fields.push_back(e57_single("nor:normalX", {2.0F, 0.0F}));
  scan.fields.push_back(e57_single("nor:normalY", {0.0F, 0.0F}));
  scan.fields.push_back(e57_single("nor:normalZ", {0.0F, -1.0F}));
  scan.fields.push_back(e57_integer("colorRed", 0, 65535, {65535, 32896}));
  scan.fields.push_back(e57_integer("colorGreen", 0, 255, {7, 8}));
  scan.fields.push_back(e57_integer("colorBlue", 0, 255, {0, 255}));
  scan.fields.push_back(e57_single("intensity", {0.25F, 0.5F}));
  scan.fields.push_back(e57_integer("isIntensityInvalid", 0, 1, {0, 0}));
  const PointCloud cloud = scratch.read("a.e57", e57_file({scan})).cloud;
  EXPECT_LT((cloud.normals[0] - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((cloud.normals[1] - Vec3(0, 0, -1)).norm(), 1e-15);
  EXPECT_EQ(cloud.colours[0], (Rgb{255, 7, 0}));
  EXPECT_EQ(cloud.colours[1], (Rgb{128, 8, 255}));
  ASSERT_EQ(cloud.attributes.size(), 1u);
  EXPECT_EQ(cloud.attributes[0].type, ScalarType::kFloat32);
  EXPECT_EQ(cloud.attributes[0].value(1), 0.5);
}

TEST(E57, FillsFieldsThatAScanLacks) {
  const Scratch scratch;
  E57TestScan rich = two_points();
  rich.fields.push_back(e57_integer("returnCount", 0, 7, {3, 4}));
  const PointCloud cloud = scratch.read("a.e57", e57_file({two_points(), rich})).cloud;
  const Attribute* count = find_attribute(cloud, "returnCount");
  ASSERT_NE(count, nullptr);
  EXPECT_TRUE(std::isnan(count->value(0)));
  EXPECT_EQ(count->value(3), 4.0);
}

TEST(E57, ReadsPastStrings) {
  const Scratch scratch;
  E57TestScan first = two_points(), second = two_points();
  first.fields.push_back(e57_integer("returnCount", 0, 7, {3, 4}));
  second.fields.push_back({"<returnCount type=\"String\"/>", 8, {'a', 'b'}});
  second.fields.push_back({"<cartesianInvalidState type=\"String\"/>", 8, {'a', 'b'}});
  const PointCloud cloud = scratch.read("a.e57", e57_file({first, second})).cloud;
  ASSERT_EQ(cloud.size(), 4u);
  EXPECT_EQ(find_attribute(cloud, "returnCount")->value(1), 4.0);
  EXPECT_TRUE(std::isnan(find_attribute(cloud, "returnCount")->value(2)));
  for (E57TestField& field : second.fields)
    field.xml = "<" + field.xml.substr(1, 10) + " type=\"String\"/>";
  second.fields.resize(3);
  EXPECT_TRUE(contains(
      error_of(ErrorKind::kInsufficient, [&] { scratch.read("a.e57", e57_file({second})); }),
      "points need x, y and z"));
}

TEST(E57, NamesThePageWithAWrongChecksum) {
  const Scratch scratch;
  E57TestScan scan{"", {}, 500};
  for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"}) {
    scan.fields.push_back(e57_double(name, std::vector<double>(500, 1.0)));
  }
  std::string bytes = e57_file({scan}, 3000);
  bytes[3 * 1024 + 500] ^= 1;
  EXPECT_TRUE(
      contains(error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.e57", bytes); }), "page 3"));
}

TEST(E57, RefusesMorePointsThanTheFileHasRoomFor) {
  const Scratch scratch;
  E57TestScan scan = two_points();
  scan.points = 3;
  const auto read = [&] { scratch.read("a.e57", e57_file({scan})); };
  EXPECT_TRUE(contains(error_of(ErrorKind::kUnreadable, read), "after 2 of 3 points"));
  scan.points = std::size_t{1} << 40;
  EXPECT_TRUE(contains(error_of(ErrorKind::kUnreadable, read), "more than the file can hold"));
  for (E57TestField& field : scan.fields) field = e57_integer(field.xml.substr(1, 10), 1, 1, {});
  EXPECT_TRUE(contains(error_of(ErrorKind::kUnreadable, read), "more than the file can hold"));
}

TEST(E57, RefusesIntegersAboveTheirMaximum) {
  const Scratch scratch;
  E57TestScan scan = two_points();
  scan.fields.push_back(e57_integer("returnCount", 0, 4, {3, 5}));
  EXPECT_TRUE(contains(
      error_of(ErrorKind::kUnreadable, [&] { scratch.read("a", e57_file({scan})); }), "maximum"));
}

TEST(E57, NeedsCoordinates) {
  const Scratch scratch;
  E57TestScan scan = two_points();
  scan.fields.pop_back();
  EXPECT_TRUE(
      contains(error_of(ErrorKind::kInsufficient, [&] { scratch.read("a.e57", e57_file({scan})); }),
               "cartesianX cartesianY"));
}

}  // namespace
}  // namespace pcednet::io
