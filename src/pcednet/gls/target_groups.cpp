#include "pcednet/gls/target_groups.h"

#include <algorithm>
#include <vector>

#include "pcednet/core/parallel.h"

namespace pcednet::gls {
namespace {

constexpr std::size_t kSmallest = 8;

struct Member {
  Vec3 position;
  std::uint32_t place, index;  ///< place in the curve order decides between equal coordinates
};

void arrange(std::span<Member> members) {
  if (members.size() <= kSmallest) {
    std::sort(members.begin(), members.end(),
              [](const Member& a, const Member& b) { return a.place < b.place; });
    return;
  }
  Vec3 min = members.front().position, max = min;
  for (const Member& member : members) {
    min = min.cwiseMin(member.position);
    max = max.cwiseMax(member.position);
  }
  Eigen::Index axis;
  (0.5 * max - 0.5 * min).maxCoeff(&axis);
  const std::size_t runs = (members.size() + kSmallest - 1) / kSmallest;
  const std::size_t half = (runs + 1) / 2 * kSmallest;
  std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(half),
                   members.end(), [axis](const Member& a, const Member& b) {
                     const double pa = a.position[axis], pb = b.position[axis];
                     return pa != pb ? pa < pb : a.place < b.place;
                   });
  arrange(members.first(half));
  arrange(members.subspan(half));
}

}  // namespace

void arrange_in_groups(std::span<const Vec3> positions, std::span<std::uint32_t> order) {
  parallel_blocks(order.size(), kPointsTogether, [&](std::size_t begin, std::size_t end) {
    std::vector<Member> members;
    members.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      members.push_back({positions[order[i]], static_cast<std::uint32_t>(i), order[i]});
    }
    arrange(members);
    for (std::size_t i = begin; i < end; ++i) order[i] = members[i - begin].index;
  });
}

}  // namespace pcednet::gls
