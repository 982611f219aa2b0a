#include "pcednet/tiles/large_facts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <utility>

#include "pcednet/formats/write_cloud.h"
#include "support/own_folder.h"

namespace pcednet::tiles {
namespace {

class LargeFacts : public testing::Test, protected test::OwnFolder {
 protected:
  /// Of a file with so many copies of each place, all of which are read.
  formats::CloudFacts facts_of(const std::vector<Vec3>& places, std::size_t copies) const {
    PointCloud cloud;
    for (const Vec3& place : places) {
      cloud.positions.insert(cloud.positions.end(), copies, place);
    }
    formats::write_cloud(folder_ / "in.ply", cloud, {});
    return large_facts(folder_ / "in.ply", {.large = 1'600'000, .all = true}).value();
  }
};

TEST_F(LargeFacts, TheSpacingIsThatOfThePlaces) {
  std::vector<Vec3> places;
  for (int i = 0; i < 370; ++i) {
    for (int j = 0; j < 370; ++j) places.emplace_back(i, j, 0.0);
  }
  const auto found = facts_of(places, 12).spacing;
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->median, 1.0);
  EXPECT_NEAR(found->mean, (4.0 + 4.0 * std::sqrt(2.0) + 2.0 * 2.0) / 10.0,
              0.02);  // at the rim more
}

TEST_F(LargeFacts, FewerPlacesThanNeighboursHaveNoSpacing) {
  EXPECT_FALSE(facts_of({{0, 0, 0}, {1, 0, 0}, {7, 1e6, 0}, {-1e9, 0, 0}}, 420'000).spacing);
}

TEST_F(LargeFacts, BoundsOfAHeaderThatDoNotHoldThePointsDoNotCount) {
  const std::filesystem::path path = folder_ / "in.las";
  PointCloud cloud;
  for (int i = 0; i < 1'600'000; ++i) cloud.positions.emplace_back(i % 1000 + 500'000, i / 1000, 7);
  formats::write_cloud(path, cloud, {});
  const auto facts_with = [&](double least, double most) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(179);
    for (int axis = 0; axis < 3; ++axis) {
      file.write(reinterpret_cast<const char*>(&most), sizeof most);
      file.write(reinterpret_cast<const char*>(&least), sizeof least);
    }
    file.close();
    return large_facts(path, {.large = 1'000'000}).value();
  };
  EXPECT_EQ(facts_with(-1.0, 1e6).bounds.max, Vec3::Constant(1e6));
  for (const auto& [least, most] : {std::pair(0.0, 0.0), {1e9, -1e9}, {-NAN, NAN}}) {
    const formats::CloudFacts facts = facts_with(least, most);
    EXPECT_EQ(facts.bounds.min, Vec3(500'000, 0, 7));
    EXPECT_NEAR(facts.bounds.max.y(), 1600, 100);  // of the last part of the sample
    ASSERT_EQ(facts.warnings.size(), 1u);
    EXPECT_NE(facts.warnings[0].find("those of the sample"), std::string::npos);
  }
}

}  // namespace
}  // namespace pcednet::tiles
