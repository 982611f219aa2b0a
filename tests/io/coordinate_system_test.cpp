#include "pcednet/io/coordinate_system.h"

#include <gtest/gtest.h>

namespace pcednet::io {
namespace {

constexpr const char* kGeographic =
    R"(GEOGCS["ETRS89",DATUM["E",SPHEROID["GRS 1980",6378137,298.25,AUTHORITY["EPSG","7019"]]],)"
    R"(UNIT["degree",0.01745,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4258"]])";

std::string projected(const std::string& unit, const std::string& code) {
  return std::string(R"(PROJCS["UTM, [zone] 32",)") + kGeographic +
         R"(,PROJECTION["Transverse_Mercator"],PARAMETER["false_easting",500000],UNIT[)" + unit +
         "]" + (code.empty() ? "" : R"(,AUTHORITY["EPSG",")" + code + "\"]") + "]";
}

TEST(CoordinateSystem, FindsTheCodeOfADefinition) {
  const auto utm = coordinate_system_of_wkt(projected(R"("metre",1)", "25832"));
  EXPECT_EQ(utm.epsg, 25832);
  EXPECT_EQ(utm.unit, LengthUnit::kMetre);
  EXPECT_EQ(coordinate_system_of_wkt(kGeographic).epsg, 4258);
  EXPECT_EQ(coordinate_system_of_wkt(kGeographic).unit, LengthUnit::kNone);
  EXPECT_EQ(coordinate_system_of_wkt(projected(R"("metre",1)", "")).epsg, 0);
}

TEST(CoordinateSystem, TakesTheHorizontalPartOfACompoundSystem) {
  const std::string vertical =
      R"(,VERT_CS["DHHN",VERT_DATUM["D",2005],UNIT["metre",1],AUTHORITY["EPSG","7837"]])";
  const std::string parts = projected(R"("metre",1)", "25832") + vertical;
  const auto both = coordinate_system_of_wkt("COMPD_CS[\"both\"," + parts + "]");
  EXPECT_EQ(both.epsg, 25832);
  EXPECT_EQ(both.vertical_epsg, 7837);
  const auto named = coordinate_system_of_wkt("COMPD_CS[\"both\"," + parts +
                                              R"(, AUTHORITY [ "EPSG" , "5555" ] ])");
  EXPECT_EQ(named.epsg, 5555);
  EXPECT_EQ(named.vertical_epsg, 0);  // the other code covers them
  EXPECT_EQ(named.unit, LengthUnit::kMetre);
  const std::string in_feet = projected(R"("foot",0.3048)", "2263") + vertical;
  EXPECT_EQ(coordinate_system_of_wkt("COMPD_CS[\"both\"," + in_feet + "]").unit, LengthUnit::kNone);
}

TEST(CoordinateSystem, OfHeightsAloneTellsNothingOfXAndY) {
  for (const char* wkt :
       {R"(VERT_CS["DHHN",VERT_DATUM["D",2005],UNIT["metre",1],AUTHORITY["EPSG","7837"]])",
        R"(VERTCRS["DHHN",VDATUM["D"],CS[vertical,1],LENGTHUNIT["metre",1],ID["EPSG",7837]])"}) {
    const auto heights = coordinate_system_of_wkt(wkt);
    EXPECT_EQ(heights.epsg, 0) << wkt;
    EXPECT_EQ(heights.vertical_epsg, 7837) << wkt;
    EXPECT_EQ(heights.unit, LengthUnit::kNone) << wkt;
  }
}

TEST(CoordinateSystem, KnowsFeetAndTheNewerForm) {
  const auto unit_of = [](const std::string& unit) {
    return coordinate_system_of_wkt(projected(unit, "2263")).unit;
  };
  EXPECT_EQ(unit_of(R"("foot",0.3048)"), LengthUnit::kFoot);
  EXPECT_EQ(unit_of(R"("US survey foot",0.3048006)"), LengthUnit::kUsSurveyFoot);
  EXPECT_EQ(unit_of(R"("yard",0.9144)"), LengthUnit::kNone);
  const auto modern = coordinate_system_of_wkt(
      R"(PROJCRS["x",BASEGEOGCRS["y",DATUM["z",ELLIPSOID["e",6378137,298,LENGTHUNIT["metre",1]]],)"
      R"(ID["EPSG",4258]],CS[Cartesian,2],AXIS["E",east],LENGTHUNIT["metre",1],ID["EPSG",25832]])");
  EXPECT_EQ(modern.epsg, 25832);
  EXPECT_EQ(modern.unit, LengthUnit::kMetre);
  const auto in_feet = coordinate_system_of_wkt(
      R"(PROJCRS["x",BASEGEOGCRS["y",DATUM["z",ELLIPSOID["e",6378137,298,LENGTHUNIT["metre",1]]]],)"
      R"(CONVERSION["c",PARAMETER["false easting",0,LENGTHUNIT["metre",1]]],CS[Cartesian,2],)"
      R"(AXIS["E",east],AXIS["N",north],LENGTHUNIT["US survey foot",0.304800609601219]])");
  EXPECT_EQ(in_feet.unit, LengthUnit::kUsSurveyFoot);
}

TEST(CoordinateSystem, TellsDegreesFromLengths) {
  const std::string parts = std::string(kGeographic) + R"(,VERT_CS["h",UNIT["metre",1]])";
  for (const std::string& wkt :
       {std::string(kGeographic), "COMPD_CS[\"both\"," + parts + "]",
        std::string(R"(GEOGCRS["x",CS[ellipsoidal,2],ANGLEUNIT["degree",0.0174532925199433]])"),
        std::string(R"(GEODCRS["x",CS[ellipsoidal,2],ANGLEUNIT["degree",0.0174532925199433]])")}) {
    EXPECT_TRUE(coordinate_system_of_wkt(wkt).geographic) << wkt;
    EXPECT_EQ(coordinate_system_of_wkt(wkt).unit, LengthUnit::kNone) << wkt;
  }
  const std::string geocentric = R"(GEODCRS["x",CS[Cartesian,3],LENGTHUNIT["metre",1]])";
  for (const std::string& wkt : {projected(R"("metre",1)", "25832"), geocentric}) {
    EXPECT_FALSE(coordinate_system_of_wkt(wkt).geographic) << wkt;
    EXPECT_EQ(coordinate_system_of_wkt(wkt).unit, LengthUnit::kMetre) << wkt;
  }
}

TEST(CoordinateSystem, SurvivesNonsense) {
  for (const char* text :
       {"", "]", "[", "A[\"", "A[B[C[", "PROJCS[AUTHORITY[\"EPSG\"]]",
        "PROJCS[AUTHORITY[\"EPSG\",\"x\"]]", "PROJCS[AUTHORITY[\"EPSG\",\"-5\"]]",
        "PROJCS[AUTHORITY[\"EPSG\",\"99999999999\"]]", "WGS 84 / UTM zone 32N"}) {
    EXPECT_EQ(coordinate_system_of_wkt(text).epsg, 0) << text;
  }
}

TEST(CoordinateSystem, IsReadFromTheCommentThatCarriesIt) {
  const std::string wkt = "PROJCS[\"x\",UNIT[\"metre\",1]]";
  EXPECT_EQ(wkt_of_comments({"scan 0: a", "coordinate system: " + wkt, "more"}), wkt);
  EXPECT_EQ(wkt_of_comments({"coordinate system:  GeogCRS [\"x\"] "}), "GeogCRS [\"x\"]");
  for (const char* other : {"PROJCS", "local", "", "[]", "EPSG:25832", "FOO[\"x\"]"}) {
    EXPECT_EQ(wkt_of_comments({std::string("coordinate system: ") + other}), "") << other;
  }
  EXPECT_EQ(wkt_of_comments({wkt, "a coordinate system: " + wkt}), "");
  EXPECT_EQ(wkt_of_comments({}), "");
}

}  // namespace
}  // namespace pcednet::io
