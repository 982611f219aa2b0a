#include "pcednet/io/projection.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace pcednet::io {
namespace {

using Points = std::vector<std::array<double, 2>>;

TEST(Projections, AreThereIfBuiltWithProj) {
  EXPECT_EQ(has_projections(), PCEDNET_HAS_PROJ == 1);
}

// What must hold with PROJ, and what without.
TEST(Projections, DefineASystemByItsCodes) {
  const std::string old = definition_of({.epsg = 25832}, WktVersion::k1),
                    now = definition_of({.epsg = 25832}, WktVersion::k2);
  EXPECT_EQ(old.starts_with("PROJCS["), has_projections()) << old;
  EXPECT_EQ(now.starts_with("PROJCRS["), has_projections()) << now;
  EXPECT_EQ(old.find('\n'), std::string::npos);
  EXPECT_EQ(coordinate_system_of_wkt(old).epsg, has_projections() ? 25832 : 0);
  EXPECT_EQ(coordinate_system_of_wkt(now).epsg, has_projections() ? 25832 : 0);
  const std::string both = definition_of({.epsg = 25832, .vertical_epsg = 7837}, WktVersion::k1);
  EXPECT_EQ(both.starts_with("COMPD_CS["), has_projections()) << both;
}

TEST(Projections, KnowNothingOfNoSystemOrOfNonsense) {
  for (const CoordinateSystem& system :
       {CoordinateSystem{}, CoordinateSystem{.epsg = 1}, CoordinateSystem{.wkt = "PROJCS[\"x\"]"},
        CoordinateSystem{.wkt = std::string(10000, '[')},
        CoordinateSystem{.wkt = "+proj=pipeline +step +proj=cart"}}) {
    EXPECT_EQ(definition_of(system, WktVersion::k2), "") << system.wkt;
    EXPECT_FALSE(to_wgs84(system, {{0.0, 0.0}})) << system.wkt;
  }
}

TEST(Projections, RefuseNumbersThatAreNoCodes) {
  EXPECT_EQ(system_of_code(25832).epsg, 25832);
  EXPECT_EQ(system_of_code(25832).unit, has_projections() ? LengthUnit::kMetre : LengthUnit::kNone);
  EXPECT_TRUE(!has_projections() || system_of_code(4326).geographic);
  for (const int code : {-5, 0, 1, 1023, 32767, 100000}) {
    EXPECT_ERROR(ErrorKind::kUsage, system_of_code(code)) << code;
  }
  if (has_projections()) {
    EXPECT_ERROR(ErrorKind::kUsage, system_of_code(30001));
  }
}

TEST(Projections, TakeTheCodeOfTheHeightsAlongside) {
  const CoordinateSystem both = system_of_code(25832, 7837);
  EXPECT_EQ(code_text(both), "EPSG:25832+7837");
  EXPECT_EQ(both.wkt, definition_of({.epsg = 25832, .vertical_epsg = 7837}, WktVersion::k1));
  EXPECT_EQ(both.unit, has_projections() ? LengthUnit::kMetre : LengthUnit::kNone);
  EXPECT_ERROR(ErrorKind::kUsage, system_of_code(25832, 7));
  if (!has_projections()) return;
  EXPECT_EQ(system_of_code(25832, 8228).unit, LengthUnit::kNone);  // heights in feet
  for (const auto& codes : {std::pair(25832, 4326), std::pair(7837, 25832)}) {
    const auto error = test::error_of([&] { system_of_code(codes.first, codes.second); });
    ASSERT_TRUE(error) << codes.first;
    EXPECT_EQ(std::string(error->what()),
              fmt::format("EPSG:{}+{}: PROJ knows no such system", codes.first, codes.second));
  }
}

TEST(Projections, RefuseCodesOfHeightsAlone) {
  if (!has_projections()) {
    EXPECT_EQ(system_of_code(5703).epsg, 5703);
    return;
  }
  for (const int code : {5703, 7837, 6360}) {  // the last of feet
    const auto error = test::error_of([&] { system_of_code(code); });
    ASSERT_TRUE(error) << code;
    EXPECT_EQ(error->kind(), ErrorKind::kUsage);
    EXPECT_NE(std::string(error->what()).find("a system of heights alone"), std::string::npos);
  }
  EXPECT_EQ(system_of_code(7415).epsg, 7415);  // with heights
  EXPECT_EQ(system_of_code(4978).unit, LengthUnit::kMetre);
}

// The meridian's arc to 50 degrees north on GRS 80 is 5540847.042 m long; UTM scales it by 0.9996.
TEST(Projections, FindPlacesOnEarth) {
  const auto found = to_wgs84({.epsg = 25832}, Points{{500000.0, 0.9996 * 5540847.042}});
  ASSERT_EQ(found.has_value(), has_projections());
  if (!found) return;
  EXPECT_NEAR((*found)[0][0], 9.0, 1e-8);
  EXPECT_NEAR((*found)[0][1], 50.0, 1e-7);
  const auto east_first = to_wgs84({.epsg = 4258}, Points{{9.0, 50.0}});
  ASSERT_TRUE(east_first);
  EXPECT_NEAR((*east_first)[0][0], 9.0, 1e-6);
  EXPECT_FALSE(to_wgs84({.epsg = 25832}, Points{{1e300, 1e300}}));
}

}  // namespace
}  // namespace pcednet::io
