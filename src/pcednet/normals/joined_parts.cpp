#include "pcednet/normals/joined_parts.h"

#include <atomic>
#include <functional>
#include <numeric>

#include "pcednet/core/parallel_loops.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kRowsAtOnce = 1 << 14;

std::int8_t times(std::int8_t a, std::int8_t b) {
  return static_cast<std::int8_t>(a * b);
}

/// Makes every row join the end of its path; of two rows that join each other, the first.
void join_roots(std::vector<Join>& joins) {
  std::vector<Join> next(joins.size());
  parallel_for_each(joins.size(), [&](std::uint32_t i) {
    const bool is_root = joins[joins[i].to].to == i && i < joins[i].to;
    next[i] = is_root ? Join{i, 1} : joins[i];
  });
  joins.swap(next);
  // Each round doubles the steps of a row.
  for (std::atomic<bool> moved = true; moved;) {
    moved = false;
    parallel_blocks(joins.size(), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
      bool any = false;
      for (std::size_t i = begin; i < end; ++i) {
        const Join& on = joins[joins[i].to];
        any |= on.to != joins[i].to;
        next[i] = {on.to, times(joins[i].sign, on.sign)};
      }
      if (any) moved.store(true, std::memory_order_relaxed);
    });
    joins.swap(next);
  }
}

/// For every root the first row that joins it.
std::vector<std::uint32_t> first_rows(const std::vector<Join>& joins) {
  std::vector<std::uint32_t> first(joins.size());
  std::iota(first.begin(), first.end(), 0u);
  parallel_for_each(joins.size(), [&](std::uint32_t i) {
    const std::atomic_ref of_root(first[joins[i].to]);
    std::uint32_t before = of_root.load(std::memory_order_relaxed);
    while (i < before && !of_root.compare_exchange_weak(before, i, std::memory_order_relaxed)) {
    }
  });
  return first;
}

}  // namespace

Signs follow_joins(std::vector<Join> joins) {
  join_roots(joins);
  const std::vector<std::uint32_t> first = first_rows(joins);
  const auto begins_part = [&](std::uint32_t i) { return first[joins[i].to] == i; };
  const auto begun = counts_before_blocks(joins.size(), kRowsAtOnce, begins_part);

  Signs signs;
  signs.parts = begun.back();
  std::vector<std::uint32_t> of_root(joins.size());
  parallel_blocks(joins.size(), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    auto part = static_cast<std::uint32_t>(begun[begin / kRowsAtOnce]);
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
      if (begins_part(i)) of_root[joins[i].to] = part++;
    }
  });
  signs.part.resize(joins.size());
  signs.sign.resize(joins.size());
  parallel_for_each(joins.size(), [&](std::uint32_t i) {
    signs.part[i] = of_root[joins[i].to];
    signs.sign[i] = times(joins[i].sign, joins[first[joins[i].to]].sign);
  });
  return signs;
}

void join_again(Signs& finer, const Signs& coarser) {
  parallel_for_each(finer.part.size(), [&](std::uint32_t i) {
    const std::uint32_t part = finer.part[i];
    finer.sign[i] = times(finer.sign[i], coarser.sign[part]);
    finer.part[i] = coarser.part[part];
  });
  finer.parts = coarser.parts;
}

}  // namespace pcednet::normals
