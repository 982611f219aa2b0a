#include "pcednet/gls/engine/target_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "pcednet/core/random_vectors.h"

namespace pcednet::gls {
namespace {

struct Member {
  Vec3 position;
  std::uint32_t place, index;
};

/// The definition: halves along the longest side, by sorting.
void halve(std::span<Member> members) {
  if (members.size() <= 8) {
    std::sort(members.begin(), members.end(),
              [](const Member& a, const Member& b) { return a.place < b.place; });
    return;
  }
  Vec3 min = members.front().position, max = min;
  for (const Member& member : members) {
    min = min.cwiseMin(member.position), max = max.cwiseMax(member.position);
  }
  Eigen::Index axis;
  (max - min).maxCoeff(&axis);
  std::sort(members.begin(), members.end(), [&](const Member& a, const Member& b) {
    return std::pair(a.position[axis], a.place) < std::pair(b.position[axis], b.place);
  });
  const std::size_t half = ((members.size() + 7) / 8 + 1) / 2 * 8;
  halve(members.first(half));
  halve(members.subspan(half));
}

std::vector<std::uint32_t> halved(const std::vector<Vec3>& positions) {
  std::vector<Member> members;
  for (std::uint32_t i = 0; i < positions.size(); ++i) members.push_back({positions[i], i, i});
  for (std::size_t begin = 0; begin < members.size(); begin += kPointsTogether) {
    halve(std::span(members).subspan(begin, std::min(kPointsTogether, members.size() - begin)));
  }
  std::vector<std::uint32_t> order;
  for (const Member& member : members) order.push_back(member.index);
  return order;
}

std::vector<std::uint32_t> arranged(const std::vector<Vec3>& positions) {
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  arrange_in_groups(positions, order);
  return order;
}

TEST(TargetGroups, AreHalvesOfHalvesAlongTheLongestSide) {
  Random random(7);
  for (const std::size_t size : {0u, 1u, 8u, 9u, 100u, 4096u, 10001u}) {
    std::vector<Vec3> positions(size);
    for (Vec3& p : positions) p = uniform_vector(random);
    EXPECT_EQ(arranged(positions), halved(positions)) << size;
  }
}

TEST(TargetGroups, LeaveEquallyHighPointsInTheirOrder) {
  Random random(8);
  std::vector<Vec3> positions(6000);
  for (Vec3& p : positions) p = (3.0 * uniform_vector(random)).array().floor();  // few places
  EXPECT_EQ(arranged(positions), halved(positions));
  std::fill(positions.begin(), positions.end(), Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(arranged(positions), halved(positions));
}

TEST(TargetGroups, AreTheSameForSortedPoints) {
  std::vector<Vec3> up, down, tent;
  for (int i = 0; i < 5000; ++i) {
    up.emplace_back(i, 0.0, 0.0), down.emplace_back(-i, 0.0, 0.0);
    tent.emplace_back(i < 2500 ? i : 5000 - i, i % 3, 0.0);
  }
  for (const auto& positions : {up, down, tent}) EXPECT_EQ(arranged(positions), halved(positions));
}

}  // namespace
}  // namespace pcednet::gls
