#include "pcednet/formats/virtual_cloud.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/las/las_writer.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/projection.h"

namespace pcednet::formats {
namespace {

using io::Scratch;
using nlohmann::json;

constexpr const char* kUtm =
    R"(PROJCS["ETRS89 / UTM zone 32N",GEOGCS["ETRS89",)"
    R"(DATUM["European_Terrestrial_Reference_System_1989",)"
    R"(SPHEROID["GRS 1980",6378137,298.257222101]],PRIMEM["Greenwich",0],)"
    R"(UNIT["degree",0.0174532925199433]],)"
    R"(PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],)"
    R"(PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],)"
    R"(PARAMETER["false_easting",500000],PARAMETER["false_northing",0],)"
    R"(UNIT["metre",1],AUTHORITY["EPSG","25832"]])";

std::filesystem::path write_las(const Scratch& scratch, const std::string& name,
                                const std::string& wkt, std::size_t points = 100,
                                unsigned format = 7) {
  io::LasTestFile file{format, 4, io::las_test_rows(format, points)};
  file.offset = {500000.0, 5538630.0, 100.0};
  if (!wkt.empty()) file.records = {{"LASF_Projection", 2112, wkt + '\0'}};
  return scratch.file(name, io::las_bytes(file));
}

/// The written collection, and what was remarked.
struct Written {
  json collection;
  std::vector<std::string> remarks;
};

Written write(const Scratch& scratch, const std::vector<std::filesystem::path>& paths) {
  std::vector<VirtualFile> files;
  for (const auto& path : paths) files.push_back(virtual_file(path));
  auto remarks = write_virtual_cloud(scratch.path("out/all.vpc"), files, Overwrite::kYes);
  return {json::parse(io::bytes_of(scratch.path("out/all.vpc"))), std::move(remarks)};
}

class VirtualCloud : public ::testing::Test {
 protected:
  VirtualCloud() { std::filesystem::create_directories(scratch.path("out")); }
  Scratch scratch;
};

TEST_F(VirtualCloud, HasAnItemForEachFileWithWhatItsHeaderSays) {
  const auto las = write_las(scratch, "out/tiles/a.las", "");
  formats::write_cloud(scratch.path("b.copc.laz"), formats::read_cloud(las).cloud);
  const auto [collection, remarks] = write(scratch, {las, scratch.path("b.copc.laz")});
  EXPECT_EQ(collection["type"], "FeatureCollection");
  ASSERT_EQ(collection["features"].size(), 2U);
  const json& first = collection["features"][0];
  EXPECT_EQ(first["type"], "Feature");
  EXPECT_EQ(first["stac_version"], "1.0.0");
  EXPECT_EQ(first["id"], "a");
  EXPECT_EQ(first["assets"]["data"]["href"], "./tiles/a.las");
  EXPECT_EQ(first["assets"]["data"]["roles"], json::array({"data"}));
  const json& properties = first["properties"];
  EXPECT_EQ(properties["datetime"], "2020-04-09T00:00:00Z");  // day 100
  EXPECT_EQ(properties["pc:count"], 100);
  EXPECT_EQ(properties["pc:type"], "lidar");
  EXPECT_EQ(properties["pc:encoding"], "las");
  const VirtualFile facts = virtual_file(las);
  const Vec3 least = facts.bounds.min, most = facts.bounds.max;
  EXPECT_EQ(properties["proj:bbox"],
            json({least.x(), least.y(), least.z(), most.x(), most.y(), most.z()}));
  EXPECT_EQ(properties["pc:schemas"][0], json({{"name", "X"}, {"size", 8}, {"type", "floating"}}));
  EXPECT_EQ(properties["pc:schemas"].back(),
            json({{"name", "Blue"}, {"size", 2}, {"type", "unsigned"}}));
  const json& second = collection["features"][1];
  EXPECT_EQ(second["assets"]["data"]["href"], "./../b.copc.laz");
  EXPECT_EQ(second["properties"]["pc:encoding"], "copc");
  EXPECT_TRUE(remarks.empty());
}

TEST_F(VirtualCloud, HasOutlinesInFileCoordinatesWhereNoSystemIsKnown) {
  const auto [collection, remarks] = write(scratch, {write_las(scratch, "a.las", "")});
  const json& item = collection["features"][0];
  EXPECT_EQ(item["properties"]["proj:wkt2"], "");
  EXPECT_EQ(item["geometry"], item["properties"]["proj:geometry"]);
  EXPECT_EQ(item["bbox"], item["properties"]["proj:bbox"]);
  EXPECT_EQ(item["geometry"]["type"], "Polygon");
  ASSERT_EQ(item["geometry"]["coordinates"][0].size(), 5U);
  EXPECT_EQ(item["geometry"]["coordinates"][0][0], item["geometry"]["coordinates"][0][4]);
}

TEST_F(VirtualCloud, HasOutlinesInDegreesWhereProjKnowsTheSystem) {
  const auto [collection, remarks] = write(scratch, {write_las(scratch, "a.las", kUtm)});
  const json& item = collection["features"][0];
  const std::string definition = item["properties"]["proj:wkt2"];
  if (!io::has_projections()) {
    EXPECT_EQ(definition, "");
    EXPECT_EQ(item["bbox"], item["properties"]["proj:bbox"]);
    ASSERT_EQ(remarks.size(), 1U);
    EXPECT_TRUE(io::contains(remarks[0], "without PROJ"));
    return;
  }
  EXPECT_TRUE(remarks.empty());
  EXPECT_TRUE(definition.starts_with("PROJCRS[\"ETRS89 / UTM zone 32N\"")) << definition;
  const VirtualFile facts = virtual_file(scratch.path("a.las"));
  EXPECT_NEAR(item["bbox"][0], 9.0, 1e-5);
  EXPECT_NEAR(item["bbox"][2], facts.bounds.min.z(), 0.0);
  EXPECT_EQ(item["properties"]["proj:bbox"][0], facts.bounds.min.x());
  for (const json& corner : item["geometry"]["coordinates"][0]) {
    EXPECT_GE(corner[0], item["bbox"][0]);
    EXPECT_LE(corner[1], item["bbox"][4]);
  }
}

TEST_F(VirtualCloud, WarnsOfSeveralSystemsAndOfOneThatIsUnknown) {
  if (io::has_projections()) {
    const auto mixed =
        write(scratch, {write_las(scratch, "a.las", kUtm), write_las(scratch, "b.las", "")});
    ASSERT_EQ(mixed.remarks.size(), 2U);
    EXPECT_TRUE(io::contains(mixed.remarks[0], "not all of one coordinate system"));
    EXPECT_EQ(mixed.remarks[1],
              "1 of 2 files name no coordinate system, such as " + scratch.path("b.las").string());
  }
  // The definitions of one code may differ in their words.
  std::string other = kUtm;
  other.replace(other.find("ETRS89 /"), 8, "Europe,");
  const auto one =
      write(scratch, {write_las(scratch, "a.las", kUtm), write_las(scratch, "b.las", other)});
  EXPECT_EQ(one.remarks.size(), io::has_projections() ? 0U : 1U);
  const auto unknown = write(scratch, {write_las(scratch, "a.las", "PROJCS[\"x\"]")});
  ASSERT_EQ(unknown.remarks.size(), 1U);
  EXPECT_TRUE(io::contains(unknown.remarks[0], "left out"));
}

TEST_F(VirtualCloud, LeavesOutFilesWithoutPointsAndNamesNoItemTwice) {
  const auto [collection, remarks] =
      write(scratch, {write_las(scratch, "x/a.las", ""), write_las(scratch, "y/a.las", ""),
                      write_las(scratch, "none.las", "", 0)});
  ASSERT_EQ(collection["features"].size(), 2U);
  EXPECT_EQ(collection["features"][1]["id"], "a-2");
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0], "1 of 3 files have no points");
}

TEST_F(VirtualCloud, IsRefusedForOtherFormatsForNoPointsAndForBoundsThatAreNotNumbers) {
  const auto text = scratch.file("a.xyz", "0 0 0\n");
  EXPECT_TRUE(io::contains(io::error_of(ErrorKind::kInsufficient, [&] { virtual_file(text); }),
                           "LAS, LAZ and COPC"));
  const std::vector<VirtualFile> none = {virtual_file(write_las(scratch, "none.las", "", 0))};
  io::error_of(ErrorKind::kInsufficient,
               [&] { write_virtual_cloud(scratch.path("out/all.vpc"), none); });
  EXPECT_FALSE(std::filesystem::exists(scratch.path("out/all.vpc")));
  std::string bytes = io::bytes_of(write_las(scratch, "a.las", ""));
  io::set_number(bytes, 179, std::numeric_limits<double>::quiet_NaN());
  const auto odd = scratch.file("odd.las", bytes);
  EXPECT_TRUE(io::contains(io::error_of(ErrorKind::kUnreadable, [&] { virtual_file(odd); }),
                           "odd.las: byte 179"));
}

TEST_F(VirtualCloud, NamesItsFilesToWhoReadsIt) {
  const auto a = write_las(scratch, "out/tiles/a b.las", ""), b = write_las(scratch, "b.las", "");
  write(scratch, {a, b});
  const auto all = scratch.path("out/all.vpc");
  ASSERT_TRUE(is_virtual_cloud(all));
  EXPECT_EQ(files_of_virtual_cloud(all),
            (std::vector<std::filesystem::path>{a.lexically_normal(), b.lexically_normal()}));
  // Of other programs: absolute, as a URL, beside data of other roles, without roles.
  const auto listed = [&](const json& assets) {
    const json whole = {{"type", "FeatureCollection"},
                        {"features", json::array({{{"assets", assets}}})}};
    return files_of_virtual_cloud(scratch.file("out/b.vpc", whole.dump()));
  };
  const auto found = std::vector<std::filesystem::path>{b};
  EXPECT_EQ(listed({{"data", {{"href", b.string()}}}}), found);
  EXPECT_EQ(listed({{"points", {{"href", "file://" + b.string()}, {"roles", {"data"}}}},
                    {"overview", {{"href", "c.laz"}, {"roles", {"overview"}}}}}),
            found);
  // Names encoded as in a URL; a file that has the very name comes first.
  const std::vector<std::filesystem::path> spaced = {a.lexically_normal()};
  EXPECT_EQ(listed({{"data", {{"href", "./tiles/a%20b.las"}}}}), spaced);
  EXPECT_EQ(
      listed({{"data", {{"href", "file://" + scratch.path("out/tiles/a%20b.las").string()}}}}),
      spaced);
  const auto literal = write_las(scratch, "out/tiles/a%20b.las", "").lexically_normal();
  EXPECT_EQ(listed({{"data", {{"href", "./tiles/a%20b.las"}}}}),
            std::vector<std::filesystem::path>{literal});
}

TEST_F(VirtualCloud, IsRefusedWhereItNamesNoFileThatIsThere) {
  const auto refusal = [&](ErrorKind kind, const std::string& text) {
    const auto path = scratch.file("a.vpc", text);
    return io::error_of(kind, [&] { files_of_virtual_cloud(path); });
  };
  const auto naming = [](const std::string& file) {
    return json{{"features", json::array({{{"assets", {{"data", {{"href", file}}}}}}})}}.dump();
  };
  for (const char* text : {"", "{", "[]", "{\"features\": 7}", "LASF"}) {
    EXPECT_TRUE(io::contains(refusal(ErrorKind::kUnreadable, text), "not a virtual point cloud"));
  }
  EXPECT_TRUE(
      io::contains(refusal(ErrorKind::kUnreadable, naming("./none.laz")), "does not exist"));
  EXPECT_TRUE(
      io::contains(refusal(ErrorKind::kUnreadable, naming("https://a.b/c.copc.laz")), "is remote"));
  for (const char* text : {"{\"features\": []}", "{\"features\": [7, {}, {\"assets\": 3}]}"}) {
    EXPECT_TRUE(io::contains(refusal(ErrorKind::kInsufficient, text), "names no point files"));
  }
}

// The day that STAC requires comes from the header, where nonsense may stand.
TEST_F(VirtualCloud, HasNoDayWhereTheHeaderHasNone) {
  VirtualFile file = virtual_file(write_las(scratch, "a.las", ""));
  const auto day = [&](unsigned of_year, unsigned in_year) {
    file.created_day = of_year;
    file.created_year = in_year;
    write_virtual_cloud(scratch.path("out/all.vpc"), std::span(&file, 1), Overwrite::kYes);
    const json collection = json::parse(io::bytes_of(scratch.path("out/all.vpc")));
    return collection["features"][0]["properties"]["datetime"];
  };
  EXPECT_EQ(day(60, 2024), "2024-02-29T00:00:00Z");
  EXPECT_EQ(day(1, 1999), "1999-01-01T00:00:00Z");
  EXPECT_TRUE(day(0, 2024).is_null());
  EXPECT_TRUE(day(100, 0).is_null());
  EXPECT_TRUE(day(999, 2024).is_null());
}

}  // namespace
}  // namespace pcednet::formats
