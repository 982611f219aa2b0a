#include <gtest/gtest.h>

#include "io/sample_cloud.h"
#include "io/scratch.h"
#include "pcednet/core/parallel.h"
#include "pcednet/formats/write_cloud.h"

namespace pcednet::io {
namespace {

/// Reads back what is written of `cloud`.
PointCloud again(const Scratch& scratch, const PointCloud& cloud, bool ascii = false) {
  formats::write_cloud(scratch.path("again.ply"), cloud,
                       {.overwrite = Overwrite::kYes, .ascii = ascii});
  return formats::read_cloud(scratch.path("again.ply")).cloud;
}

TEST(PlyWrite, WritesTheLayoutThatOtherProgramsRead) {
  const Scratch scratch;
  PointCloud cloud = sample_cloud(1);
  cloud.positions[0] = Vec3(0.5, -1.5, 2.0);
  cloud.normals[0] = Vec3(0, 0, 1);
  cloud.colours[0] = {1, 2, 3};
  cloud.labels[0] = 2;
  cloud.attributes = {make_attribute("intensity", std::vector<std::int16_t>{-5}),
                      make_attribute("scalar_p", std::vector<double>{0.25}),
                      make_attribute("quality", std::vector<float>{0.75F})};
  formats::write_cloud(scratch.path("a.ply"), cloud);
  const std::string expected =
      "ply\nformat binary_little_endian 1.0\ncomment made by a test\nobj_info of its own\n"
      "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float quality\nproperty double scalar_p\nproperty short intensity\n"
      "property uchar label\nend_header\n" +
      packed(0.5F, -1.5F, 2.0F, 0.0F, 0.0F, 1.0F) + "\x01\x02\x03" +
      packed(0.75F, 0.25, std::int16_t{-5}) + "\x02";
  EXPECT_EQ(bytes_of(scratch.path("a.ply")), expected);
}

TEST(PlyWrite, GivesBackEveryBit) {
  const Scratch scratch;
  for (const bool ascii : {false, true}) {
    const PointCloud cloud = sample_cloud(20000);
    const PointCloud back = again(scratch, cloud, ascii);
    EXPECT_TRUE(same_bits(back.positions, cloud.positions));
    EXPECT_EQ(back.position_type, cloud.position_type);
    EXPECT_EQ(back.colours, cloud.colours);
    EXPECT_EQ(back.labels, cloud.labels);
    EXPECT_EQ(back.comments, cloud.comments);
    ASSERT_EQ(back.attributes.size(), cloud.attributes.size());
    for (const Attribute& attribute : cloud.attributes) {
      const Attribute* found = find_attribute(back, attribute.name);
      ASSERT_TRUE(found) << attribute.name;
      EXPECT_EQ(found->type, attribute.type);
      EXPECT_EQ(found->bytes, attribute.bytes);
    }
    // Normals are rounded to float and made unit again: 6e-8 per component.
    ASSERT_EQ(back.normals.size(), cloud.normals.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_LT((back.normals[i] - cloud.normals[i]).norm(), 1.5e-7);
    }
  }
}

TEST(PlyWrite, KeepsThePayloadOfNan) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions.resize(2, Vec3::Zero());
  const std::uint64_t bits = 0xFFF8000000001234;
  std::memcpy(&cloud.positions[1].y(), &bits, sizeof bits);
  EXPECT_TRUE(same_bits(again(scratch, cloud).positions, cloud.positions));
}

TEST(PlyWrite, KeepsTheTypeOfPositionsWhileTheySurviveInIt) {
  const Scratch scratch;
  PointCloud cloud;
  const auto written = [&](ScalarType type, double x) {
    cloud.position_type = type;
    cloud.positions = {Vec3(x, 1, 2)};
    const PointCloud back = again(scratch, cloud);
    EXPECT_EQ(back.positions[0].x(), x);
    return back.position_type;
  };
  EXPECT_EQ(written(ScalarType::kFloat32, 0.5), ScalarType::kFloat32);
  EXPECT_EQ(written(ScalarType::kFloat32, 0.1), ScalarType::kFloat64);
  EXPECT_EQ(written(ScalarType::kFloat32, 5403059.52), ScalarType::kFloat64);
  EXPECT_EQ(written(ScalarType::kFloat64, 0.5), ScalarType::kFloat64);
  EXPECT_EQ(written(ScalarType::kInt32, -2147483648.0), ScalarType::kInt32);
  EXPECT_EQ(written(ScalarType::kInt32, 2147483648.0), ScalarType::kFloat64);
  EXPECT_EQ(written(ScalarType::kUint8, 255), ScalarType::kUint8);
  EXPECT_EQ(written(ScalarType::kUint8, 255.5), ScalarType::kFloat64);
  EXPECT_EQ(written(ScalarType::kInt64, 4), ScalarType::kFloat64);
}

TEST(PlyWrite, WritesTheSameBytesForAnyNumberOfThreads) {
  const Scratch scratch;
  const PointCloud cloud = sample_cloud(70000);
  std::string one;
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    formats::write_cloud(scratch.path("a.ply"), cloud, {.overwrite = Overwrite::kYes});
    const std::string bytes = bytes_of(scratch.path("a.ply"));
    if (threads == 1) one = bytes;
    EXPECT_TRUE(bytes == one);
    EXPECT_TRUE(
        same_bits(formats::read_cloud(scratch.path("a.ply")).cloud.positions, cloud.positions));
  }
  set_thread_count(0);
}

TEST(PlyWrite, CarriesOtherElementsThrough) {
  const Scratch scratch;
  const std::string header =
      "element face 2\nproperty list uint8 int vertex_indices\nproperty float area\n";
  const std::string rows = "3 0 1 2 0.25\n0 -1e+20\n";
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
      "property float y\nproperty float z\n" +
      header + "end_header\n0.1 2 3\n" + rows;
  const PointCloud cloud = scratch.read("a.ply", text).cloud;
  const PointCloud binary = again(scratch, cloud);
  ASSERT_EQ(binary.foreign_elements.size(), 1u);
  EXPECT_EQ(binary.foreign_elements[0].header, header);
  EXPECT_EQ(binary.foreign_elements[0].bytes, cloud.foreign_elements[0].bytes);
  formats::write_cloud(scratch.path("b.ply"), binary, {.ascii = true});
  EXPECT_EQ(bytes_of(scratch.path("b.ply")), text);
}

TEST(PlyWrite, GivesNamesAnd64BitIntegersBack) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {Vec3(1, 2, 3)};
  cloud.labels = {1};
  cloud.attributes = {make_attribute("roof angle", std::vector<float>{1}),
                      make_attribute("roof%20angle", std::vector<float>{2}),
                      make_attribute("label", std::vector<float>{0.5}),
                      make_attribute("x", std::vector<float>{0.5}),
                      make_attribute("xx", std::vector<float>{0.25}),
                      make_attribute("xx", std::vector<float>{0.75}),
                      make_attribute("xx", std::vector<float>{1.25}),
                      make_attribute("time", std::vector<std::int64_t>{-(1LL << 62) - 1}),
                      make_attribute("id", std::vector<std::uint64_t>{UINT64_MAX - 1}),
                      make_attribute("_", std::vector<std::uint8_t>{7}),
                      make_attribute("id_low32", std::vector<std::uint32_t>{7}),
                      make_attribute("id_high32", std::vector<std::uint32_t>{8})};
  for (const char* name : {"a.ply", "a.pcd"}) {
    for (const bool ascii : {false, true}) {
      EXPECT_TRUE(formats::losses(name, cloud).empty());
      formats::write_cloud(scratch.path(name), cloud, {Overwrite::kYes, ascii});
      const PointCloud back = formats::read_cloud(scratch.path(name)).cloud;
      ASSERT_EQ(back.attributes.size(), cloud.attributes.size());
      for (std::size_t a = 0; a < cloud.attributes.size(); ++a) {
        EXPECT_EQ(back.attributes[a].name, cloud.attributes[a].name);
        EXPECT_EQ(back.attributes[a].type, cloud.attributes[a].type) << back.attributes[a].name;
        EXPECT_EQ(back.attributes[a].bytes, cloud.attributes[a].bytes);
      }
      EXPECT_EQ(back.labels, cloud.labels);
    }
  }
}

TEST(PlyWrite, SplitsAttributesOfSeveralNumbers) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {Vec3(1, 2, 3)};
  cloud.attributes = {{"pair", ScalarType::kUint8, 2, {std::byte{4}, std::byte{5}}}};
  const PointCloud back = again(scratch, cloud);
  ASSERT_EQ(back.attributes.size(), 2u);
  EXPECT_EQ(back.attributes[0].name, "pair_0");
  EXPECT_EQ(back.attributes[1].value(0), 5.0);
}

TEST(PlyWrite, NamesColumnsInASingleWord) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {Vec3(1, 2, 3)};
  cloud.attributes = {make_attribute("Pulse width", std::vector<float>{1}),
                      make_attribute("x", std::vector<std::uint64_t>{1})};
  formats::write_cloud(scratch.path("a.ply"), cloud);
  const std::string bytes = bytes_of(scratch.path("a.ply"));
  for (const char* line : {"\nproperty float Pulse%20width\n", "\nproperty uint x_low32\n",
                           "\nproperty uint x_high32\n"}) {
    EXPECT_TRUE(contains(bytes, line)) << line;
  }
}

TEST(PlyWrite, TellsManyColumnsOfOneNameApart) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  constexpr std::int16_t kMany = 2000;  // takes half a minute if each tries the names of all others
  for (std::int16_t i = 0; i < kMany; ++i) {
    cloud.attributes.push_back(make_attribute("a", std::vector<std::int16_t>{i}));
  }
  formats::write_cloud(scratch.path("a.ply"), cloud);
  const std::string bytes = bytes_of(scratch.path("a.ply"));
  EXPECT_TRUE(contains(bytes,
                       "property short a\nproperty short %61\nproperty short %61_\n"
                       "property short %61%5F\nproperty short %61%5F_\n"));
  const PointCloud back = formats::read_cloud(scratch.path("a.ply")).cloud;
  ASSERT_EQ(back.attributes.size(), cloud.attributes.size());
  for (std::int16_t i = 0; i < kMany; ++i) {
    EXPECT_EQ(back.attributes[static_cast<std::size_t>(i)].value(0), i);
  }
}

TEST(PlyWrite, GivesNormalsBackInTheirTypeAndLength) {
  const Scratch scratch;
  for (const std::string type : {"float", "double"}) {
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
        "property double z\nproperty " +
        type + " nx\nproperty " + type + " ny\nproperty " + type +
        " nz\nend_header\n1 2 3 0.577 0.5774 0.57735\n1 2 3 0 0 -7\n";
    const PointCloud cloud = scratch.read("a.ply", text).cloud;
    EXPECT_EQ(cloud.normals.at(1), Vec3(0, 0, -1));
    for (const char* name : {"b.ply", "b.pcd", "b.xyz", "b.csv"}) {
      formats::write_cloud(scratch.path(name), cloud, {.overwrite = Overwrite::kYes});
      const PointCloud back = formats::read_cloud(scratch.path(name)).cloud;
      // Text does not say that its digits are those of floats.
      const bool keeps_type = type == "double" || std::string_view(name).starts_with("b.p");
      EXPECT_TRUE(!keeps_type || same_bits(back.normals, cloud.normals)) << name;
      formats::write_cloud(scratch.path("a.ply"), back, {Overwrite::kYes, true});
      EXPECT_TRUE(contains(bytes_of(scratch.path("a.ply")), "0.577 0.5774 0.57735\n1 2 3 0 0 -7"));
    }
  }
}

TEST(PlyWrite, KeepsCommentsWithinTheirLines) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {Vec3(1, 2, 3)};
  cloud.comments = {"one\nelement vertex 7\r\nthree", "", "end_header"};
  const PointCloud back = again(scratch, cloud);
  EXPECT_EQ(back.size(), 1u);
  EXPECT_EQ(back.comments,
            (std::vector<std::string>{"one", "element vertex 7", "three", "", "end_header"}));
}

TEST(PlyWrite, WritesACloudWithoutPoints) {
  const Scratch scratch;
  for (const bool ascii : {false, true}) EXPECT_TRUE(again(scratch, {}, ascii).empty());
}

}  // namespace
}  // namespace pcednet::io
