#include "pcednet/io/las/copc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "io/las/las_writer.h"
#include "pcednet/core/parallel.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/las/facts.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/projection.h"

namespace pcednet::io {
namespace {

/// Header, info record and hierarchy of a COPC file, from the tables of its specification.
struct Copc {
  unsigned version = 0, format = 0, encoding = 0;
  std::uint64_t points = 0;
  std::array<double, 3> least = {}, largest = {};
  std::array<double, 3> centre = {};
  double half_side = 0.0, spacing = 0.0, first_time = 0.0, last_time = 0.0;
  struct Node {
    std::array<std::int32_t, 4> key = {};  ///< depth, x, y, z
    std::uint64_t begin = 0;
    std::int32_t bytes = 0, points = 0;
  };
  std::vector<Node> nodes = {};
};

Copc parse(const std::string& bytes) {
  EXPECT_EQ(get_number<std::uint16_t>(bytes, 94), 375) << "bytes of the header";
  EXPECT_EQ(bytes.substr(377, 5), std::string("copc\0", 5)) << "the first record";
  EXPECT_EQ(get_number<std::uint16_t>(bytes, 393), 1);
  EXPECT_EQ(get_number<std::uint16_t>(bytes, 395), 160);
  Copc copc{.version = get_number<std::uint8_t>(bytes, 25),
            .format = get_number<std::uint8_t>(bytes, 104),
            .encoding = get_number<std::uint16_t>(bytes, 6),
            .points = get_number<std::uint64_t>(bytes, 247)};
  for (std::size_t a = 0; a < 3; ++a) {
    copc.largest[a] = get_number<double>(bytes, 179 + 16 * a);
    copc.least[a] = get_number<double>(bytes, 187 + 16 * a);
    copc.centre[a] = get_number<double>(bytes, 429 + 8 * a);
  }
  copc.half_side = get_number<double>(bytes, 453);
  copc.spacing = get_number<double>(bytes, 461);
  const auto begin = get_number<std::uint64_t>(bytes, 469),
             size = get_number<std::uint64_t>(bytes, 477);
  copc.first_time = get_number<double>(bytes, 485);
  copc.last_time = get_number<double>(bytes, 493);
  EXPECT_EQ(get_number<std::uint64_t>(bytes, 235), begin - 60) << "the first extended record";
  EXPECT_EQ(get_number<std::uint16_t>(bytes, begin - 42), 1000);
  EXPECT_EQ(get_number<std::uint64_t>(bytes, begin - 40), size);
  for (std::uint64_t at = begin; at < begin + size; at += 32) {
    Copc::Node node;
    for (std::size_t k = 0; k < 4; ++k) node.key[k] = get_number<std::int32_t>(bytes, at + 4 * k);
    node.begin = get_number<std::uint64_t>(bytes, at + 16);
    node.bytes = get_number<std::int32_t>(bytes, at + 24);
    node.points = get_number<std::int32_t>(bytes, at + 28);
    copc.nodes.push_back(node);
  }
  return copc;
}

/// The points as bytes, sorted: what does not depend on their order. Attributes that only one of
/// two files has can be left out.
std::vector<std::string> sorted_points(const PointCloud& cloud,
                                       const std::vector<std::string>& but = {}) {
  std::map<std::string, const Attribute*> by_name;
  for (const Attribute& attribute : cloud.attributes) by_name[attribute.name] = &attribute;
  for (const std::string& name : but) by_name.erase(name);
  std::vector<std::string> points(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    points[i] = packed(cloud.positions[i].x(), cloud.positions[i].y(), cloud.positions[i].z());
    if (cloud.has_normals()) points[i] += packed(cloud.normals[i]);
    if (!cloud.colours.empty()) points[i] += packed(cloud.colours[i]);
    for (const auto& [name, attribute] : by_name) {
      const auto* first = reinterpret_cast<const char*>(attribute->bytes.data());
      points[i] += name + ' ';
      points[i].append(first + i * attribute->stride(), attribute->stride());
    }
  }
  std::sort(points.begin(), points.end());
  return points;
}

PointCloud copied(const Scratch& scratch, const PointCloud& cloud) {
  formats::write_cloud(scratch.path("a.copc.laz"), cloud, {.overwrite = Overwrite::kYes});
  return formats::read_cloud(scratch.path("a.copc.laz")).cloud;
}

LasTestFile file_of(unsigned format, unsigned minor, std::size_t points, std::size_t extra = 0) {
  LasTestFile file{format, minor, las_test_rows(format, points, extra, format < 6 ? 1 : 4), extra};
  file.records = {{"somebody", 7, "abc"}};
  if (minor >= 4) file.extended = {{"somebody", 8, "abc"}};
  return file;
}

TEST(Copc, IsChosenByTheNameInAnyCase) {
  EXPECT_TRUE(is_copc_name("folder/a.copc.laz"));
  EXPECT_TRUE(is_copc_name("A.Copc.LAZ"));
  EXPECT_FALSE(is_copc_name("a.laz"));
  EXPECT_FALSE(is_copc_name("a.copc.las"));
  EXPECT_FALSE(is_copc_name("folder.copc.laz/a.laz"));
}

TEST(Copc, GivesEveryPointOfEveryFormatBack) {
  const Scratch scratch;
  constexpr unsigned kFormats[] = {6, 6, 7, 7, 6, 7, 6, 7, 8, 6, 8};
  for (unsigned format = 0; format <= 10; ++format) {
    const LasTestFile file = file_of(format, 4, 1000, format % 3);
    const PointCloud cloud = scratch.read("in.las", las_bytes(file)).cloud;
    const PointCloud back = copied(scratch, cloud);
    std::vector<std::string> new_fields;
    for (const Attribute& attribute : back.attributes) {
      if (!find_attribute(cloud, attribute.name)) new_fields.push_back(attribute.name);
    }
    EXPECT_EQ(sorted_points(back, new_fields), sorted_points(cloud, {"ScanAngleRank"})) << format;
    const Copc copc = parse(bytes_of(scratch.path("a.copc.laz")));
    EXPECT_EQ(copc.version, 4U);
    EXPECT_EQ(copc.format, kFormats[format] + 128);
    EXPECT_EQ(copc.points, 1000U);
  }
}

TEST(Copc, HasTheHeaderOfLas14WhateverTheInputHas) {
  const Scratch scratch;
  for (unsigned minor = 0; minor <= 5; ++minor) {
    LasTestFile file = file_of(1, minor, 100);
    const PointCloud cloud = scratch.read("in.las", las_bytes(file)).cloud;
    EXPECT_EQ(copied(scratch, cloud).size(), 100U);
    const Copc copc = parse(bytes_of(scratch.path("a.copc.laz")));
    EXPECT_EQ(copc.version, 4U);
    EXPECT_EQ(copc.points, 100U);
  }
}

TEST(Copc, TurnsWholeDegreesIntoScanAnglesOfFormatSix) {
  const Scratch scratch;
  const PointCloud cloud = scratch.read("in.las", las_bytes(file_of(1, 2, 500))).cloud;
  const PointCloud back = copied(scratch, cloud);
  const auto numbers = [](const PointCloud& from, const char* name) {
    std::vector<double> found;
    const Attribute* attribute = find_attribute(from, name);
    for (std::size_t i = 0; attribute && i < from.size(); ++i) found.push_back(attribute->value(i));
    std::sort(found.begin(), found.end());
    return found;
  };
  const std::vector<double> degrees = numbers(cloud, "ScanAngleRank"),
                            steps = numbers(back, "ScanAngle");
  ASSERT_EQ(steps.size(), degrees.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_NEAR(0.006 * steps[i], degrees[i], 0.003 + 1e-9);
  }
  EXPECT_LT(degrees.front(), -10.0);
  EXPECT_EQ(find_attribute(back, "ScanAngleRank"), nullptr);
}

TEST(Copc, HoldsTheBoundsTheTimesAndTheRecords) {
  const Scratch scratch;
  const PointCloud cloud = scratch.read("in.las", las_bytes(file_of(6, 4, 2000))).cloud;
  const PointCloud back = copied(scratch, cloud);
  const Copc copc = parse(bytes_of(scratch.path("a.copc.laz")));
  const Attribute* times = find_attribute(cloud, "GpsTime");
  double least = times->value(0), largest = least;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    least = std::min(least, times->value(i));
    largest = std::max(largest, times->value(i));
  }
  EXPECT_EQ(copc.first_time, least);
  EXPECT_EQ(copc.last_time, largest);
  double side = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_LT(copc.centre[a] - copc.half_side, copc.least[a]);
    EXPECT_GT(copc.centre[a] + copc.half_side, copc.largest[a]);
    side = std::max(side, copc.largest[a] - copc.least[a]);
  }
  EXPECT_NEAR(2 * copc.half_side, side, 0.01);
  EXPECT_DOUBLE_EQ(copc.spacing, copc.half_side / 64);
  std::vector<std::string> users;
  EXPECT_TRUE(las_facts(InputFile(scratch.path("a.copc.laz"))).copc);
  const InputFile file(scratch.path("a.copc.laz"));
  for (const LasFacts::Record& record : las_facts(file).records) {
    users.push_back(record.user_id);
  }
  EXPECT_EQ(users, (std::vector<std::string>{"somebody", "laszip encoded", "somebody"}));
}

/// A million points in a street of houses, more than a node holds.
PointCloud street(std::size_t points) {
  Random random(3);
  PointCloud cloud;
  cloud.position_type = ScalarType::kFloat64;
  std::vector<double> times;
  for (std::size_t i = 0; i < points; ++i) {
    const double x = random.uniform(0, 400), y = random.uniform(0, i % 2 ? 30 : 300);
    const double z = std::fmod(x, 20.0) < 12.0 ? 6.0 : 0.01 * y;
    const auto whole = [](double value) { return std::round(1000.0 * value) / 1000.0; };
    cloud.positions.emplace_back(whole(x), whole(y), whole(z));
    times.push_back(static_cast<double>(i / 3));
  }
  cloud.attributes.push_back(make_attribute("GpsTime", times));
  return cloud;
}

TEST(Copc, CutsACloudIntoNodesThatHoldTheirPoints) {
  const Scratch scratch;
  const PointCloud cloud = street(400'000);
  const PointCloud back = copied(scratch, cloud);
  const Copc copc = parse(bytes_of(scratch.path("a.copc.laz")));
  ASSERT_GT(copc.nodes.size(), 4U);
  EXPECT_LT(copc.nodes.size(), 60U);
  std::size_t first = 0;  // our reader gives chunk after chunk
  std::uint64_t begin = copc.nodes[0].begin;
  for (const Copc::Node& node : copc.nodes) {
    EXPECT_EQ(node.begin, begin);
    begin += static_cast<std::uint64_t>(node.bytes);
    const double side = 2 * copc.half_side / static_cast<double>(1 << node.key[0]);
    for (std::size_t i = first; i < first + static_cast<std::size_t>(node.points); ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        const double from = copc.centre[a] - copc.half_side + side * node.key[a + 1];
        const double at = back.positions[i][static_cast<int>(a)];
        ASSERT_TRUE(at > from - 1e-9 && at < from + side + 1e-9) << i << ": " << at;
      }
    }
    first += static_cast<std::size_t>(node.points);
  }
  EXPECT_EQ(first, cloud.size());
  EXPECT_EQ(sorted_points(back, {"ReturnNumber"}).size(), cloud.size());
}

TEST(Copc, HasTheSameBytesForAnyNumberOfThreadsAndAnyOrderOfThePoints) {
  const Scratch scratch;
  const std::size_t points = 250'000;
  const LasTestFile file{7, 4, las_test_rows(7, points)};
  const std::size_t stride = las_test_stride(7);
  std::string wanted;
  Random random(5);
  LasTestFile shuffled = file;
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    copied(scratch, scratch.read("in.las", las_bytes(shuffled)).cloud);
    const std::string bytes = bytes_of(scratch.path("a.copc.laz"));
    if (wanted.empty()) wanted = bytes;
    EXPECT_TRUE(bytes == wanted) << threads << " threads";
    for (std::size_t i = points; i-- > 1;) {
      const std::size_t j = random.index(i + 1);
      std::swap_ranges(shuffled.rows.begin() + i * stride, shuffled.rows.begin() + (i + 1) * stride,
                       shuffled.rows.begin() + j * stride);
    }
  }
  set_thread_count(0);
  EXPECT_GT(parse(wanted).nodes.size(), 2U);
}

TEST(Copc, HoldsNoPointsOrOneOrManyInOnePlace) {
  const Scratch scratch;
  for (const std::size_t points : {std::size_t{0}, std::size_t{1}, std::size_t{3'000'000}}) {
    PointCloud cloud;
    cloud.position_type = ScalarType::kFloat64;
    cloud.positions.assign(points, Vec3(1.5, -2.25, 1e6));
    const PointCloud back = copied(scratch, cloud);
    EXPECT_TRUE(same_bits(back.positions, cloud.positions)) << points;
    const Copc copc = parse(bytes_of(scratch.path("a.copc.laz")));
    std::uint64_t sum = 0;
    for (const Copc::Node& node : copc.nodes) sum += static_cast<std::uint64_t>(node.points);
    EXPECT_EQ(sum, points);
  }
}

TEST(Copc, HasAPointFormatWithTheColoursOfOtherFiles) {
  const Scratch scratch;
  PointCloud cloud = street(1000);
  cloud.colours.assign(1000, {1, 2, 3});
  EXPECT_TRUE(copied(scratch, cloud).colours == cloud.colours);
  EXPECT_EQ(parse(bytes_of(scratch.path("a.copc.laz"))).format, 135U);
  cloud.attributes.push_back(make_attribute("Infrared", std::vector<std::uint16_t>(1000, 777)));
  EXPECT_EQ(find_attribute(copied(scratch, cloud), "Infrared")->value(5), 777.0);
  EXPECT_EQ(parse(bytes_of(scratch.path("a.copc.laz"))).format, 136U);

  // Colours that a LAS file has no fields for, such as those of classes, are none in COPC either.
  PointCloud coloured = scratch.read("in.las", las_bytes(file_of(1, 2, 100))).cloud;
  coloured.colours.assign(100, {9, 8, 7});
  EXPECT_EQ(formats::losses("a.copc.laz", coloured),
            (std::vector<std::string>{"colours: point format 6 has none"}));
  EXPECT_TRUE(copied(scratch, coloured).colours.empty());
}

TEST(Copc, NamesTheTimeOffsetThatItCannotHold) {
  const Scratch scratch;
  std::string bytes = las_bytes(file_of(6, 5, 100));
  EXPECT_TRUE(formats::losses("a.copc.laz", scratch.read("in.las", bytes).cloud).empty());
  set_number<std::uint16_t>(bytes, 6, 17 + 64);
  const auto lost = formats::losses("a.copc.laz", scratch.read("in.las", bytes).cloud);
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_TRUE(contains(lost[0], "offset of all times"));
}

// GeoTIFF keys name systems by codes, COPC takes definitions.
TEST(Copc, NamesTheCoordinateSystemInWkt) {
  const Scratch scratch;
  LasTestFile file = file_of(1, 2, 100);
  std::string keys;
  for (const int number : {1, 1, 0, 1, 3072, 0, 1, 25832}) {
    keys += packed(static_cast<std::uint16_t>(number));
  }
  file.records = {{"LASF_Projection", 34735, keys}};
  const PointCloud cloud = scratch.read("in.las", las_bytes(file)).cloud;
  const CoordinateSystem system = las_coordinate_system(copied(scratch, cloud));
  EXPECT_EQ(system.epsg, 25832);
  EXPECT_EQ(system.wkt.starts_with("PROJCS[\"ETRS89 / UTM zone 32N\""), has_projections());
  EXPECT_EQ(formats::losses("a.copc.laz", cloud).empty(), has_projections());
  const bool wkt_bit = (parse(bytes_of(scratch.path("a.copc.laz"))).encoding & 16U) != 0;
  EXPECT_EQ(wkt_bit, has_projections());

  set_number<std::uint16_t>(keys, 14, 20);  // no code that there is
  file.records = {{"LASF_Projection", 34735, keys}};
  const PointCloud unknown = scratch.read("in.las", las_bytes(file)).cloud;
  EXPECT_EQ(formats::losses("a.copc.laz", unknown).size(), 1U);

  file.records = {{"LASF_Projection", 2112, std::string("PROJCS[\"mine\"]") + '\0'}};
  const PointCloud own = scratch.read("in.las", las_bytes(file)).cloud;
  EXPECT_EQ(las_coordinate_system(copied(scratch, own)).wkt, "PROJCS[\"mine\"]");
  EXPECT_TRUE(formats::losses("a.copc.laz", own).empty());
}

TEST(Copc, BecomesPlainLasAgain) {
  const Scratch scratch;
  const LasTestFile file = file_of(6, 4, 500);
  const PointCloud back = copied(scratch, scratch.read("in.las", las_bytes(file)).cloud);
  formats::write_cloud(scratch.path("b.las"), back, {});
  const std::string bytes = bytes_of(scratch.path("b.las"));
  EXPECT_EQ(bytes.find("copc"), std::string::npos);
  EXPECT_EQ(bytes.size(), las_bytes(file).size());
}

// Such as a program leaves that unpacks COPC without knowing it.
TEST(Copc, ReplacesTheIndexOfAnotherFile) {
  const Scratch scratch;
  LasTestFile file = file_of(6, 4, 100);
  file.records.push_back({"copc", 1, std::string(160, 'i')});
  file.extended.push_back({"copc", 1000, std::string(32, 'h')});
  const PointCloud back = copied(scratch, scratch.read("in.las", las_bytes(file)).cloud);
  EXPECT_EQ(back.size(), 100U);
  const std::string bytes = bytes_of(scratch.path("a.copc.laz"));
  EXPECT_EQ(parse(bytes).nodes.size(), 1U);
  EXPECT_EQ(bytes.find(std::string(160, 'i')), std::string::npos);
  EXPECT_EQ(bytes.find(std::string(32, 'h')), std::string::npos);
}

TEST(Copc, LeavesNoFileBehindWhenAPointIsRefused) {
  const Scratch scratch;
  PointCloud cloud = street(10);
  cloud.positions[3].z() = NAN;
  const auto path = scratch.path("a.copc.laz");
  error_of(ErrorKind::kInsufficient, [&] { formats::write_cloud(path, cloud, {}); });
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path("")));
}

}  // namespace
}  // namespace pcednet::io
