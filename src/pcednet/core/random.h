#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace pcednet {

/// A stream of pseudo-random numbers (splitmix64). Unlike the distributions of the standard library
/// it gives the same numbers for the same seed on every platform.
class Random {
 public:
  /// Streams of one seed with different `stream` are independent of each other.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
      : state_(mix(seed + 0x9E3779B97F4A7C15ull * (2 * stream + 1))) {}

  std::uint64_t next() { return mix(state_ += 0x9E3779B97F4A7C15ull); }

  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// In [0, count); `count` must be positive.
  std::size_t index(std::size_t count) {
    return static_cast<std::size_t>((static_cast<unsigned __int128>(next()) * count) >> 64);
  }

  /// Mean 0, standard deviation 1: the sum of twelve uniforms (Irwin-Hall), which needs only
  /// additions and so has the same bits everywhere; its tails end at 6.
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

  template <typename T>
  void shuffle(std::span<T> values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[index(i)]);
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace pcednet
