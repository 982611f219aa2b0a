#include "pcednet/cloud/attribute.h"

#include <gtest/gtest.h>

#include <limits>

namespace pcednet {
namespace {

template <typename T>
class AttributeOf : public testing::Test {};

using NumberTypes =
    testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t,
                   std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(AttributeOf, NumberTypes);

TYPED_TEST(AttributeOf, ThisTypeGivesItsNumbersBack) {
  using Limits = std::numeric_limits<TypeParam>;
  const std::vector<TypeParam> numbers = {0, 1, Limits::lowest(), Limits::max(), 42};
  const Attribute attribute = make_attribute("depth", numbers);
  EXPECT_EQ(attribute.name, "depth");
  EXPECT_EQ(attribute.type, scalar_type_of<TypeParam>());
  EXPECT_EQ(attribute.components, 1u);
  EXPECT_EQ(attribute.stride(), sizeof(TypeParam));
  ASSERT_EQ(attribute.bytes.size(), numbers.size() * sizeof(TypeParam));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_EQ(attribute.value(i), static_cast<double>(numbers[i])) << i;
  }
}

TYPED_TEST(AttributeOf, ThisTypeIsTheOneThatIsVisited) {
  const ScalarType type = scalar_type_of<TypeParam>();
  EXPECT_EQ(size_of(type), sizeof(TypeParam));
  const bool same =
      visit_scalar(type, [](auto zero) { return std::is_same_v<decltype(zero), TypeParam>; });
  EXPECT_TRUE(same);
}

TEST(Attribute, MayHoldSeveralNumbersPerPoint) {
  Attribute pairs = make_attribute("uv", std::vector<std::int16_t>{1, -2, 3, -4, 5, -6});
  pairs.components = 2;
  EXPECT_EQ(pairs.stride(), 4u);
  EXPECT_EQ(pairs.value(0, 0), 1.0);
  EXPECT_EQ(pairs.value(1, 1), -4.0);
  EXPECT_EQ(pairs.value(2), 5.0);
}

TEST(Attribute, MayBeOfNoPoint) {
  EXPECT_TRUE(make_attribute("none", std::vector<float>{}).bytes.empty());
}

}  // namespace
}  // namespace pcednet
