#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

#include "pcednet/core/large_pages.h"

namespace pcednet {

/// An array whose values are undefined until they are written, for results that threads fill in:
/// unlike a std::vector, one thread need not visit all of its memory first.
template <typename Value>
class UnsetArray {
  static_assert(std::is_trivially_destructible_v<Value>);

 public:
  UnsetArray() = default;
  explicit UnsetArray(std::size_t size)
      : values_(std::make_unique_for_overwrite<Value[]>(size)), size_(size) {
    prefer_large_pages(data(), size * sizeof(Value));
  }
  UnsetArray(UnsetArray&& other) noexcept { *this = std::move(other); }
  UnsetArray& operator=(UnsetArray&& other) noexcept {
    values_ = std::move(other.values_);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }

  std::size_t size() const { return size_; }
  Value* data() { return values_.get(); }
  const Value* data() const { return values_.get(); }
  Value& operator[](std::size_t i) { return values_[i]; }
  const Value& operator[](std::size_t i) const { return values_[i]; }
  Value* begin() { return data(); }
  Value* end() { return data() + size_; }
  const Value* begin() const { return data(); }
  const Value* end() const { return data() + size_; }

 private:
  std::unique_ptr<Value[]> values_;
  std::size_t size_ = 0;
};

}  // namespace pcednet
