#include "pcednet/spatial/radix_sort.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "pcednet/core/parallel.h"
#include "pcednet/core/unset_array.h"

namespace pcednet::spatial {
namespace {

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
constexpr int kHighBits = 3 * kDigitBits;  // distinguish most of millions of keys
constexpr std::ptrdiff_t kLongRun = 4096;
using Histogram = std::array<std::size_t, kDigits>;

std::size_t digit(const Keyed& keyed, int shift) {
  return (keyed.key >> shift) & (kDigits - 1);
}

/// Turns counts per block and digit into the places where each block writes each digit. False if
/// all have one digit, so that nothing needs to move.
bool make_places(std::vector<Histogram>& histograms, std::size_t size) {
  std::size_t place = 0;
  for (std::size_t d = 0; d < kDigits; ++d) {
    const std::size_t before = place;
    for (Histogram& histogram : histograms) {
      const std::size_t count = histogram[d];
      histogram[d] = place;
      place += count;
    }
    if (place - before == size) return false;
  }
  return true;
}

/// Sorts by the bits [low, high) of the keys.
void sort_digits(std::span<Keyed> keyed, int low, int high) {
  const std::size_t block = std::max<std::size_t>(keyed.size() / 64 + 1, 1 << 16);
  std::vector<Histogram> histograms((keyed.size() + block - 1) / block);
  UnsetArray<Keyed> room(keyed.size());
  Keyed *from = keyed.data(), *to = room.data();
  for (int shift = low; shift < high; shift += kDigitBits) {
    parallel_blocks(keyed.size(), block, [&](std::size_t begin, std::size_t end) {
      Histogram& histogram = histograms[begin / block];
      histogram.fill(0);
      for (std::size_t i = begin; i < end; ++i) ++histogram[digit(from[i], shift)];
    });
    if (!make_places(histograms, keyed.size())) continue;
    parallel_blocks(keyed.size(), block, [&](std::size_t begin, std::size_t end) {
      Histogram& places = histograms[begin / block];
      for (std::size_t i = begin; i < end; ++i) {
        to[places[digit(from[i], shift)]++] = from[i];
      }
    });
    std::swap(from, to);
  }
  if (from == keyed.data()) return;
  parallel_blocks(keyed.size(), block, [&](std::size_t begin, std::size_t end) {
    std::copy(from + begin, from + end, keyed.data() + begin);
  });
}

/// Sorts keys with equal upper bits by the lowest `low` bits.
void sort_runs(std::span<Keyed> keyed, int low) {
  for (auto first = keyed.begin(); first != keyed.end();) {
    const auto last = std::find_if(
        first + 1, keyed.end(), [&](const Keyed& k) { return k.key >> low != first->key >> low; });
    if (last - first > kLongRun) {
      sort_digits({first, last}, 0, low);
    } else if (last - first > 1) {
      std::stable_sort(first, last, [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    }
    first = last;
  }
}

}  // namespace

void sort_by_key(std::span<Keyed> keyed, int bits) {
  const int low = std::max(0, bits - kHighBits);
  sort_digits(keyed, low, bits);
  if (low > 0) sort_runs(keyed, low);
}

}  // namespace pcednet::spatial
