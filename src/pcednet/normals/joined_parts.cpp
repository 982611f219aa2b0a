#include "pcednet/normals/joined_parts.h"

#include <atomic>
#include <functional>
#include <numeric>

#include "pcednet/core/parallel.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kRowsAtOnce = 1 << 14;

std::int8_t times(std::int8_t a, std::int8_t b) {
  return static_cast<std::int8_t>(a * b);
}

template <typename Work>
void for_each_row(std::size_t rows, const Work& work) {
  parallel_blocks(rows, kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) work(i);
  });
}

/// Makes every row join the one that its way ends in, of two that join each other the first.
void join_roots(std::vector<Join>& joins) {
  std::vector<Join> next(joins.size());
  for_each_row(joins.size(), [&](std::uint32_t i) {
    const bool is_root = joins[joins[i].to].to == i && i < joins[i].to;
    next[i] = is_root ? Join{i, 1} : joins[i];
  });
  joins.swap(next);
  // Each round doubles the steps that a row has gone.
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
  for_each_row(joins.size(), [&](std::uint32_t i) {
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
  std::vector<std::uint32_t> begun((joins.size() + kRowsAtOnce - 1) / kRowsAtOnce + 1);
  for_each_row(joins.size(),
               [&](std::uint32_t i) { begun[i / kRowsAtOnce + 1] += begins_part(i); });
  std::partial_sum(begun.begin(), begun.end(), begun.begin());

  Signs signs;
  signs.parts = begun.back();
  std::vector<std::uint32_t> of_root(joins.size());
  for_each_row(joins.size(), [&](std::uint32_t i) {
    if (begins_part(i)) of_root[joins[i].to] = begun[i / kRowsAtOnce]++;
  });
  signs.part.resize(joins.size());
  signs.sign.resize(joins.size());
  for_each_row(joins.size(), [&](std::uint32_t i) {
    signs.part[i] = of_root[joins[i].to];
    signs.sign[i] = times(joins[i].sign, joins[first[joins[i].to]].sign);
  });
  return signs;
}

void join_again(Signs& finer, const Signs& coarser) {
  for_each_row(finer.part.size(), [&](std::uint32_t i) {
    const std::uint32_t part = finer.part[i];
    finer.sign[i] = times(finer.sign[i], coarser.sign[part]);
    finer.part[i] = coarser.part[part];
  });
  finer.parts = coarser.parts;
}

}  // namespace pcednet::normals
