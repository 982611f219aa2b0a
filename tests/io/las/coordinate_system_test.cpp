#include <gtest/gtest.h>

#include "io/las/las_writer.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/projection.h"

namespace pcednet::io {
namespace {

PointCloud cloud_with(const Scratch& scratch, const std::vector<LasTestRecord>& records) {
  LasTestFile file{.rows = las_test_rows(6, 3)};
  file.records = records;
  return scratch.read("a.las", las_bytes(file)).cloud;
}

constexpr const char* kWkt = R"(PROJCS["x",UNIT["metre",1],AUTHORITY["EPSG","25833"]])";

std::string keys(std::initializer_list<std::uint16_t> numbers) {
  std::string bytes;
  for (const std::uint16_t number : numbers) bytes += packed(number);
  return bytes;
}

TEST(LasCoordinateSystem, IsThatOfTheWktOrOfTheKeys) {
  const Scratch scratch;
  EXPECT_EQ(las_coordinate_system(PointCloud{}).epsg, 0);
  EXPECT_EQ(las_coordinate_system(cloud_with(scratch, {})).epsg, 0);
  const LasTestRecord geo_keys{
      "LASF_Projection", 34735,
      keys({1, 1, 0, 4, 1024, 0, 1, 1, 2048, 0, 1, 4258, 3072, 0, 1, 25832, 3076, 0, 1, 9001})};
  const auto of_keys = las_coordinate_system(cloud_with(scratch, {geo_keys}));
  EXPECT_EQ(of_keys.epsg, 25832);
  EXPECT_EQ(of_keys.unit, LengthUnit::kMetre);
  EXPECT_EQ(of_keys.wkt, "");
  const LasTestRecord wkt{"LASF_Projection", 2112, std::string(kWkt) + '\0'};
  const PointCloud cloud = cloud_with(scratch, {geo_keys, wkt});
  EXPECT_EQ(las_coordinate_system(cloud).epsg, 25833);
  EXPECT_EQ(las_coordinate_system(cloud).wkt, kWkt);
  formats::write_cloud(scratch.path("a.ply"), cloud);
  const PointCloud ply = formats::read_cloud(scratch.path("a.ply")).cloud;
  EXPECT_EQ(las_coordinate_system(ply).wkt, kWkt);
}

TEST(LasCoordinateSystem, WithoutACodeGetsThatOfProj) {
  const Scratch scratch;
  const std::string esri =
      "PROJCS[\"ETRS_1989_UTM_Zone_32N\",GEOGCS[\"GCS_ETRS_1989\",DATUM[\"D_ETRS_1989\","
      "SPHEROID[\"GRS_1980\",6378137.0,298.257222101]],PRIMEM[\"Greenwich\",0.0],"
      "UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],"
      "PARAMETER[\"False_Easting\",500000.0],PARAMETER[\"False_Northing\",0.0],"
      "PARAMETER[\"Central_Meridian\",9.0],PARAMETER[\"Scale_Factor\",0.9996],"
      "PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]]";
  const std::string heights =
      "VERTCS[\"DHHN2016_(height)\",VDATUM[\"Deutsches_Haupthoehennetz_2016\"],"
      "PARAMETER[\"Vertical_Shift\",0.0],PARAMETER[\"Direction\",1.0],UNIT[\"Meter\",1.0]]";
  const auto system_of = [&](const std::string& wkt) {
    return las_coordinate_system(
        cloud_with(scratch, {{"LASF_Projection", 2112, wkt + std::string(1, '\0')}}));
  };
  for (const std::string& wkt : {esri, esri + "," + heights}) {
    EXPECT_EQ(system_of(wkt).epsg, has_projections() ? 25832 : 0);
    EXPECT_EQ(system_of(wkt).unit, LengthUnit::kMetre);
    EXPECT_EQ(system_of(wkt).wkt, wkt);
  }
  std::string local = esri;  // of a project of one's own
  local.replace(local.find("9.0]"), 4, "9.1]");
  for (const std::string& wkt : {local, heights, std::string("PROJCS[\"a"), std::string("what")}) {
    EXPECT_EQ(system_of(wkt).epsg, 0) << wkt;
  }
}

TEST(LasCoordinateSystem, OfTheCommentsOfE57IsWritten) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}, {4, 5, 6}};
  cloud.comments = {std::string("coordinate system: ") + kWkt, "scan 0: a"};
  EXPECT_EQ(las_coordinate_system(cloud).epsg, 25833);
  for (const char* name : {"a.las", "a.laz", "a.copc.laz"}) {
    formats::write_cloud(scratch.path(name), cloud);
    const PointCloud read = formats::read_cloud(scratch.path(name)).cloud;
    EXPECT_EQ(las_coordinate_system(read).wkt, kWkt) << name;
    EXPECT_EQ(read.comments, cloud.comments);
  }
  cloud.comments[0] = "coordinate system: local";
  formats::write_cloud(scratch.path("b.las"), cloud);
  EXPECT_EQ(las_coordinate_system(formats::read_cloud(scratch.path("b.las")).cloud).wkt, "");
}

TEST(LasCoordinateSystem, IsReportedWhereAFormatLosesIt) {
  const Scratch scratch;
  using Strings = std::vector<std::string>;
  const auto losses = [&](const std::vector<LasTestRecord>& records, const char* output) {
    PointCloud cloud = cloud_with(scratch, records);
    cloud.attributes.clear();
    cloud.foreign_elements.push_back({"element face 0\nproperty uchar a\n", {}});
    return formats::losses(output, cloud);
  };
  const auto record_of = [](unsigned id, const std::string& data) {
    return LasTestRecord{"LASF_Projection", id, data};
  };
  const std::string rest = "header and records of LAS", face = "element face 0";
  const LasTestRecord wkt = record_of(2112, std::string(kWkt) + '\0');
  for (const char* output : {"a.pcd", "a.obj", "a.xyz", "a.csv"}) {
    EXPECT_EQ(losses({}, output), (Strings{rest, face})) << output;
    EXPECT_EQ(losses({wkt}, output), (Strings{"coordinate system EPSG:25833", rest, face}));
  }
  const auto with_heights =
      record_of(34735, keys({1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, 25832, 4096, 0, 1, 7837}));
  EXPECT_EQ(losses({with_heights}, "a.csv")[0], "coordinate system EPSG:25832+7837");
  const LasTestRecord own = record_of(2112, R"(PROJCS["ours",UNIT["metre",1]])");
  EXPECT_EQ(losses({own}, "a.csv")[0], "coordinate system");
  const auto user_defined = record_of(34735, keys({1, 1, 0, 1, 3072, 0, 1, 32767, 1024, 0, 1, 1}));
  EXPECT_EQ(losses({user_defined}, "a.csv")[0], "coordinate system");
  EXPECT_EQ(losses({record_of(34735, keys({1, 1, 0, 0}))}, "a.csv")[0], rest);
  EXPECT_EQ(losses({wkt}, "a.laz"), Strings{face});
  EXPECT_EQ(losses({wkt}, "a.ply"), Strings{});
}

TEST(LasCoordinateSystem, HasTheUnitOfItsKeysIfHeightsHaveItToo) {
  const Scratch scratch;
  const auto unit_of_keys = [&](std::uint16_t plan, std::uint16_t heights) {
    const std::string data = keys({1, 1, 0, 2, 3076, 0, 1, plan, 4099, 0, 1, heights});
    return las_coordinate_system(cloud_with(scratch, {{"LASF_Projection", 34735, data}})).unit;
  };
  EXPECT_EQ(unit_of_keys(9002, 9002), LengthUnit::kFoot);
  EXPECT_EQ(unit_of_keys(9003, 9003), LengthUnit::kUsSurveyFoot);
  EXPECT_EQ(unit_of_keys(9003, 9001), LengthUnit::kNone);
  EXPECT_EQ(unit_of_keys(9035, 9035), LengthUnit::kNone);
}

// What must hold with PROJ, and what without.
TEST(LasCoordinateSystem, HasTheUnitOfItsCodesWhereTheKeysStateNone) {
  const Scratch scratch;
  const auto unit_of_keys = [&](const std::string& data) {
    return las_coordinate_system(cloud_with(scratch, {{"LASF_Projection", 34735, data}})).unit;
  };
  const auto if_known = [](LengthUnit unit) {
    return has_projections() ? unit : LengthUnit::kNone;
  };
  EXPECT_EQ(unit_of_keys(keys({1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 25832})),
            if_known(LengthUnit::kMetre));
  EXPECT_EQ(unit_of_keys(keys({1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 2263})),
            if_known(LengthUnit::kUsSurveyFoot));
  EXPECT_EQ(unit_of_keys(keys({1, 1, 0, 2, 3072, 0, 1, 2263, 4099, 0, 1, 9001})),
            LengthUnit::kNone);
  EXPECT_EQ(unit_of_keys(keys({1, 1, 0, 2, 3072, 0, 1, 25832, 4099, 0, 1, 9001})),
            if_known(LengthUnit::kMetre));
  EXPECT_EQ(unit_of_keys(keys({1, 1, 0, 2, 3072, 0, 1, 25832, 4096, 0, 1, 7837})),
            if_known(LengthUnit::kMetre));
  EXPECT_EQ(unit_of_keys(keys({1, 1, 0, 2, 1024, 0, 1, 2, 2048, 0, 1, 4326})), LengthUnit::kNone);
}

TEST(LasCoordinateSystem, OfOnesOwnIsNotThatOfItsAngles) {
  const Scratch scratch;
  const std::string data = keys({1, 1, 0, 3, 1024, 0, 1, 1, 2048, 0, 1, 4258, 3072, 0, 1, 32767});
  EXPECT_EQ(las_coordinate_system(cloud_with(scratch, {{"LASF_Projection", 34735, data}})).epsg, 0);
}

TEST(LasCoordinateSystem, InDegreesIsAWarning) {
  const Scratch scratch;
  const auto warnings_with = [&](const LasTestRecord& record) {
    LasTestFile file{.rows = las_test_rows(6, 3)};
    file.records = {record};
    return scratch.read("a.las", las_bytes(file)).warnings;
  };
  const auto of_keys = [&](const std::string& data) {
    return warnings_with({"LASF_Projection", 34735, data});
  };
  const std::string geographic = R"(GEOGCS["WGS 84",UNIT["degree",0.0174532925199433]])";
  for (const auto& warnings : {of_keys(keys({1, 1, 0, 2, 1024, 0, 1, 2, 2048, 0, 1, 4326})),
                               of_keys(keys({1, 1, 0, 1, 2048, 0, 1, 4326})),
                               warnings_with({"LASF_Projection", 2112, geographic})}) {
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(contains(warnings[0], "coordinates are in degrees"));
  }
  EXPECT_TRUE(of_keys(keys({1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 25832})).empty());
  EXPECT_TRUE(of_keys(keys({1, 1, 0, 2, 1024, 0, 1, 3, 2048, 0, 1, 4978})).empty());
  EXPECT_TRUE(warnings_with({"LASF_Projection", 2112, kWkt}).empty());
}

TEST(LasCoordinateSystem, WithHeightsInAnotherUnitIsAWarning) {
  const Scratch scratch;
  const auto warned = [&](unsigned id, const std::string& data) {
    LasTestFile file{.rows = las_test_rows(6, 3)};
    file.records = {{"LASF_Projection", id, data}};
    const auto warnings = scratch.read("a.las", las_bytes(file)).warnings;
    return warnings.size() == 1 && contains(warnings[0], "heights have another unit than x and y");
  };
  const auto of_wkt = [&](const std::string& plane, const std::string& heights) {
    const std::string system = R"(PROJCS["plane",GEOGCS["g",UNIT["degree",0.0174]],UNIT[)" + plane;
    const std::string up = R"(["heights",UNIT[)" + heights + "]]";
    EXPECT_EQ(warned(2112, "COMPD_CS[\"both\"," + system + "]],VERT_CS" + up + "]"),
              warned(2112, system + "]],VERTCS" + up));  // as ESRI has it
    return warned(2112, "COMPD_CS[\"both\"," + system + "]],VERT_CS" + up + "]");
  };
  const std::string metre = R"("metre",1)", survey = R"("US survey foot",0.304800609601219)";
  EXPECT_TRUE(of_wkt(survey, metre));
  EXPECT_TRUE(of_wkt(metre, survey));
  EXPECT_FALSE(of_wkt(metre, metre));
  EXPECT_FALSE(of_wkt(survey, R"("foot",0.3048)"));
  EXPECT_FALSE(of_wkt(survey, R"("unknown",0)"));
  const auto of_keys = [&](unsigned plane, unsigned heights) {
    return warned(34735,
                  keys({1, 1, 0, 3, 3072, 0, 1, 2263, 3076, 0, 1, static_cast<std::uint16_t>(plane),
                        4099, 0, 1, static_cast<std::uint16_t>(heights)}));
  };
  EXPECT_TRUE(of_keys(9003, 9001));
  EXPECT_FALSE(of_keys(9003, 9003));
  EXPECT_FALSE(of_keys(9003, 9002));
  EXPECT_FALSE(of_keys(9003, 1234));
}

TEST(LasCoordinateSystem, SurvivesBrokenKeys) {
  const Scratch scratch;
  for (const auto& data :
       {keys({}), keys({1, 1, 0, 9}), keys({1, 1, 0, 1, 3072, 0, 1}),
        keys({1, 1, 0, 1, 3072, 34737, 1, 25832}), keys({1, 1, 0, 1, 3072, 0, 1, 32767})}) {
    const auto system =
        las_coordinate_system(cloud_with(scratch, {{"LASF_Projection", 34735, data}}));
    EXPECT_EQ(system.epsg, 0);
    EXPECT_EQ(system.unit, LengthUnit::kNone);
  }
}

}  // namespace
}  // namespace pcednet::io
