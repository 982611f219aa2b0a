#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "pcednet/io/cloud_builder.h"

namespace pcednet::io {

/// Hands rows that arrive one by one to a builder, many at a time.
class RowFeeder {
 public:
  explicit RowFeeder(CloudBuilder& builder)
      : builder_(builder),
        capacity_(std::clamp<std::size_t>(builder.size(), 1, 1024)),
        rows_(capacity_ * builder.row_bytes()) {}

  /// Memory for the next row, which the caller fills before the next call.
  std::byte* next_row() {
    if (used_ == capacity_) flush();
    return rows_.data() + builder_.row_bytes() * used_++;
  }

  /// Must be called after the last row.
  void flush() {
    builder_.fill_rows(rows_.data(), filled_, filled_ + used_);
    filled_ += used_;
    used_ = 0;
  }

 private:
  CloudBuilder& builder_;
  std::size_t capacity_;
  std::vector<std::byte> rows_;
  std::size_t filled_ = 0;  ///< points handed over
  std::size_t used_ = 0;    ///< rows waiting
};

}  // namespace pcednet::io
