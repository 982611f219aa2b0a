#include "pcednet/spatial/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"

namespace pcednet::spatial {
namespace {

TEST(RadixSort, SortsAsTheStableSortOfTheStandardLibrary) {
  for (const int bits : {1, 11, 12, 38, 63}) {
    for (const std::size_t count : {0, 1, 2, 1000, 300000}) {
      Random random(1, static_cast<std::uint64_t>(bits));
      std::vector<Keyed> keyed(count);
      for (std::size_t i = 0; i < count; ++i) {
        std::uint64_t key = random.next() >> (64 - bits);
        if (i % 3 == 1) key &= 0xffff;                          // many with the same high bits
        if (i % 3 == 2) key = key >> (bits / 2) << (bits / 2);  // and the same low bits
        keyed[i] = {key, static_cast<std::uint32_t>(i)};
      }
      std::vector<Keyed> expected = keyed;
      std::stable_sort(expected.begin(), expected.end(),
                       [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
      for (const int threads : {1, 3}) {
        std::vector<Keyed> sorted = keyed;
        set_thread_count(threads);
        sort_by_key(sorted, bits);
        set_thread_count(0);
        EXPECT_TRUE(std::equal(
            sorted.begin(), sorted.end(), expected.begin(), expected.end(),
            [](const Keyed& a, const Keyed& b) { return a.key == b.key && a.index == b.index; }))
            << bits << " bits, " << count << " keys, " << threads << " threads";
      }
    }
  }
}

}  // namespace
}  // namespace pcednet::spatial
