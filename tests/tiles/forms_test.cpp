#include "pcednet/tiles/forms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "io/las/las_writer.h"
#include "pcednet/io/las/file.h"
#include "pcednet/io/las/las.h"
#include "support/own_folder.h"

namespace pcednet::tiles {
namespace {

class Forms : public testing::Test, protected test::OwnFolder {
 protected:
  PointCloud points(unsigned format, std::size_t count) const {
    const auto path = folder_ / "a.las";
    std::ofstream(path, std::ios::binary)
        << io::las_bytes({.format = format,
                          .minor = format < 6 ? 2U : 4U,
                          .rows = io::las_test_rows(format, count)});
    return io::read_las(io::InputFile(path)).cloud;
  }

  PointCloud outline(unsigned format) const { return points(format, 0); }

  PointCloud outline_with_scans() const {
    const auto path = folder_ / "scans.las";
    std::ofstream(path, std::ios::binary) << io::las_bytes(
        {.extra = 4, .records = {{"LASF_Spec", 4, io::las_test_extra("scan", 6)}}});
    return io::read_las(io::InputFile(path)).cloud;
  }
};

const Attribute& column(const PointCloud& cloud, const char* name) {
  const Attribute* found = find_attribute(cloud, name);
  EXPECT_TRUE(found) << name;
  return *found;
}

TEST_F(Forms, GiveAPartTheColumnsOfAll) {
  const PointCloud all = merge_outlines({outline(1), outline(8)}, 0);
  EXPECT_EQ(io::attached_las_file(all).point_format(), 8u);
  const PointCloud before = points(1, 300);
  PointCloud part = before;
  take_columns(all, part);
  ASSERT_EQ(part.attributes.size(), all.attributes.size());
  EXPECT_EQ(part.colours, std::vector<Rgb>(300));
  EXPECT_EQ(column(part, "Infrared").bytes, std::vector<std::byte>(600));
  for (const char* name : {"Intensity", "ReturnNumber", "Classification", "GpsTime"}) {
    EXPECT_EQ(column(part, name).bytes, column(before, name).bytes) << name;
  }
  for (std::size_t i = 0; i < 300; ++i) {
    const double degrees = column(before, "ScanAngleRank").value(i);
    EXPECT_NEAR(0.006 * column(part, "ScanAngle").value(i), degrees, 0.003001);
  }
}

TEST_F(Forms, HaveOneColumnOfScans) {
  PointCloud first = outline(1);
  first.attributes.push_back(make_attribute("scan", std::vector<std::int32_t>{}));
  for (const PointCloud& other : {outline_with_scans(), outline(6)}) {
    const PointCloud all = merge_outlines({first, other}, 0);
    EXPECT_EQ(all.attributes.back().name, "scan");
    EXPECT_EQ(std::ranges::count(all.attributes, "scan", &Attribute::name), 1);
  }
}

TEST_F(Forms, LeaveAPartOfTheirColumnsAsItIs) {
  PointCloud part = points(7, 300);
  const PointCloud before = part;
  take_columns(merge_outlines({outline(1), outline(7)}, 0), part);
  EXPECT_EQ(part.colours, before.colours);
  for (const Attribute& attribute : before.attributes) {
    EXPECT_EQ(column(part, attribute.name.c_str()).bytes, attribute.bytes);
  }
}

}  // namespace
}  // namespace pcednet::tiles
