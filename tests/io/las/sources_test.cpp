#include <gtest/gtest.h>

#include <cmath>

#include "io/las/las_writer.h"
#include "pcednet/formats/write_cloud.h"

namespace pcednet::io {
namespace {

/// The cloud of a text, written as LAS and read again.
struct Round {
  PointCloud cloud = {};
  std::vector<std::string> losses = {};
};

Round through_las(const Scratch& scratch, const PointCloud& cloud) {
  const auto path = scratch.path("out.las");
  Round round{.losses = formats::losses(path, cloud)};
  formats::write_cloud(path, cloud, {.overwrite = Overwrite::kYes});
  round.cloud = formats::read_cloud(path).cloud;
  return round;
}

Round text_through_las(const Scratch& scratch, const std::string& text) {
  return through_las(scratch, scratch.read("in.csv", text).cloud);
}

std::vector<double> values(const PointCloud& cloud, const std::string& name) {
  std::vector<double> numbers;
  const Attribute* attribute = find_attribute(cloud, name);
  for (std::size_t i = 0; attribute && i < cloud.size(); ++i) {
    numbers.push_back(attribute->value(i));
  }
  return numbers;
}

using Values = std::vector<double>;

TEST(LasSources, FillStandardFieldsFromColumnsOfAnyType) {
  const Scratch scratch;
  const auto [cloud, losses] = text_through_las(
      scratch,
      "x,y,z,Intensity,ReturnNumber,NumberOfReturns,Classification,UserData,PointSourceId,"
      "GpsTime,ScanAngleRank,height\n"
      "1,2,3,65535,2,15,255,7,40000,3.5e8,-90,0.5\n4,5,6,0,1,1,2,0,0,-0.25,30,1.5\n");
  EXPECT_EQ(losses, std::vector<std::string>{});
  EXPECT_EQ(values(cloud, "Intensity"), (Values{65535, 0}));
  EXPECT_EQ(values(cloud, "ReturnNumber"), (Values{2, 1}));
  EXPECT_EQ(values(cloud, "NumberOfReturns"), (Values{15, 1}));
  EXPECT_EQ(values(cloud, "Classification"), (Values{255, 2}));
  EXPECT_EQ(values(cloud, "PointSourceId"), (Values{40000, 0}));
  EXPECT_EQ(values(cloud, "GpsTime"), (Values{3.5e8, -0.25}));
  EXPECT_EQ(values(cloud, "ScanAngle"), (Values{-15000, 5000}));  // of 0.006 degrees
  EXPECT_EQ(values(cloud, "height"), (Values{0.5, 1.5}));
  EXPECT_EQ(find_attribute(cloud, "ScanAngleRank"), nullptr);
  EXPECT_EQ(find_attribute(cloud, "Intensity_"), nullptr);
  const std::string bytes = bytes_of(scratch.path("out.las"));
  EXPECT_EQ(get_number<std::uint64_t>(bytes, 255), 1u);  // first returns
  EXPECT_EQ(get_number<std::uint64_t>(bytes, 263), 1u);  // second ones
}

TEST(LasSources, AreNamedAsByCloudCompare) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}, {4, 5, 6}};
  cloud.attributes = {make_attribute("scalar_Intensity", std::vector<float>{17, 900}),
                      make_attribute("scalar_Return_Number", std::vector<float>{1, 2}),
                      make_attribute("scalar_p_sharp", std::vector<float>{0.5F, 1.0F})};
  const auto [back, losses] = through_las(scratch, cloud);
  EXPECT_TRUE(losses.empty());
  EXPECT_EQ(values(back, "Intensity"), (Values{17, 900}));
  EXPECT_EQ(values(back, "ReturnNumber"), (Values{1, 2}));
  EXPECT_EQ(find_attribute(back, "scalar_Intensity"), nullptr);
  EXPECT_EQ(values(back, "scalar_p_sharp"), (Values{0.5, 1}));
}

TEST(LasSources, TakeNamesInOtherCapitals) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
  cloud.attributes = {make_attribute("intensity", std::vector<float>{17, 2047}),
                      make_attribute("CLASSIFICATION", std::vector<std::int64_t>{2, 6})};
  const auto [back, losses] = through_las(scratch, cloud);
  EXPECT_TRUE(losses.empty());
  EXPECT_EQ(values(back, "Intensity"), (Values{17, 2047}));
  EXPECT_EQ(values(back, "Classification"), (Values{2, 6}));
  EXPECT_EQ(find_attribute(back, "intensity"), nullptr);
  // The field's own spelling comes first, and nothing is lost of the other.
  cloud.attributes.push_back(make_attribute("Intensity", std::vector<std::uint16_t>{1, 2}));
  const PointCloud both = through_las(scratch, cloud).cloud;
  EXPECT_EQ(values(both, "Intensity"), (Values{1, 2}));
  EXPECT_EQ(values(both, "intensity"), (Values{17, 2047}));
}

TEST(LasSources, LeaveValuesThatDoNotFitInExtraBytesAndSaySo) {
  const Scratch scratch;
  for (const std::string value : {"0.25", "-2048", "65536", "nan"}) {
    const auto [cloud, losses] =
        text_through_las(scratch, "x,y,z,intensity\n1,2,3,5\n4,5,6," + value + "\n");
    EXPECT_EQ(values(cloud, "Intensity"), (Values{0, 0})) << value;
    EXPECT_EQ(values(cloud, "intensity").at(0), 5) << value;
    ASSERT_EQ(losses.size(), 1u) << value;
    EXPECT_TRUE(contains(losses[0], value + " is not a whole number in 0 ... 65535")) << losses[0];
  }
  PointCloud cloud;  // a type that fits a field of too few bits
  cloud.positions = {Vec3(1, 2, 3)};
  cloud.attributes = {make_attribute("ReturnNumber", std::vector<std::uint8_t>{16})};
  const auto [back, losses] = through_las(scratch, cloud);
  EXPECT_EQ(values(back, "ReturnNumber"), Values{1});
  EXPECT_EQ(values(back, "ReturnNumber_"), Values{16});
  EXPECT_EQ(losses.size(), 1u);
}

/// LAS whose 16-bit colours are not those of 8 bits times 257.
PointCloud wide_colours(const Scratch& scratch) {
  std::string rows = las_test_rows(7, 4);
  const std::size_t stride = rows.size() / 4;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      set_number(rows, i * stride + 30 + 2 * c, static_cast<std::uint16_t>(9000 * i + 129 * c + 3));
    }
  }
  return scratch.read("in.las", las_bytes({7, 4, rows})).cloud;
}

TEST(LasSources, KeepColoursOf16BitsThroughOtherFormats) {
  const Scratch scratch;
  const PointCloud cloud = wide_colours(scratch);
  for (const std::string name : {"a.csv", "a.pcd", "a.ply", "a.txt"}) {
    formats::write_cloud(scratch.path(name), cloud);
    const PointCloud between = formats::read_cloud(scratch.path(name)).cloud;
    EXPECT_EQ(between.colours, cloud.colours) << name;
    const PointCloud back = through_las(scratch, between).cloud;
    for (const std::string channel : {"Red", "Green", "Blue"}) {
      EXPECT_EQ(values(back, channel), values(cloud, channel)) << name;
      EXPECT_EQ(find_attribute(back, channel + "_"), nullptr) << name;
    }
    EXPECT_EQ(back.colours, cloud.colours) << name;
    EXPECT_EQ(find_attribute(back, "rgb"), nullptr) << name;
  }
}

TEST(LasSources, TakeColoursOf16BitsThatStandAlone) {
  const Scratch scratch;
  const PointCloud cloud =
      text_through_las(scratch, "x,y,z,Red,Green,Blue\n1,2,3,65535,300,0\n4,5,6,1,2,3\n").cloud;
  EXPECT_EQ(values(cloud, "Red"), (Values{65535, 1}));
  ASSERT_EQ(cloud.colours.size(), 2u);
  EXPECT_EQ(cloud.colours[0], (Rgb{255, 1, 0}));
}

TEST(LasSources, GiveWayToColoursThatDiffer) {
  const Scratch scratch;
  PointCloud cloud = wide_colours(scratch);
  formats::write_cloud(scratch.path("a.csv"), cloud);
  cloud = formats::read_cloud(scratch.path("a.csv")).cloud;
  cloud.colours[1] = {1, 2, 3};
  const PointCloud back = through_las(scratch, cloud).cloud;
  EXPECT_EQ(back.colours, cloud.colours);
  EXPECT_EQ(values(back, "Red").at(1), 257);
  EXPECT_EQ(find_attribute(back, "Red_"), nullptr);
}

TEST(LasSources, HighBytesAreColoursToo) {
  const Scratch scratch;
  const PointCloud cloud =
      text_through_las(scratch,
                       "x,y,z,red,green,blue,Red,Green,Blue\n1,2,3,0,1,255,129,511,65535\n")
          .cloud;
  EXPECT_EQ(values(cloud, "Red"), Values{129});
  EXPECT_EQ(values(cloud, "Green"), Values{511});
}

TEST(LasSteps, AreTheDecimalsOfTheCoordinates) {
  const Scratch scratch;
  Random random(5);
  for (const double parts : {10.0, 100.0, 1000.0, 10000.0}) {
    const auto decimal = [&](double middle) {
      return std::round((middle + random.uniform(-900, 900)) * parts) / parts;
    };
    PointCloud cloud;
    for (int i = 0; i < 3000; ++i) {
      cloud.positions.emplace_back(decimal(512345), decimal(5812345), decimal(30));
    }
    const auto [back, losses] = through_las(scratch, cloud);
    EXPECT_EQ(losses, std::vector<std::string>{}) << parts;
    EXPECT_EQ(get_number<double>(bytes_of(scratch.path("out.las")), 131), 1e-4) << parts;
  }
}

TEST(LasSteps, BecomeFinerWithTheDigitsAndAreReportedWhereTheyEnd) {
  const Scratch scratch;
  const auto scale_of = [&](const std::string& x, std::size_t lost) {
    const auto [cloud, losses] = text_through_las(scratch, "x,y,z\n512345.67,5,6\n" + x + ",5,6\n");
    EXPECT_EQ(losses.size(), lost) << x;
    return get_number<double>(bytes_of(scratch.path("out.las")), 131);
  };
  EXPECT_EQ(scale_of("512346.67", 0), 1e-4);
  EXPECT_EQ(scale_of("512346.67891", 0), 1e-5);
  EXPECT_EQ(scale_of("512346.678901", 0), 1e-6);
  EXPECT_EQ(scale_of("512346.67890123", 0), 1e-8);
  EXPECT_EQ(scale_of("517346.67890123", 1), 1e-5);  // 32 bits reach 4,295 m in steps of a micron
}

TEST(LasSteps, AreNotAboveOne) {
  const Scratch scratch;
  const auto write = [&](double far) {
    PointCloud cloud;
    cloud.positions = {Vec3(0.25, 0, 0), Vec3(far, 1, 2)};
    formats::write_cloud(scratch.path("out.las"), cloud, {.overwrite = Overwrite::kYes});
  };
  write(4e9);
  EXPECT_EQ(get_number<double>(bytes_of(scratch.path("out.las")), 131), 1.0);
  for (const double far : {5e9, 1e30, -1e300}) {
    const std::string said = error_of(ErrorKind::kInsufficient, [&] { write(far); });
    EXPECT_TRUE(contains(said, "out.las: LAS cannot hold coordinates from ")) << said;
  }
}

TEST(LasColours, ThatOnlyShowTheClassesAreNotMissed) {
  const Scratch scratch;
  PointCloud cloud = scratch.read("in.las", las_bytes({6, 4, las_test_rows(6, 3)})).cloud;
  cloud.attributes.push_back(
      make_attribute("scalar_edge_class", std::vector<std::uint8_t>{0, 2, 2}));
  cloud.colours = {Rgb{255, 255, 255}, Rgb{168, 0, 0}, Rgb{168, 0, 0}};
  EXPECT_TRUE(formats::losses("a.las", cloud).empty());
  cloud.colours[2] = {167, 0, 0};
  ASSERT_EQ(formats::losses("a.las", cloud).size(), 1u);
  EXPECT_TRUE(contains(formats::losses("a.las", cloud)[0], "point format 6 has none"));
}

}  // namespace
}  // namespace pcednet::io
