#include "pcednet/spatial/radix_sort.h"

#include <algorithm>
#include <array>

#include "pcednet/core/parallel.h"

namespace pcednet::spatial {
namespace {

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
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

}  // namespace

void sort_by_key(std::vector<Keyed>& keyed, int bits) {
  const std::size_t block = std::max<std::size_t>(keyed.size() / 64 + 1, 1 << 16);
  std::vector<Histogram> histograms((keyed.size() + block - 1) / block);
  std::vector<Keyed> sorted(keyed.size());
  for (int shift = 0; shift < bits; shift += kDigitBits) {
    parallel_blocks(keyed.size(), block, [&](std::size_t begin, std::size_t end) {
      Histogram& histogram = histograms[begin / block];
      histogram.fill(0);
      for (std::size_t i = begin; i < end; ++i) ++histogram[digit(keyed[i], shift)];
    });
    if (!make_places(histograms, keyed.size())) continue;
    parallel_blocks(keyed.size(), block, [&](std::size_t begin, std::size_t end) {
      Histogram& places = histograms[begin / block];
      for (std::size_t i = begin; i < end; ++i) {
        sorted[places[digit(keyed[i], shift)]++] = keyed[i];
      }
    });
    keyed.swap(sorted);
  }
}

}  // namespace pcednet::spatial
