#include "workbench/report/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "pcednet/core/random_vectors.h"
#include "support/expect_error.h"

namespace pcednet::report {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

/// An independent decoder: by the position of each digit, bit by bit.
std::vector<std::uint8_t> decode(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  unsigned bits = 0, have = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    have += 6;
    if (have >= 8) {
      have -= 8;
      bytes.push_back(static_cast<std::uint8_t>(bits >> have));
      bits &= (1u << have) - 1;
    }
  }
  return bytes;
}

PointCloud random_cloud(std::size_t count) {
  Random random(3);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = random.uniform(), y = random.uniform(), x = random.uniform();
    cloud.positions.emplace_back(1e6 + x, 5e6 + 2 * y, -z);
    cloud.normals.push_back(normal_vector(random).normalized());
    cloud.labels.push_back(static_cast<std::uint8_t>(i % 4 == 3 ? 255 : i % 4));
  }
  return cloud;
}

TEST(Base64, GivesTheTestVectorsOfRfc4648) {
  EXPECT_EQ(encode_base64({}), "");
  EXPECT_EQ(encode_base64(bytes_of("f")), "Zg==");
  EXPECT_EQ(encode_base64(bytes_of("fo")), "Zm8=");
  EXPECT_EQ(encode_base64(bytes_of("foobar")), "Zm9vYmFy");
  EXPECT_EQ(encode_base64(std::vector<std::uint8_t>{255, 254, 253}), "//79");
}

TEST(Scene, KeepsPositionsToHalfAStepOfTheirBox) {
  const PointCloud cloud = random_cloud(500);
  const Scene scene = make_scene(cloud, 1000);
  ASSERT_EQ(scene.shown.size(), 500u);
  const auto bytes = decode(scene.positions);
  ASSERT_EQ(bytes.size(), 3000u);
  for (std::size_t k = 0; k < 500; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t at = 6 * k + 2 * axis;
      const double q = bytes[at] + 256.0 * bytes[at + 1];
      EXPECT_NEAR(scene.min[axis] + q / 65535 * scene.size,
                  cloud.positions[scene.shown[k]][static_cast<Eigen::Index>(axis)],
                  0.51 * scene.size / 65535);
    }
  }
}

TEST(Scene, KeepsNormalsToADegree) {
  const PointCloud cloud = random_cloud(500);
  const Scene scene = make_scene(cloud, 1000);
  const auto bytes = decode(scene.normals);
  ASSERT_EQ(bytes.size(), 1000u);
  for (std::size_t k = 0; k < 500; ++k) {
    const double u = bytes[2 * k] / 127.5 - 1, v = bytes[2 * k + 1] / 127.5 - 1;
    Vec3 n(u, v, 1 - std::abs(u) - std::abs(v));
    if (n.z() < 0)
      n = Vec3((1 - std::abs(v)) * (u < 0 ? -1 : 1), (1 - std::abs(u)) * (v < 0 ? -1 : 1), n.z());
    EXPECT_GT(n.normalized().dot(cloud.normals[scene.shown[k]]), std::cos(M_PI / 180));
  }
}

TEST(Scene, SamplesTheSamePointsInAnyOrder) {
  PointCloud cloud = random_cloud(400);
  const Scene scene = make_scene(cloud, 100);
  EXPECT_EQ(scene.shown.size(), 100u);
  std::vector<std::size_t> order(400);
  std::iota(order.begin(), order.end(), 0);
  Random(9).shuffle(std::span(order));
  PointCloud shuffled;
  for (const std::size_t i : order) {
    shuffled.positions.push_back(cloud.positions[i]);
    shuffled.normals.push_back(cloud.normals[i]);
    shuffled.labels.push_back(cloud.labels[i]);
  }
  const Scene again = make_scene(shuffled, 100);
  EXPECT_EQ(again.positions, scene.positions);
  EXPECT_EQ(again.normals, scene.normals);
  EXPECT_EQ(pack_classes(shuffled.labels, again.shown), pack_classes(cloud.labels, scene.shown));
}

TEST(Scene, PrefixesAreSamplesOfTheWhole) {
  const PointCloud cloud = random_cloud(20000);
  const Scene scene = make_scene(cloud, 2000);
  Vec3 mean = Vec3::Zero(), expected = Vec3::Zero();
  for (const std::size_t i : scene.shown) mean += cloud.positions[i] / 2000.0;
  for (const Vec3& p : cloud.positions) expected += p / 20000.0;
  EXPECT_LT((mean - expected).norm(), 0.05);  // four standard errors of the widest axis
}

TEST(Scene, LeavesOutPositionsThatAreNotFinite) {
  PointCloud cloud = random_cloud(50);
  cloud.positions[7].y() = std::numeric_limits<double>::quiet_NaN();
  const Scene scene = make_scene(cloud, 100);
  EXPECT_EQ(scene.shown.size(), 49u);
  EXPECT_EQ(std::count(scene.shown.begin(), scene.shown.end(), 7u), 0);
  for (Vec3& p : cloud.positions) p.x() = std::numeric_limits<double>::infinity();
  EXPECT_ERROR(ErrorKind::kInsufficient, make_scene(cloud, 100));
  EXPECT_ERROR(ErrorKind::kInsufficient, make_scene({}, 100));
}

TEST(Scene, TakesOnePointDuplicatesAndCloudsWithoutNormals) {
  PointCloud cloud;
  cloud.positions.assign(1, Vec3(1, 2, 3));
  EXPECT_EQ(decode(make_scene(cloud, 9).positions), std::vector<std::uint8_t>(6, 0));
  cloud.positions.assign(40, Vec3(1, 2, 3));
  EXPECT_EQ(make_scene(cloud, 9).shown.size(), 9u);
}

TEST(Scene, PacksTwoClassesInAByte) {
  const std::vector<std::uint8_t> classes = {2, 3, 1, 255, 7, 1};
  const std::vector<std::size_t> shown = {0, 2, 1, 3, 5};
  EXPECT_EQ(decode(pack_classes(classes, shown)),
            (std::vector<std::uint8_t>{2 | 1 << 4, 3 | 4 << 4, 1}));
}

}  // namespace
}  // namespace pcednet::report
