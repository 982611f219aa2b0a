#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "pcednet/io/cloud_builder.h"

namespace pcednet::io {

/// The numbers of a text, row by row, in blocks: it grows without a copy.
class NumberTable {
 public:
  /// `columns`: numbers in a row.
  explicit NumberTable(std::size_t columns = 0)
      : columns_(columns),
        block_rows_(std::max<std::size_t>(1, kBlockNumbers / std::max<std::size_t>(1, columns))) {}

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  const double* row(std::size_t r) const {
    return blocks_[r / block_rows_].data() + r % block_rows_ * columns_;
  }

  /// Memory for another row, which holds zeros.
  double* add_row() {
    if (rows_ % block_rows_ == 0) blocks_.emplace_back().reserve(block_rows_ * columns_);
    std::vector<double>& block = blocks_.back();
    block.resize(block.size() + columns_);
    ++rows_;
    return &block[block.size() - columns_];
  }

  /// Hands all rows to a builder of as many points, and leaves none.
  void move_to(CloudBuilder& builder) {
    std::size_t begin = 0;
    for (std::vector<double>& block : blocks_) {
      const std::size_t end = std::min(begin + block_rows_, rows_);
      builder.fill_rows(reinterpret_cast<const std::byte*>(block.data()), begin, end);
      block = {};
      begin = end;
    }
    blocks_.clear();
    rows_ = 0;
  }

 private:
  static constexpr std::size_t kBlockNumbers = 1 << 17;

  std::size_t columns_, block_rows_;
  std::size_t rows_ = 0;
  std::vector<std::vector<double>> blocks_ = {};
};

}  // namespace pcednet::io
