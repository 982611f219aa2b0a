#include "pcednet/core/simd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcednet {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Sixteen numbers of every kind, from an address that is not aligned.
struct Numbers {
  char before = 0;
  std::array<float, 17> values = {9.0f,      -2.5f,      kNaN,    0.0f,  -0.0f, 1.0f,
                                  0.75f,     3.0f,       -1e-30f, 1e30f, 4.0f,  -7.0f,
                                  kInfinity, -kInfinity, 2.0f,    -1.0f, 0.5f};
  const float* first() const { return values.data() + 1; }
};

template <int W>
void expect_each(const Numbers& numbers) {
  for (int start = 0; start < 16; start += W) {
    const float* from = numbers.first() + start;
    const Floats<W> v = load<W>(from);
    std::array<float, W> raised, lowered, positive, size, root;
    store(raised.data(), at_least(v, -2.0f)), store(lowered.data(), at_most(v, 0.8f));
    store(positive.data(), positive_part(v)), store(size.data(), absolute(v));
    store(root.data(), square_root(absolute(v)));
    const unsigned below = bits_below(v, splat<W>(0.6f));
    bool any = false;
    for (int i = 0; i < W; ++i) {
      const float x = from[i];
      const auto at = static_cast<std::size_t>(i);
      EXPECT_EQ(raised[at], x > -2.0f ? x : -2.0f) << x;
      EXPECT_EQ(lowered[at], x < 0.8f ? x : 0.8f) << x;
      EXPECT_EQ(positive[at], x > 0.0f ? x : 0.0f) << x;
      EXPECT_FALSE(std::signbit(positive[at])) << x;
      EXPECT_FALSE(std::signbit(size[at])) << x;
      EXPECT_EQ(below >> i & 1, x < 0.6f ? 1u : 0u) << x;
      if (std::isnan(x)) continue;
      EXPECT_EQ(size[at], std::abs(x));
      EXPECT_EQ(root[at], std::sqrt(std::abs(x)));
      any = any || x > 0.0f;
    }
    EXPECT_EQ(any_positive(v), any);
    EXPECT_FALSE(any_positive(splat<W>(0.0f)));
  }
}

TEST(Simd, ComputesWhatScalarsDo) {
  const Numbers numbers;
  expect_each<4>(numbers);
  expect_each<8>(numbers);
  expect_each<16>(numbers);
}

TEST(Simd, AddsLanesByHalves) {
  // Sums that depend on the order: 1e8 swallows a 1 that is added to it alone.
  constexpr float v[16] = {1e8f, 1, 2, 3, 4, 5, 6, 7, -1e8f, 9, 10, 11, 12, 13, 14, 15};
  const auto halves = [](const float* x, int width) {
    std::array<float, 16> sums{};
    std::copy_n(x, width, sums.begin());
    for (; width > 1; width /= 2) {
      for (int i = 0; i < width / 2; ++i) {
        sums[static_cast<std::size_t>(i)] += sums[static_cast<std::size_t>(i + width / 2)];
      }
    }
    return sums[0];
  };
  EXPECT_EQ(sum_of_lanes(load<4>(v)), halves(v, 4));
  EXPECT_EQ(sum_of_lanes(load<8>(v)), halves(v, 8));
  EXPECT_EQ(sum_of_lanes(load<16>(v)), halves(v, 16));
  EXPECT_EQ(halves(v, 16), 112.0f);
}

}  // namespace
}  // namespace pcednet
