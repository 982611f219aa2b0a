#include "pcednet/gls/engine/target_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pcednet/core/parallel.h"
#include "pcednet/core/prefetch.h"

namespace pcednet::gls {
namespace {

constexpr std::size_t kSmallest = 8;

struct Member {
  Vec3 position;
  std::uint32_t index;
};

/// Memory to work in, as large as the members.
struct WorkMemory {
  std::span<double> values;
  std::span<Member> members;
};

/// Moves the values below `bound` to the front and returns their number. Nothing branches on a
/// value: on which side one lies cannot be predicted.
std::size_t move_below(std::span<double> values, double bound) {
  std::size_t below = 0;
  for (double& value : values) {
    const double one = value;
    value = values[below];
    values[below] = one;
    below += one < bound ? 1 : 0;
  }
  return below;
}

/// A value by its rank, and how many are smaller.
struct Ranked {
  double value;
  std::size_t smaller;
};

Ranked of_rank_among_few(std::span<const double> values, std::size_t n) {
  for (const double value : values) {
    std::size_t below = 0, up_to = 0;
    for (const double other : values) {
      below += other < value ? 1 : 0;
      up_to += other <= value ? 1 : 0;
    }
    if (below <= n && n < up_to) return {value, below};
  }
  return {values.front(), 0};
}

/// What would be at `n` if the values were sorted; reorders them.
Ranked of_rank(std::span<double> values, std::size_t n) {
  constexpr std::size_t kFew = 16, kMostTurns = 64;
  const auto all = values;
  std::size_t smaller = 0;  // than all that are left
  const auto skip = [&](std::size_t count) {
    values = values.subspan(count), n -= count, smaller += count;
  };
  for (std::size_t turn = 0; turn < kMostTurns && values.size() > kFew; ++turn) {
    const double a = values.front(), b = values[values.size() / 2], c = values.back();
    const double middle = std::max(std::min(a, b), std::min(std::max(a, b), c));
    const std::size_t below = move_below(values, middle);
    if (n < below) {
      values = values.first(below);
    } else if (below > 0) {
      skip(below);
    } else {  // none is smaller: set apart its equals
      const std::size_t equal =
          move_below(values, std::nextafter(middle, std::numeric_limits<double>::infinity()));
      if (n < equal) return {middle, smaller};
      skip(equal);
    }
  }
  if (values.size() <= kFew) {
    const auto [value, below] = of_rank_among_few(values, n);
    return {value, smaller + below};
  }
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end());
  const double value = values[n];
  return {value, static_cast<std::size_t>(std::count_if(
                     all.begin(), all.end(), [&](double other) { return other < value; }))};
}

Eigen::Index longest_axis(std::span<const Member> members) {
  Vec3 min = members.front().position, max = min;
  for (const Member& member : members) {
    min = min.cwiseMin(member.position);
    max = max.cwiseMax(member.position);
  }
  Eigen::Index axis;
  (0.5 * max - 0.5 * min).maxCoeff(&axis);
  return axis;
}

/// Moves the `half` members that are lowest along an axis to the front, of equally low ones the
/// first. Both parts keep their order.
void divide(std::span<Member> members, std::size_t half, Eigen::Index axis,
            const WorkMemory& memory) {
  const auto values = memory.values.first(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) values[i] = members[i].position[axis];
  const auto [middle, lower] = of_rank(values, half);
  std::size_t at_middle = half - lower;  // of those, which go to the front
  std::size_t front = 0, back = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Member member = members[i];
    const bool is_middle = member.position[axis] == middle && at_middle > 0;
    const bool is_low = member.position[axis] < middle || is_middle;
    at_middle -= is_middle ? 1 : 0;
    members[front] = memory.members[back] = member;
    front += is_low ? 1 : 0;
    back += is_low ? 0 : 1;
  }
  std::copy_n(memory.members.begin(), back, members.begin() + static_cast<std::ptrdiff_t>(front));
}

/// Halves the members, given in the order of the curve, until few are left.
void arrange(std::span<Member> members, const WorkMemory& memory) {
  if (members.size() <= kSmallest) return;
  const std::size_t runs = (members.size() + kSmallest - 1) / kSmallest;
  const std::size_t half = (runs + 1) / 2 * kSmallest;
  divide(members, half, longest_axis(members), memory);
  arrange(members.first(half), memory);
  arrange(members.subspan(half), memory);
}

}  // namespace

void arrange_in_groups(std::span<const Vec3> positions, std::span<std::uint32_t> order) {
  parallel_blocks(order.size(), kPointsTogether, [&](std::size_t begin, std::size_t end) {
    std::vector<Member> members, other_members(end - begin);
    std::vector<double> values(end - begin);
    members.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      if (i + kAskAhead < end) prefetch(positions[order[i + kAskAhead]]);
      members.push_back({positions[order[i]], order[i]});
    }
    arrange(members, {values, other_members});
    for (std::size_t i = begin; i < end; ++i) order[i] = members[i - begin].index;
  });
}

}  // namespace pcednet::gls
