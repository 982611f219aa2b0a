#include "pcednet/core/digest.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace pcednet {
namespace {

TEST(Digest, IsTheSameForTheSameContents) {
  const std::string text = "scale-space matrix";
  EXPECT_EQ(Digest().add(text).hex(), Digest().add(text).hex());
  EXPECT_EQ(Digest().add(text).hex().size(), 32u);
  // Pinned: results are kept on disk under such names.
  EXPECT_EQ(Digest().add("").hex(), "f37c8027575f2673b8bbfdd297201b8d");
  EXPECT_EQ(Digest().add(text).hex(), "37b446ae0b661740cc5f856c6bf6a7ef");
}

TEST(Digest, DiffersForEveryChangedBitAndForEveryLength) {
  std::set<std::string> seen;
  std::vector<std::uint8_t> bytes(37, 0);
  for (std::size_t length = 0; length <= bytes.size(); ++length) {
    seen.insert(Digest().add_values(std::span<const std::uint8_t>(bytes).first(length)).hex());
  }
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    seen.insert(Digest().add_values(std::span<const std::uint8_t>(bytes)).hex());
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
  }
  EXPECT_EQ(seen.size(), 38 + 8 * bytes.size());
}

TEST(Digest, DependsOnTheOrderAndOnTheCutsBetweenCalls) {
  EXPECT_NE(Digest().add("a").add("b").hex(), Digest().add("b").add("a").hex());
  EXPECT_NE(Digest().add("ab").hex(), Digest().add("a").add("b").hex());
  EXPECT_NE(Digest().add("ab").add("").hex(), Digest().add("ab").hex());
}

TEST(Digest, ChangesAboutHalfOfItsBitsWithOneOfTheContents) {
  int changed = 0;
  for (std::uint64_t i = 0; i < 64; ++i) {
    const std::uint64_t a = 12345, b = a ^ (std::uint64_t{1} << i);
    const auto x = Digest().add_values(std::span(&a, 1)).lanes();
    const auto y = Digest().add_values(std::span(&b, 1)).lanes();
    for (int lane = 0; lane < 2; ++lane) changed += __builtin_popcountll(x[lane] ^ y[lane]);
  }
  // 64 x 128 fair coins: mean 4096, standard deviation 45.
  EXPECT_NEAR(changed, 4096, 250);
}

}  // namespace
}  // namespace pcednet
