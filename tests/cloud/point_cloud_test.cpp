#include "pcednet/cloud/point_cloud.h"

#include <cmath>

#include "cloud/not_finite.h"
#include "pcednet/core/random.h"
#include "support/expect_error.h"

namespace pcednet {
namespace {

std::vector<Attribute> axes(const std::vector<Vec3>& vectors) {
  std::vector<Attribute> found;
  for (const int axis : {0, 1, 2}) {
    std::vector<double> numbers;
    for (const Vec3& vector : vectors) numbers.push_back(vector[axis]);
    found.push_back(make_attribute(std::string("n") + "xyz"[axis], numbers));
  }
  return found;
}

TEST(PointCloud, FindsReplacesAndErasesAttributesByName) {
  PointCloud cloud;
  EXPECT_EQ(find_attribute(cloud, "a"), nullptr);
  set_attribute(cloud, make_attribute("a", std::vector<float>{1}));
  set_attribute(cloud, make_attribute("b", std::vector<float>{2}));
  set_attribute(cloud, make_attribute("a", std::vector<std::uint8_t>{3}));
  ASSERT_EQ(cloud.attributes.size(), 2u);
  EXPECT_EQ(cloud.attributes[0].name, "a") << "a replaced attribute keeps its place";
  EXPECT_EQ(find_attribute(cloud, "a")->value(0), 3.0);
  EXPECT_EQ(find_attribute(cloud, "a")->type, ScalarType::kUint8);
  EXPECT_EQ(find_attribute(cloud, "b")->value(0), 2.0);
  EXPECT_EQ(find_attribute(cloud, "ab"), nullptr);
  erase_attribute(cloud, "a");
  erase_attribute(cloud, "ab");
  ASSERT_EQ(cloud.attributes.size(), 1u);
  EXPECT_EQ(cloud.attributes[0].name, "b");
}

TEST(PointCloud, MakesNormalsUnitHoweverShortOrLong) {
  PointCloud cloud;
  const Vec3 direction = Vec3(1, -2, 2) / 3;
  const double lengths[] = {1, 3e-300, 5e300, 1e-30, 12};
  for (const double length : lengths) cloud.normals.push_back(length * direction);
  EXPECT_EQ(make_normals_unit(cloud), 0u);
  for (const Vec3& normal : cloud.normals) EXPECT_LT((normal - direction).norm(), 1e-15);

  cloud.normals = {{0, 0, 0}, {kNan, 1, 0}, {0, 0, 2}, {1, -kInfinity, 0}};
  EXPECT_EQ(make_normals_unit(cloud), 3u);
  EXPECT_EQ(cloud.normals, (std::vector<Vec3>{{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}}));
}

TEST(PointCloud, KnowsWhetherItsNormalsAreThoseOfTheFile) {
  PointCloud cloud;
  const std::vector<Vec3> stored = {{3, 0, 4}, {0, -7, 0}, {0, 0, 0}};
  cloud.positions.resize(3);
  cloud.stored_normals = axes(stored);
  EXPECT_FALSE(normals_are_stored(cloud)) << "no normals";
  cloud.normals = stored;
  make_normals_unit(cloud);
  EXPECT_TRUE(normals_are_stored(cloud));
  EXPECT_EQ(stored_normal(cloud, 0), stored[0]);
  EXPECT_EQ(stored_normal(cloud, 1), stored[1]);

  PointCloud other = cloud;
  other.normals.back() = Vec3(0, 0, 1);
  EXPECT_FALSE(normals_are_stored(other)) << "the last was changed";
  other = cloud;
  other.stored_normals.pop_back();
  EXPECT_FALSE(normals_are_stored(other)) << "two axes";
  other = cloud;
  other.stored_normals = axes({{3, 0, 4}, {0, -7, 0}});
  EXPECT_FALSE(normals_are_stored(other)) << "of two points";
}

TEST(PointCloud, SaysWhereEachPointWasSeenFrom) {
  PointCloud cloud;
  cloud.positions.resize(4);
  const auto scans = [](std::vector<std::int16_t> numbers) {
    return make_attribute("scan", std::move(numbers));
  };
  EXPECT_TRUE(scanner_of_points(cloud).empty());
  cloud.scanners = {Vec3(1, 2, 3)};
  EXPECT_EQ(scanner_of_points(cloud), std::vector<Vec3>(4, Vec3(1, 2, 3)));
  cloud.scanners.push_back(Vec3(4, 5, 6));
  EXPECT_TRUE(scanner_of_points(cloud).empty()) << "which of the two?";

  set_attribute(cloud, scans({1, 0, 2, -1}));
  const auto places = scanner_of_points(cloud);
  ASSERT_EQ(places.size(), 4u);
  EXPECT_EQ(places[0], Vec3(4, 5, 6));
  EXPECT_EQ(places[1], Vec3(1, 2, 3));
  EXPECT_TRUE(places[2].array().isNaN().all()) << "there is no third scanner";
  EXPECT_TRUE(places[3].array().isNaN().all());

  set_attribute(cloud, scans({2, 2, 2, 2}));
  EXPECT_TRUE(scanner_of_points(cloud).empty()) << "known of no point";
  set_attribute(cloud, scans({1, 1, 1, 1}));
  cloud.scanners[1].x() = kNan;
  EXPECT_TRUE(scanner_of_points(cloud).empty()) << "the only scanner used is unknown";
  cloud.scanners = {Vec3::Constant(kNan)};
  EXPECT_TRUE(scanner_of_points(cloud).empty());
}

TEST(Defects, AreCountedOneByOne) {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}, {kNan, 0, 0}, {1, 0, 0}, {0, kInfinity, 0}, {kNan, 0, 0}};
  cloud.normals = {{0, 0, 1}, {0, 0, 0}, {kNan, 0, 1}, {0, 1, 0}, {0, -kInfinity, 0}};
  const Defects defects = find_defects(cloud);
  EXPECT_EQ(defects.positions, 3u);
  EXPECT_EQ(defects.normals, 3u);
  EXPECT_EQ(defects.duplicates, 0u) << "what is not finite equals nothing";
  const Defects none = find_defects({});
  EXPECT_EQ(none.positions + none.normals + none.duplicates, 0u);
}

TEST(Defects, SeeDuplicatesWhereverTheyAre) {
  const auto duplicates = [](const std::vector<Vec3>& positions) {
    PointCloud cloud;
    cloud.positions = positions;
    return find_defects(cloud).duplicates;
  };
  EXPECT_EQ(duplicates({{1, 2, 3}}), 0u);
  EXPECT_EQ(duplicates({{1, 2, 3}, {1, 2, 3}}), 1u);
  EXPECT_EQ(duplicates({{1, 2, 3}, {0, 0, 0}, {1, 2, 3}, {1, 2, 3}}), 2u);
  EXPECT_EQ(duplicates({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}), 1u) << "the least position";
  EXPECT_EQ(duplicates({{1, 0, 0}, {0, 0, 0}, {1, 0, 0}}), 1u) << "the greatest position";
  EXPECT_EQ(duplicates({{0.0, 1, 2}, {-0.0, 1, 2}}), 1u) << "both zeros are one place";
  EXPECT_EQ(duplicates({{1, 2, 3}, {1, 2, 4}, {1, 3, 3}, {2, 2, 3}}), 0u);
}

TEST(Defects, SeeAsManyDuplicatesAsComparingAllPairs) {
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    PointCloud cloud;
    std::size_t expected = 0;
    for (std::size_t i = 0; i < 60; ++i) {
      const auto coordinate = [&] { return static_cast<double>(random.index(3)); };
      const Vec3 position(coordinate(), coordinate(), coordinate());
      for (const Vec3& earlier : cloud.positions) {
        if (earlier == position) {
          ++expected;
          break;
        }
      }
      cloud.positions.push_back(position);
    }
    ASSERT_EQ(find_defects(cloud).duplicates, expected) << "trial " << trial;
  }
}

TEST(PointCloud, IsConsistentWhenEveryPointHasAsMuchAsTheOthers) {
  PointCloud whole;
  whole.positions.resize(3);
  EXPECT_NO_THROW(check_consistent(whole)) << "nothing but positions";
  whole.normals.resize(3);
  whole.colours.resize(3);
  whole.labels.resize(3);
  whole.attributes = {make_attribute("a", std::vector<float>(3)),
                      make_attribute("b", std::vector<std::uint8_t>(6))};
  whole.attributes[1].components = 2;
  EXPECT_NO_THROW(check_consistent(whole));
  const auto broken = [&](auto&& damage) {
    PointCloud cloud = whole;
    damage(cloud);
    return cloud;
  };
  EXPECT_ERROR(ErrorKind::kUsage,
               check_consistent(broken([](PointCloud& c) { c.normals.pop_back(); })));
  EXPECT_ERROR(ErrorKind::kUsage,
               check_consistent(broken([](PointCloud& c) { c.colours.resize(4); })));
  EXPECT_ERROR(ErrorKind::kUsage,
               check_consistent(broken([](PointCloud& c) { c.labels.resize(1); })));
  EXPECT_ERROR(ErrorKind::kUsage,
               check_consistent(broken([](PointCloud& c) { c.attributes[0].bytes.clear(); })));
  EXPECT_ERROR(ErrorKind::kUsage,
               check_consistent(broken([](PointCloud& c) { c.attributes[1].components = 1; })));
  EXPECT_ERROR(ErrorKind::kUsage,
               check_consistent(broken([](PointCloud& c) { c.positions.clear(); })));
}

}  // namespace
}  // namespace pcednet
