#include "pcednet/io/text/xyz_fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/scratch.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

std::vector<std::string> fields_of(std::string_view line, std::string_view separators = ",;") {
  std::vector<std::string_view> fields;
  split_fields(line, Separators(separators), fields);
  return {fields.begin(), fields.end()};
}

using Strings = std::vector<std::string>;

TEST(XyzFields, AreEmptyWhereNothingIsBetweenSeparators) {
  EXPECT_EQ(fields_of("1 2\t 3"), (Strings{"1", "2", "3"}));
  EXPECT_EQ(fields_of("1,2, 3"), (Strings{"1", "2", "3"}));
  EXPECT_EQ(fields_of("1 ,2 ; 3"), (Strings{"1", "2", "3"}));
  EXPECT_EQ(fields_of("1,,3"), (Strings{"1", "", "3"}));
  EXPECT_EQ(fields_of("1; ;3;"), (Strings{"1", "", "3", ""}));
  EXPECT_EQ(fields_of(",2,3"), (Strings{"", "2", "3"}));
  EXPECT_EQ(fields_of(",,"), (Strings{"", "", ""}));
  EXPECT_EQ(fields_of("1,5;;2,5", ";"), (Strings{"1,5", "", "2,5"}));
  EXPECT_EQ(fields_of(""), Strings());
}

TEST(XyzFields, ThatAreEmptyDoNotMoveTheOthers) {
  const Scratch scratch;
  for (const char* text :
       {"x,y,z,a,b\n1,2,3,,5\n1,2,3,4,\n", "x;y;z;a;b\n1;2;3;;5\n1;2;3;4;\n",
        "1,2,3,,5.5\n1,2,3,4.5,\n", "x;y;z;a;b\n1,0;2,0;3,0;;5,0\n1,0;2,0;3,0;4,0;\n"}) {
    const LoadedCloud loaded = scratch.read("a.csv", text);
    ASSERT_EQ(loaded.cloud.size(), 2u) << text;
    ASSERT_EQ(loaded.cloud.attributes.size(), 2u) << text;
    const Attribute &a = loaded.cloud.attributes[0], &b = loaded.cloud.attributes[1];
    EXPECT_TRUE(std::isnan(a.value(0)) && std::isnan(b.value(1))) << text;
    EXPECT_NEAR(a.value(1), 4.0, 0.5) << text;
    EXPECT_NEAR(b.value(0), 5.0, 0.5) << text;
    EXPECT_EQ(loaded.warnings.front(), "2 numbers are missing between separators: read as nan");
  }
}

TEST(XyzFields, NoneIsBehindTheLastSeparator) {
  const Scratch scratch;
  for (const char* text : {"x,y,z,\n1,2,3,\n4,5,6,\n", "1;2;3;\n4;5;6;\n", "x,y,z,\n1,2,3\n4,5,6\n",
                           "x,y,z\n1,2,3,\n4,5,6\n", "x,y,z\n1,2,3\n4,5,6\n,,\n,,\n"}) {
    const LoadedCloud loaded = scratch.read("a.csv", text);
    EXPECT_EQ(loaded.cloud.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}})) << text;
    EXPECT_TRUE(loaded.cloud.attributes.empty() && loaded.warnings.empty()) << text;
  }
  // A column without a name is one where it has numbers.
  EXPECT_EQ(scratch.read("a.csv", "x,y,z,\n1,2,3,4\n").cloud.attributes.size(), 1u);
}

TEST(XyzFields, NumbersOfTextLoseNoType) {
  const Scratch scratch;
  const PointCloud cloud = scratch.read("a.txt", "x y z a\n1 2 3 4\n").cloud;
  EXPECT_TRUE(formats::losses("b.txt", cloud).empty());
  PointCloud narrow = cloud;
  narrow.attributes = {make_attribute("a", std::vector<float>{4})};
  EXPECT_EQ(formats::losses("b.txt", narrow), Strings{"number types of attributes"});
}

TEST(XyzFields, TellWhereWholeNumbersAreRounded) {
  const Scratch scratch;
  const auto warnings_of = [&](const std::string& text) {
    return scratch.read("a.csv", text).warnings;
  };
  EXPECT_EQ(warnings_of("x,y,z,id,t\n1,2,3,1234567890123456789,9007199254740992\n"
                        "4,5,6,-9007199254740993,1e300\n"),
            Strings{"column id: 2 whole numbers beyond 2^53 are rounded"});
  EXPECT_EQ(warnings_of("x,y,z,id\n1,2,3,9007199254740994\n4,5,6,0.12345678901234567890\n"),
            Strings());
}

}  // namespace
}  // namespace pcednet::io
