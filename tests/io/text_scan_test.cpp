#include "pcednet/io/text_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "pcednet/core/random.h"

namespace pcednet::io {
namespace {

TEST(TextScan, DecodesUtf16) {
  const std::u16string units = u"a\u00F6\u20AC\U0001F30D\n";
  const std::string utf8 = "a\xC3\xB6\xE2\x82\xAC\xF0\x9F\x8C\x8D\n";
  const auto bytes_of = [](std::u16string_view text, bool little) {
    std::string bytes = little ? "\xFF\xFE" : "\xFE\xFF";
    for (const char16_t unit : text) {
      const char low = static_cast<char>(unit & 0xFF), high = static_cast<char>(unit >> 8);
      bytes += {little ? low : high, little ? high : low};
    }
    return bytes;
  };
  for (const bool little : {true, false}) {
    EXPECT_EQ(in_utf8(bytes_of(units, little)), utf8);
    EXPECT_EQ(in_utf8(bytes_of(units, little) + "x"), utf8) << "half a unit is left out";
    const std::u16string halves = {0xD83C, u'a', 0xDF0D, 0xD83C};
    EXPECT_EQ(in_utf8(bytes_of(halves, little)),
              "\xEF\xBF\xBD"
              "a\xEF\xBF\xBD\xEF\xBF\xBD");
  }
  EXPECT_EQ(in_utf8(utf8), utf8);
}

TEST(TextScan, ParsesNumbersAsTheStandardLibraryDoes) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const double value = random.normal() * std::pow(10.0, random.uniform(-300, 300));
    char text[64];
    std::snprintf(text, sizeof text, i % 2 ? "%.17g" : "%.5e", value);
    EXPECT_EQ(parse_double(text), std::strtod(text, nullptr)) << text;
    float single = 0;
    std::byte bytes[4];
    const bool fits = std::isfinite(std::strtof(text, nullptr));
    EXPECT_EQ(parse_number(text, ScalarType::kFloat32, bytes), fits) << text;
    std::memcpy(&single, bytes, sizeof single);
    if (fits) {
      EXPECT_EQ(single, std::strtof(text, nullptr)) << text;
    }
  }
}

TEST(TextScan, KnowsWhatIsANumber) {
  EXPECT_EQ(parse_double("+1.5"), 1.5);
  EXPECT_EQ(parse_double("1e-999"), 0.0);
  EXPECT_EQ(parse_double("-1E-999"), 0.0);
  EXPECT_TRUE(std::isnan(*parse_double("nan")));
  EXPECT_TRUE(std::isnan(*parse_double("-NaN")));
  EXPECT_EQ(parse_double("-inf"), -INFINITY);
  for (const char* bad : {"", "+", "-", "+-1", "1,5", "1.5x", "x", "0x10", "1e999", "1e", "1 2"}) {
    EXPECT_FALSE(parse_double(bad)) << bad;
  }
  std::byte number[8];
  EXPECT_TRUE(parse_number("255", ScalarType::kUint8, number));
  EXPECT_TRUE(parse_number("255.0", ScalarType::kUint8, number));
  EXPECT_TRUE(parse_number("-128", ScalarType::kInt8, number));
  EXPECT_TRUE(parse_number("18446744073709551615", ScalarType::kUint64, number));
  for (const char* bad : {"256", "-1", "1.5", "nan", "1e300", ""}) {
    EXPECT_FALSE(parse_number(bad, ScalarType::kUint8, number)) << bad;
  }
  EXPECT_FALSE(parse_number("18446744073709551616", ScalarType::kUint64, number));
  EXPECT_FALSE(parse_number("9223372036854775808", ScalarType::kInt64, number));
  EXPECT_FALSE(parse_count("-1"));
  EXPECT_FALSE(parse_count("+1"));
}

TEST(TextScan, FindsLinesAndFields) {
  Lines lines("a\r\n\nb b", 10);
  std::string_view line;
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, "a");
  EXPECT_EQ(lines.number(), 11u);
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, "");
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, "b b");
  EXPECT_EQ(lines.number(), 13u);
  EXPECT_FALSE(lines.next(line));
  std::vector<std::string_view> fields;
  split(" \ta,b  c, ", fields);
  EXPECT_EQ(fields, (std::vector<std::string_view>{"a,b", "c,"}));
  split(" \ta,b  c, ", fields, Separators(" ,\t"));
  EXPECT_EQ(fields, (std::vector<std::string_view>{"a", "b", "c"}));
}

}  // namespace
}  // namespace pcednet::io
