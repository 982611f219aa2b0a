#include "pcednet/core/json.h"

#include <gtest/gtest.h>

#include <limits>

namespace pcednet {
namespace {

TEST(Json, SortsMembersOrKeepsTheirOrder) {
  const char* const text = R"({"b":1,"a":[2,3]})";
  EXPECT_EQ(to_text(parse_ordered_json(text)), text);
  EXPECT_EQ(to_text(parse_json(text)), R"({"a":[2,3],"b":1})");
  EXPECT_EQ(to_text(parse_json(R"({"a":1})"), 2), "{\n  \"a\": 1\n}");
}

TEST(Json, RefusesWhatIsNotJson) {
  EXPECT_THROW(parse_json(""), Json::parse_error);
  EXPECT_THROW(parse_ordered_json("{\"a\":}"), Json::parse_error);
}

TEST(Json, SaysWhatIsWrongInWords) {
  try {
    parse_json("[]").at(3);
    FAIL();
  } catch (const Json::exception& error) {
    EXPECT_EQ(words_of(error), "array index 3 is out of range");
  }
}

TEST(Json, RefusesOrReplacesBytesThatAreNotUtf8) {
  const Json name = "caf\xE9.ply";
  EXPECT_THROW(to_text(name), Json::type_error);
  EXPECT_EQ(to_text(name, -1, NotUtf8::kReplace), "\"caf\xEF\xBF\xBD.ply\"");
  EXPECT_EQ(as_utf8("caf\xE9.ply"), "caf\xEF\xBF\xBD.ply");
  EXPECT_EQ(as_utf8("caf\xC3\xA9 \"1\".ply"), "caf\xC3\xA9 \"1\".ply");
}

TEST(Json, WritesNumbersThatAreNotFiniteAsNull) {
  EXPECT_EQ(to_text(Json(std::numeric_limits<double>::quiet_NaN())), "null");
}

}  // namespace
}  // namespace pcednet
