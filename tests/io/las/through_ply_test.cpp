#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/las/las_writer.h"
#include "pcednet/formats/write_cloud.h"

namespace pcednet::io {
namespace {

std::string las_of(const Scratch& scratch, const PointCloud& cloud) {
  formats::write_cloud(scratch.path("out.las"), cloud, {.overwrite = Overwrite::kYes});
  return bytes_of(scratch.path("out.las"));
}

std::string through_las(const Scratch& scratch, const std::string& bytes) {
  return las_of(scratch, scratch.read("in.las", bytes).cloud);
}

std::string through(const std::string& name, const Scratch& scratch, const std::string& bytes,
                    const WriteOptions& options = {.overwrite = Overwrite::kYes}) {
  formats::write_cloud(scratch.path(name), scratch.read("in.las", bytes).cloud, options);
  return las_of(scratch, formats::read_cloud(scratch.path(name)).cloud);
}

LasTestFile with_extra(unsigned format, const std::string& descriptors, std::size_t bytes) {
  LasTestFile file{format, 4, las_test_rows(format, 40, bytes), bytes};
  if (!descriptors.empty()) file.records = {{"LASF_Spec", 4, descriptors, "extra bytes"}};
  return file;
}

TEST(LasThroughPly, GivesNamesBackThatPlyCannotHold) {
  const Scratch scratch;
  for (const std::string name :
       {"Pulse width", " a,b;c\"d ", "tab\there", "100%", "%41", "%", "x", "nx", "red", "rgb",
        "scalar_x", "w_low32", "w_high32", "\xC3\xA4 \x7F"}) {
    const std::string bytes = las_bytes(with_extra(6, las_test_extra(name, 3), 2));
    EXPECT_TRUE(through("a.ply", scratch, bytes) == bytes) << name;
    EXPECT_TRUE(formats::losses("a.ply", formats::read_cloud(scratch.path("in.las")).cloud).empty())
        << name;
  }
}

TEST(LasThroughPly, GivesFieldsBackThatAreColoursOrNormalsOrLabelsInPly) {
  const Scratch scratch;
  const auto fields = [](std::initializer_list<const char*> names, unsigned type) {
    std::string descriptors;
    for (const char* name : names) descriptors += las_test_extra(name, type);
    return descriptors;
  };
  for (const LasTestFile& file :
       {with_extra(6, fields({"red", "green", "blue"}, 1), 3),
        with_extra(7, fields({"Red_", "g", "b", "r"}, 1), 4),
        with_extra(6, fields({"label", "scalar_label"}, 1), 2),
        with_extra(6, fields({"nx", "ny", "nz"}, 9), 12), with_extra(6, fields({"rgba"}, 5), 4)}) {
    const std::string bytes = las_bytes(file);
    EXPECT_TRUE(through("a.ply", scratch, bytes) == bytes) << file.records[0].data.substr(4, 32);
  }
}

TEST(LasThroughPly, KeepsNamesApartThatLookTheSameThere) {
  const Scratch scratch;
  const std::string fields = las_test_extra("Pulse width", 3) + las_test_extra("Pulse_width", 3) +
                             las_test_extra("Pulse%20width", 3) + las_test_extra("a_0", 3) +
                             las_test_extra("a", 13) + las_test_extra("a_1", 3) +
                             las_test_extra("b_low32", 5) + las_test_extra("b_high32", 5) +
                             las_test_extra("b", 7) + las_test_extra("same", 3) +
                             las_test_extra("same", 3) + las_test_extra("x_high32", 5);
  const std::string bytes = las_bytes(with_extra(7, fields, 2 * 3 + 2 + 4 + 2 + 8 + 8 + 4 + 4));
  EXPECT_TRUE(through("a.ply", scratch, bytes) == bytes);
}

TEST(LasThroughPly, GivesScalarsAndArraysOfEveryTypeBack) {
  const Scratch scratch;
  constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  for (unsigned type = 1; type <= 30; ++type) {
    const std::size_t size = kBytes[(type - 1) % 10] * (1 + (type - 1) / 10);
    const std::string bytes = las_bytes(with_extra(1, las_test_extra("some field", type), size));
    EXPECT_TRUE(through("a.ply", scratch, bytes) == bytes) << type;
    const bool has_nan_payloads = type % 10 == 9 || type % 10 == 0;
    if (has_nan_payloads) continue;
    EXPECT_TRUE(through("a.ply", scratch, bytes, {Overwrite::kYes, true}) == bytes) << type;
  }
}

TEST(LasThroughPly, GivesBytesBackThatNothingDescribes) {
  const Scratch scratch;
  for (const std::size_t count : {1U, 2U, 300U}) {
    const std::string alone = las_bytes(with_extra(0, "", count));
    EXPECT_TRUE(through("a.ply", scratch, alone) == alone) << count;
    const std::string fields = las_test_extra("height", 9) + las_test_extra("raw", 0, 7);
    const std::string behind = las_bytes(with_extra(8, fields, 11 + count));
    EXPECT_TRUE(through("a.ply", scratch, behind) == behind) << count;
  }
}

TEST(LasThroughPly, GivesWavePacketsBack) {
  const Scratch scratch;
  for (const unsigned format : {4U, 5U, 9U, 10U}) {
    const std::string bytes = las_bytes(with_extra(format, "", 0));
    EXPECT_TRUE(through("a.ply", scratch, bytes) == bytes) << format;
  }
}

TEST(LasThroughPly, LeavesFieldsOutThatThePlyHasLost) {
  const Scratch scratch;
  const std::string height = las_test_extra("height", 9), code = las_test_extra("code", 7),
                    pair = las_test_extra("pair", 11);
  LasTestFile file = with_extra(6, height + code + pair, 4 + 8 + 2 + 3);
  PointCloud cloud = scratch.read("in.las", las_bytes(file)).cloud;
  std::erase_if(cloud.attributes, [](const Attribute& a) {
    return a.name == "height" || a.name == "pair" || a.name == "ExtraBytes";
  });
  std::string rows;
  for (std::size_t i = 0; i < 40; ++i) {
    rows += file.rows.substr(47 * i, 30) + file.rows.substr(47 * i + 34, 8);
  }
  file.rows = rows;
  file.extra = 8;
  file.records[0].data = code;
  EXPECT_TRUE(las_of(scratch, cloud) == las_bytes(file));
  std::erase_if(cloud.attributes, [](const Attribute& a) { return a.name == "code"; });
  EXPECT_TRUE(find_attribute(scratch.read("b.las", las_of(scratch, cloud)).cloud, "code") ==
              nullptr);
}

constexpr const char* kAxes[] = {"NormalX", "NormalY", "NormalZ"};

/// Points with normals of any length, usable or not, as numbers of type T, and a byte behind.
template <typename T>
std::string las_with_normals(unsigned type, const std::vector<std::array<T, 3>>& normals) {
  LasTestFile file{6, 4, "", 3 * sizeof(T) + 1};
  file.records = {{"LASF_Spec", 4, "", "extra bytes"}};
  for (const char* axis : kAxes) file.records[0].data += las_test_extra(axis, type);
  file.records[0].data += las_test_extra("behind", 1);
  const std::string plain = las_test_rows(6, normals.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const auto& n = normals[i];
    file.rows += plain.substr(30 * i, 30) + packed(n[0], n[1], n[2], std::uint8_t{77});
  }
  return las_bytes(file);
}

template <typename T>
std::vector<std::array<T, 3>> normals_of_all_lengths() {
  constexpr T kNan = std::numeric_limits<T>::quiet_NaN();
  std::vector<std::array<T, 3>> normals = {
      {0, 0, 0}, {-T(0), 0, T(3)}, {kNan, 0, 1}, {T(1e-30), T(1e30), 0}, {0, 0, T(0.999)}};
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const double y = random.normal(), x = random.normal();
    const Vec3 n = random.uniform(0.5, 2.0) * Vec3(x, y, 0.1);
    const Vec3 made = i % 2 == 0 ? n : n.normalized();
    normals.push_back({T(made.x()), T(made.y()), T(made.z())});
  }
  return normals;
}

TEST(LasThroughPly, GivesNormalsBackBitForBit) {
  const Scratch scratch;
  const std::string narrow = las_with_normals(9, normals_of_all_lengths<float>());
  const std::string wide = las_with_normals(10, normals_of_all_lengths<double>());
  const std::string whole = las_with_normals<std::int16_t>(4, {{0, 0, 32767}, {-23170, 23170, 1}});
  const std::string unusable = las_with_normals<float>(9, {{0, 0, 0}, {-0.0F, NAN, 0}});
  for (const std::string& bytes : {narrow, wide, whole, unusable}) {
    EXPECT_TRUE(through_las(scratch, bytes) == bytes);
    EXPECT_TRUE(through("a.laz", scratch, bytes) == bytes);
  }
  for (const std::string& bytes : {narrow, wide, whole}) {
    EXPECT_TRUE(through("a.ply", scratch, bytes) == bytes);
    EXPECT_NEAR(formats::read_cloud(scratch.path("a.ply")).cloud.normals.at(1).norm(), 1.0, 1e-15);
  }
}

TEST(LasThroughPly, WritesNormalsThatChangedInsteadOfThoseStored) {
  const Scratch scratch;
  PointCloud cloud =
      scratch.read("a.las", las_with_normals<float>(9, {{0, 0, 3}, {0, 4, 0}})).cloud;
  EXPECT_TRUE(normals_are_stored(cloud));
  cloud.normals[0] = Vec3(0, 0, -1);
  EXPECT_FALSE(normals_are_stored(cloud));
  const PointCloud back = scratch.read("b.las", las_of(scratch, cloud)).cloud;
  EXPECT_EQ(back.normals, (std::vector<Vec3>{Vec3(0, 0, -1), Vec3(0, 1, 0)}));
  EXPECT_EQ(back.stored_normals.at(1).value(1), 1.0);
  // Integers of 16 bits have no room for them.
  cloud = scratch.read("a.las", las_with_normals<std::int16_t>(4, {{0, 0, 9}, {0, 9, 0}})).cloud;
  cloud.normals = {Vec3(0, 0, -1), Vec3(1, 0, 0)};
  const PointCloud moved = scratch.read("b.las", las_of(scratch, cloud)).cloud;
  EXPECT_EQ(moved.normals, cloud.normals);
  ASSERT_TRUE(find_attribute(moved, "behind"));
  EXPECT_EQ(find_attribute(moved, "behind")->value(1), 77.0);
}

}  // namespace
}  // namespace pcednet::io
