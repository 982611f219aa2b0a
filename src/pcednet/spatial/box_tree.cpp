#include "pcednet/spatial/box_tree.h"

#include <cmath>
#include <utility>

#include "pcednet/core/parallel.h"

namespace pcednet::spatial {
namespace {

/// The largest offset, or nearly, that does not lead from `corner` beyond `value`.
float at_most(double corner, double value) {
  auto offset = static_cast<float>(value - corner);
  while (corner + offset > value) {
    offset = std::nextafter(offset, -std::numeric_limits<float>::infinity());
  }
  return offset;
}

float at_least(double corner, double value) {
  return -at_most(-corner, -value);
}

}  // namespace

BoxTree::RunBox BoxTree::within(const Box& family, const Box& run) {
  RunBox box;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    box.min[axis] = at_most(family.min[a], run.min[a]);
    box.max[axis] = at_least(family.min[a], run.max[a]);
  }
  return box;
}

void BoxTree::make(const std::function<Box(std::size_t)>& box_of_run) {
  constexpr std::size_t kFamily = kLeaf * kFanOut;  // items
  runs_.resize((count_ + kLeaf - 1) / kLeaf);
  std::vector<Box> families((count_ + kFamily - 1) / kFamily);
  parallel_blocks(families.size(), 128, [&](std::size_t begin, std::size_t end) {
    std::array<Box, kFanOut> boxes;
    for (std::size_t family = begin; family < end; ++family) {
      const std::size_t first = family * kFanOut, last = std::min(first + kFanOut, runs_.size());
      for (std::size_t run = first; run < last; ++run) {
        boxes[run - first] = box_of_run(run);
        families[family].grow(boxes[run - first]);
      }
      for (std::size_t run = first; run < last; ++run) {
        runs_[run] = within(families[family], boxes[run - first]);
      }
    }
  });
  rows_.push_back(std::move(families));
  while (rows_.back().size() > kFanOut) {
    const std::vector<Box>& finer = rows_.back();
    std::vector<Box> row((finer.size() + kFanOut - 1) / kFanOut);
    for (std::size_t i = 0; i < finer.size(); ++i) row[i / kFanOut].grow(finer[i]);
    rows_.push_back(std::move(row));
  }
}

void BoxTree::runs_near(const Vec3& min, const Vec3& max, double distance,
                        std::vector<std::uint32_t>& runs) const {
  const Box wanted = {min, max};
  const double sq_distance = distance * distance;
  std::vector<std::pair<std::size_t, std::size_t>> stack;  // row, number
  const auto push = [&](std::size_t row, std::size_t begin, std::size_t end) {
    // Backwards, so that boxes come off the stack in their order.
    for (std::size_t b = std::min(end, boxes(row)); b > begin; --b) {
      if (box(row, b - 1).sq_gap(wanted) < sq_distance) stack.emplace_back(row, b - 1);
    }
  };
  if (count_ == 0) return;
  push(row_count() - 1, 0, rows_.back().size());
  while (!stack.empty()) {
    const auto [row, i] = stack.back();
    stack.pop_back();
    if (row == 0) {
      runs.push_back(static_cast<std::uint32_t>(i));
    } else {
      push(row - 1, i * kFanOut, (i + 1) * kFanOut);
    }
  }
}

}  // namespace pcednet::spatial
