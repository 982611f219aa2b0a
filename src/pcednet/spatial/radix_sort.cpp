#include "pcednet/spatial/radix_sort.h"

#include <algorithm>
#include <array>

#include "pcednet/core/parallel.h"

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
void sort_digits(std::vector<Keyed>& keyed, int low, int high) {
  const std::size_t block = std::max<std::size_t>(keyed.size() / 64 + 1, 1 << 16);
  std::vector<Histogram> histograms((keyed.size() + block - 1) / block);
  std::vector<Keyed> sorted(keyed.size());
  for (int shift = low; shift < high; shift += kDigitBits) {
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

/// Sorts keys with equal upper bits by the lowest `low` bits.
void sort_runs(std::vector<Keyed>& keyed, int low) {
  for (auto first = keyed.begin(); first != keyed.end();) {
    const auto last = std::find_if(
        first + 1, keyed.end(), [&](const Keyed& k) { return k.key >> low != first->key >> low; });
    if (last - first > kLongRun) {
      std::vector<Keyed> run(first, last);
      sort_digits(run, 0, low);
      std::copy(run.begin(), run.end(), first);
    } else if (last - first > 1) {
      std::stable_sort(first, last, [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    }
    first = last;
  }
}

}  // namespace

void sort_by_key(std::vector<Keyed>& keyed, int bits) {
  const int low = std::max(0, bits - kHighBits);
  sort_digits(keyed, low, bits);
  if (low > 0) sort_runs(keyed, low);
}

}  // namespace pcednet::spatial
