#include "pcednet/io/las/merge.h"

#include <gtest/gtest.h>

#include <fstream>

#include "io/las/las_writer.h"
#include "support/own_folder.h"

namespace pcednet::io {
namespace {

class LasMerge : public testing::Test, protected test::OwnFolder {
 protected:
  LasFile file(LasTestFile content) const {
    const auto path = folder_ / "a.las";
    if (content.format < 6) content.minor = 2;
    std::ofstream(path, std::ios::binary) << las_bytes(content);
    std::vector<std::string> warnings;
    return read_las_file(InputFile(path), warnings);
  }
};

TEST_F(LasMerge, TakesTheFirstFormatThatHasTheFieldsOfAll) {
  const unsigned expected[][3] = {{0, 0, 0}, {0, 1, 1}, {0, 2, 2}, {1, 2, 3}, {3, 0, 3}, {1, 6, 6},
                                  {6, 1, 6}, {3, 6, 7}, {6, 7, 7}, {2, 8, 8}, {8, 7, 8}, {9, 9, 9}};
  for (const auto& [a, b, both] : expected) {
    const std::vector<LasFile> files = {file({.format = a}), file({.format = b})};
    const LasFile merged = merge_las_files(files, 0);
    EXPECT_EQ(merged.point_format(), both) << a << ", " << b;
    EXPECT_EQ(merged.record_length(), las_test_stride(both));
    EXPECT_EQ(merged.minor_version(), both < 6 ? 2u : 4u);
    EXPECT_EQ(merged.header.size(), las_test_header(both < 6 ? 2 : 4));
  }
}

TEST_F(LasMerge, TakesTheExtraBytesOfAll) {
  const std::string a = las_test_extra("Amplitude", 3), b = las_test_extra("Deviation", 9);
  const std::string c = las_test_extra("Height", 10);
  const std::vector<LasFile> files = {file({.extra = 6, .records = {{"LASF_Spec", 4, a + b}}}),
                                      file({.format = 7}),
                                      file({.extra = 12, .records = {{"LASF_Spec", 4, b + c}}})};
  const LasFile merged = merge_las_files(files, 0);
  EXPECT_EQ(merged.record_length(), las_test_stride(7, 14));
  ASSERT_EQ(merged.records.size(), 1u);
  EXPECT_EQ(merged.records[0].data, a + b + c);
  EXPECT_EQ(merge_las_files(std::vector{files[1], files[0]}, 0).records.at(0).data, a + b);
}

TEST_F(LasMerge, TakesTheSystemOfTheFirstThatNamesMost) {
  const std::string plane = R"(PROJCS["UTM",UNIT["metre",1],AUTHORITY["EPSG","25832"]])";
  const std::string both = "COMPD_CS[\"both\"," + plane + R"(,VERT_CS["heights",UNIT["metre",1]]])";
  const LasFile none = file({.records = {{"survey", 1, "kept"}}});
  const LasFile flat = file({.records = {{"LASF_Projection", 2112, plane}}});
  const LasFile full = file({.extended = {{"LASF_Projection", 2112, both}}});
  const LasFile merged = merge_las_files(std::vector{none, flat, full}, 0);
  ASSERT_EQ(merged.records.size(), 2u);
  EXPECT_EQ(merged.records[0].data, "kept");
  EXPECT_EQ(merged.records[1].data, both);
  EXPECT_TRUE(merged.extended_records.empty());
  EXPECT_EQ(merge_las_files(std::vector{none, flat}, 0).records.at(1).data, plane);
  EXPECT_EQ(merge_las_files(std::vector{flat, none}, 0).records.at(0).data, plane);
}

TEST_F(LasMerge, KeepsALongDefinitionInAnExtendedRecord) {
  const std::string wkt =
      "PROJCS[\"" + std::string(70'000, 'x') + R"(",AUTHORITY["EPSG","25832"]])";
  const std::vector<LasFile> files = {file({}),
                                      file({.extended = {{"LASF_Projection", 2112, wkt}}})};
  const LasFile merged = merge_las_files(files, 0);
  EXPECT_TRUE(merged.records.empty());  // these have 16 bits of length
  ASSERT_EQ(merged.extended_records.size(), 1u);
  EXPECT_EQ(merged.extended_records[0].data, wkt);
}

TEST_F(LasMerge, CountsTimesAsTheChosenFile) {
  const auto with = [&](unsigned format, unsigned encoding) {
    LasFile its = file({.format = format});
    put_number(its.header, las_header::kGlobalEncoding, static_cast<std::uint16_t>(encoding));
    return its;
  };
  for (const unsigned first : {1u, 6u}) {
    for (const unsigned adjusted : {0u, 1u}) {
      const std::vector<LasFile> files = {with(first, adjusted), with(6, 17 - adjusted)};
      for (const std::size_t timed : {0u, 1u}) {
        const std::string header = merge_las_files(files, timed).header;
        const auto encoding = number_at<std::uint16_t>(header, las_header::kGlobalEncoding);
        EXPECT_EQ(encoding & 1, timed == 0 ? adjusted : 1 - adjusted);
      }
    }
  }
}

}  // namespace
}  // namespace pcednet::io
