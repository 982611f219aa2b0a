#include "pcednet/spatial/box_tree.h"

namespace pcednet::spatial {

void BoxTree::add_rows() {
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
  std::vector<std::pair<std::size_t, std::size_t>> stack;  // row, box
  const auto push = [&](std::size_t row, std::size_t begin, std::size_t end) {
    // Backwards, so that boxes come off the stack in their order.
    for (std::size_t b = std::min(end, rows_[row].size()); b > begin; --b) {
      if (rows_[row][b - 1].sq_gap(wanted) < sq_distance) stack.emplace_back(row, b - 1);
    }
  };
  if (count_ == 0) return;
  push(rows_.size() - 1, 0, rows_.back().size());
  while (!stack.empty()) {
    const auto [row, box] = stack.back();
    stack.pop_back();
    if (row == 0) {
      runs.push_back(static_cast<std::uint32_t>(box));
    } else {
      push(row - 1, box * kFanOut, (box + 1) * kFanOut);
    }
  }
}

}  // namespace pcednet::spatial
