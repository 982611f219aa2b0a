#include <gtest/gtest.h>

#include <cmath>

#include "io/sample_cloud.h"
#include "io/scratch.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/text/xyz.h"
#include "pcednet/io/text/xyz_fields.h"

namespace pcednet::io {
namespace {

TEST(Xyz, ReadsAnySeparatorAndSkipsComments) {
  const Scratch scratch;
  for (const char* text : {"1 2 3.5\n4 5 6\n", "1,2,3.5\n4,5,6", "1; 2; 3.5\r\n4; 5; 6\r\n",
                           "# hello\n\n1\t2\t3.5\n// there\n  4 5\t 6  \n"}) {
    const auto loaded = scratch.read("a.xyz", text);
    ASSERT_EQ(loaded.cloud.size(), 2u) << text;
    EXPECT_EQ(loaded.cloud.positions[0], Vec3(1, 2, 3.5));
    EXPECT_EQ(loaded.cloud.positions[1], Vec3(4, 5, 6));
    EXPECT_EQ(loaded.cloud.position_type, ScalarType::kFloat64);
    EXPECT_TRUE(loaded.warnings.empty());
  }
}

TEST(Xyz, ReadsDecimalCommas) {
  const Scratch scratch;
  for (const char* text :
       {"1,5 2,25 3,125\n4 -5,5e1 6\n", "1,5\t2,25\t3,125\n4\t-55\t6\n",
        "1,5;2,25;3,125\n4;-55;6\n", "1,5; 2,25; 3,125\n4,0 ; -55 ; 6",
        "x y z\n1,5 2,25 3,125\n4 -55 6", "x;y;z\r\n1,5;2,25;3,125\r\n4;-55;6\r\n",
        "2\n# a, b c, d\n1,5 2,25 3,125\n4 -55 6"}) {
    const auto loaded = scratch.read("a.txt", text);
    EXPECT_EQ(loaded.cloud.positions, (std::vector<Vec3>{{1.5, 2.25, 3.125}, {4, -55, 6}})) << text;
    EXPECT_TRUE(loaded.warnings.empty()) << text;
    EXPECT_TRUE(loaded.cloud.attributes.empty());
  }
  // The first line with a comma decides, be it the last of the file.
  const auto late = scratch.read("a.txt", "1 2 3\n# 4, 5\n4 5 6\n7 8,5 9\n");
  EXPECT_EQ(late.cloud.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}, {7, 8.5, 9}}));
}

TEST(Xyz, ReadsCommasBetweenNumbersWithOrWithoutBlanks) {
  const Scratch scratch;
  for (const char* text :
       {"1,2,3\n4,5,6\n", "1, 2, 3\n4, 5, 6\n", "1 ,2 ,3\n4 ,5 ,6\n", "1 , 2 , 3\n4 ,5, 6\n",
        "1,\t2,\t3\n4,\t5,\t6\n", "  1,  2,  3\n4,5,6\n", "1,2,3,\n4,5,6,\n", "1, 2,3\n4,5, 6\n",
        "1 2 3\n4, 5, 6\n", "x,y,z\n1, 2, 3\n4,5,6\n", "1.0,2, 3\n4,5.0, 6\n"}) {
    const auto loaded = scratch.read("a.csv", text);
    EXPECT_EQ(loaded.cloud.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}})) << text;
    EXPECT_TRUE(loaded.cloud.attributes.empty()) << text;
  }
  for (const char* text : {"1,2,3 300\n", "1.5,2.5, 3.5,4.5\n", "1,2, 3,4\n5,6,7,8\n"}) {
    const auto loaded = scratch.read("a.csv", text);
    EXPECT_EQ(loaded.cloud.attributes.size(), 1u) << text;
  }
}

TEST(Xyz, RefusesCommasThatReadEitherWay) {
  const Scratch scratch;
  const auto refuses = [&](const std::string& bytes, const std::string& part) {
    const std::string message =
        error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.txt", bytes); });
    EXPECT_TRUE(contains(message, scratch.path("a.txt").string() + part)) << message;
  };
  for (const char* line : {"1,5, 2,5, 3,5", "1,5 2", "1.234,5 1.000,0 2.000,0", "1,5 2.5 3,5"}) {
    refuses(std::string("1 2 3\n") + line + "\n4 5 6\n", ":2: these commas may be decimal");
  }
  refuses("1,5 2,5 3,5\n1.5 2 3\n", ":2: decimal points, where line 1 has decimal commas");
  refuses("1.5 2 3\n\n1,5 2,5 3,5\n", ":1: decimal points, where line 3 has decimal commas");
  refuses("1.234,5;2,5;3\n", ":1: points and decimal commas: write no points between thousands");
  refuses("1,234.5;2.5;3\n", ":1: commas and decimal points: write no commas between thousands");
  refuses("1,5 2,5 3,5\n1, 2, 3\n", ":2: commas between numbers, where line 1 has decimal commas");
  refuses("1,5;2,5;3,5\n1,2,3\n", ":2: commas between numbers, where line 1 has decimal commas");
  refuses("1,2,3,4,5,6\n1,5 2,5 3,5\n", ":2: decimal commas, where those of line 1");
  refuses("1,2,3\n1,5;2,5;3,5\n", ":2: decimal commas, where those of line 1");
  refuses("1,5;2,5;3,5,5\n", ":1: expected a number, not 3,5,5");
  refuses("1,5 2,5 3,5\n1,5 2,5\n", ":2: 2 numbers where the lines before have 3");
}

TEST(Xyz, ReadsColumnsByTheirNames) {
  const Scratch scratch;
  const std::string row = "1 2 3 10 20 30 0 0 1 0.5 2\n";
  for (const std::string names :
       {"x y z red green blue nx ny nz scalar_p label\n", "X Y Z R G B Nx Ny Nz scalar_p Label\n",
        "//X Y Z R G B Nx Ny Nz scalar_p scalar_label\n1\n",
        "1\n# x y z r g b nx ny nz scalar_p label\n"}) {
    const auto cloud = scratch.read("a.asc", names + row).cloud;
    ASSERT_EQ(cloud.size(), 1u) << names;
    EXPECT_EQ(cloud.positions[0], Vec3(1, 2, 3));
    EXPECT_EQ(cloud.colours.at(0), (Rgb{10, 20, 30}));
    EXPECT_EQ(cloud.normals.at(0), Vec3(0, 0, 1));
    EXPECT_EQ(cloud.labels, std::vector<std::uint8_t>{2});
    ASSERT_EQ(cloud.attributes.size(), 1u);
    EXPECT_EQ(cloud.attributes[0].name, "scalar_p");
    EXPECT_EQ(cloud.attributes[0].type, ScalarType::kFloat64);
  }
  const auto csv = scratch.read("b.csv", "\xEF\xBB\xBF\"roof angle\",x,y,z,\n7,1,2,3,4\n").cloud;
  EXPECT_EQ(csv.positions.at(0), Vec3(1, 2, 3));
  ASSERT_EQ(csv.attributes.size(), 2u);
  EXPECT_EQ(csv.attributes[0].name, "roof angle");
  EXPECT_EQ(csv.attributes[1].name, "scalar_5");
}

TEST(Xyz, ReadsPositionsUnderTheNamesOfSurveyors) {
  const Scratch scratch;
  for (const std::string header :
       {"Easting,Northing,Elevation", "EASTING NORTHING HEIGHT", "easting;northing;altitude",
        "# Easting Northing Z", "East;North;Height", "EAST,NORTH,ELEV",
        "Rechtswert;Hochwert;H\xC3\xB6he", "RECHTSWERT,HOCHWERT,H\xC3\x96HE",
        "Rechtswert;Hochwert;H\xF6he", "rechtswert\thochwert\thoehe", "E,N,H", "e n h",
        "\"Easting\",\"Northing\",\"Height\"", "Easting (m),Northing (m),Height (m)",
        "X [m];Y [ m ];Z[FT]"}) {
    const auto loaded = scratch.read("a.csv", header + "\n1 2 3\n");
    EXPECT_EQ(loaded.cloud.positions, std::vector<Vec3>{Vec3(1, 2, 3)}) << header;
    EXPECT_TRUE(loaded.cloud.attributes.empty() && loaded.warnings.empty()) << header;
  }
  // By name, not by place; the other columns keep theirs.
  const auto cloud = scratch.read("a.csv", "Point,Height,Northing,Easting,H\n7,3,2,1,9\n").cloud;
  EXPECT_EQ(cloud.positions.at(0), Vec3(1, 2, 3));
  ASSERT_EQ(cloud.attributes.size(), 2u);
  EXPECT_EQ(cloud.attributes[0].name, "Point");
  EXPECT_EQ(cloud.attributes[1].name, "H");
  EXPECT_EQ(scratch.read("a.csv", "n,e,h\n2,1,3\n").cloud.positions.at(0), Vec3(1, 2, 3));
  // Of several heights that above the sea.
  const auto both = scratch.read("a.csv", "easting,northing,height,elevation\n1,2,9,3\n").cloud;
  EXPECT_EQ(both.positions.at(0), Vec3(1, 2, 3));
  EXPECT_EQ(both.attributes.at(0).name, "height");
}

TEST(Xyz, LeavesTheNamesOfSurveyorsBesideXAndY) {
  const Scratch scratch;
  const auto cloud =
      scratch.read("a.csv", "easting,northing,height,e,n,h,x,y,z\n9,8,7,6,5,4,1,2,3\n").cloud;
  EXPECT_EQ(cloud.positions.at(0), Vec3(1, 2, 3));
  ASSERT_EQ(cloud.attributes.size(), 6u);
  EXPECT_EQ(cloud.attributes[0].name, "easting");
  EXPECT_EQ(cloud.attributes[5].name, "h");
  for (const char* header :
       {"x,y,height", "x,y,easting,northing,z1", "x,northing,easting,z", "easting,northing",
        "longitude,latitude,height", "lon,lat,z", "e,n,z", "e,n,h,z", "e,n,h,height", "e,n",
        "easting,n,h", "east,north,up", "Easting (deg),Northing (deg),Height (m)"}) {
    const std::string message =
        error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.csv", header); });
    EXPECT_TRUE(contains(message, ":1: expected numbers, or names of columns")) << header;
  }
  const auto prose = scratch.read("a.xyz", "# easting northing height of a scan\n1 2 3\n").cloud;
  EXPECT_EQ(prose.comments, std::vector<std::string>{"easting northing height of a scan"});
  EXPECT_EQ(prose.positions.at(0), Vec3(1, 2, 3));
  const std::vector<std::string> unit = {"x y z in metres", "by hand"};
  for (const char* names : {"# x y z time depth\n", "x y z time depth\n", "x,y,z,time,depth\n"}) {
    const auto named =
        scratch.read("a.txt", std::string("# x y z in metres\n# by hand\n") + names + "1 2 3 4 5\n")
            .cloud;
    EXPECT_EQ(named.comments, unit) << names;
    ASSERT_EQ(named.attributes.size(), 2u);
    EXPECT_EQ(named.attributes[0].name, "time");
    EXPECT_EQ(named.attributes[1].name, "depth");
  }
  const auto above =
      scratch.read("a.txt", "# x y z time\n# x y z of it in metres\n1 2 3 4\n").cloud;
  EXPECT_EQ(above.attributes.at(0).name, "time");
  EXPECT_EQ(above.comments, std::vector<std::string>{"x y z of it in metres"});
  const auto tabs = scratch.read("a.txt", "#x\ty\tz\ttime\n1\t2\t3\t\n1\t2\t3\t4\n").cloud;
  EXPECT_EQ(tabs.attributes.at(0).name, "time");
}

TEST(Xyz, ReadsQuotedNumbersUnderQuotedNames) {
  const Scratch scratch;
  const std::string names = "\"X\",\"Y\",\"Z\"\n";
  for (const std::string& text :
       {names + "\"1.5\",\"2.5\",\"-3e2\"\n\"4\",5,\" 6 \"\n",
        names + "\"1.5\", \"2.5\", \"-300\"\r\n\"4\", \"5\", \"6\"\r\n",
        std::string("\"E\";\"N\";\"H\"\n\"1.5\";\"2.5\";\"-300\"\n4;5;6\n"),
        std::string("\"x\" \"y\" \"z\"\n2\n\"1.5\" \"2.5\" \"-300\"\n\"4\" 5 6\n")}) {
    const auto cloud = scratch.read("a.csv", text).cloud;
    EXPECT_EQ(cloud.positions, (std::vector<Vec3>{{1.5, 2.5, -300}, {4, 5, 6}})) << text;
    EXPECT_TRUE(cloud.attributes.empty()) << text;
  }
  // Commas between quotes may be decimal; without names in quotes nothing tells what quotes mean.
  const std::string twice = "\"x\",\"y\",\"z\",\"a\",\"b\",\"c\"\n";
  for (const std::string& text :
       {names + "\"1,5\",\"2,5\",\"3,5\"\n", twice + "\"1,5\",\"2,5\",\"3,5\"\n",
        std::string("\"x\";\"y\";\"z\"\n\"1,5\";\"2,5\";\"3,5\"\n"), names + "1,\"2,5\",3\n",
        names + "\"1\"\"2\",3,4\n", names + "\"1\",\"\",\"3\"\n", names + "\"1\",\"2\",\"3\n",
        names + "\"1 000\",\"2\",\"3\"\n", std::string("x,y,z\n\"1\",\"2\",\"3\"\n"),
        std::string("\"1\",\"2\",\"3\"\n")}) {
    error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.csv", text); });
  }
}

TEST(Xyz, LeavesOutNamedColumnsOfText) {
  const Scratch scratch;
  for (const char* text :
       {"Nr;E;N;H;Code;q\nP1;1;2;3;kerb;7\nP2;4;5;6;;8\n",
        "Nr;E;N;H;Code;q\nP1;1,0;2;3;a.b;7\n7;4;5;6;1;8\n",
        "# Nr x y z Code q\nP1 1 2 3 #f00 7\nP2 4 5 6 #00f 8\n",
        "\"Nr\",\"x\",\"y\",\"z\",\"Code\",\"q\"\n\"P1\",1,2,3,\"a\",\"7\"\n\"P2\",4,5,6,\"b\","
        "\"8\"\n",
        "Nr x y z Code q\n1:30 1 2 3 2024-01-01T00:00 7\n1:31 4 5 6 2024-01-01T00:01 8\n"}) {
    const auto loaded = scratch.read("a.csv", text);
    EXPECT_EQ(loaded.cloud.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}})) << text;
    ASSERT_EQ(loaded.cloud.attributes.size(), 1u) << text;
    EXPECT_EQ(loaded.cloud.attributes[0].value(1), 8.0);
    EXPECT_EQ(loaded.warnings, std::vector<std::string>{"columns of text are left out: Nr, Code"})
        << text;
    EXPECT_NE(begins_as_points(InputFile(scratch.path("a.csv"))), *text == '#') << text;
  }
  // Later words of the first empty ones, with blanks, points and commas in them.
  for (const char* text : {"Nr,E,N,H,Code\n1,1,2,3,\n2,4,5,6,top of kerb\n",
                           "Nr;E;N;H;Code\n1;1,0;2;3;\n2;4;5;6;kerb, 1.5 m\n",
                           "Nr\tE\tN\tH\tCode\n1\t1\t2\t3\ta b c\n2\t4\t5\t6\t\n",
                           "Nr\tE\tN\tH\tCode\r\n1\t1\t2\t3\t\r\n\t4\t5\t6\t1 b\r\n\t\t\t\t\r\n"}) {
    const auto loaded = scratch.read("a.csv", text);
    EXPECT_EQ(loaded.cloud.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}})) << text;
    EXPECT_EQ(loaded.cloud.attributes.size(), 1u) << text;
    EXPECT_EQ(loaded.warnings.back(), "columns of text are left out: Code") << text;
  }
  for (const char* text : {"P1 1 2 3\n", "Nr x y z\n1 a 2 3\n", "Nr x y z\n1 1 2 3\nP2 4 5 6\n"}) {
    EXPECT_TRUE(contains(error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.txt", text); }),
                         "expected"))
        << text;
  }
}

TEST(Xyz, ReadsTheColoursOfCloudCompare) {
  const Scratch scratch;
  const auto cloud =
      scratch.read("a.asc", "//X Y Z Rf Gf Bf\n1 2 3 0.2 1.0 0\n4 5 6 0 0.4 1.0\n").cloud;
  ASSERT_EQ(cloud.colours.size(), 2u);
  EXPECT_EQ(cloud.colours[0], (std::array<std::uint8_t, 3>{51, 255, 0}));
  EXPECT_TRUE(cloud.attributes.empty());
}

TEST(Xyz, TellsProseFromNames) {
  const Scratch scratch;
  const auto cloud = scratch.read("a.xyz", "# the x y z of a scan\n1 2 3\n").cloud;
  EXPECT_EQ(cloud.size(), 1u);
  EXPECT_EQ(cloud.comments, std::vector<std::string>{"the x y z of a scan"});
}

std::string guess(std::size_t columns, const std::vector<double>& numbers,
                  TextKind kind = TextKind::kAny) {
  TableFacts facts;
  for (std::size_t at = 0; at < numbers.size(); at += columns) {
    facts.add(std::span(numbers).subspan(at, columns));
  }
  std::string joined;
  for (const std::string& name : guess_column_names(facts, kind)) {
    joined += (joined.empty() ? "" : " ") + name;
  }
  return joined;
}

TEST(Xyz, GuessesColumnsWithoutNames) {
  EXPECT_EQ(guess(3, {1, 2, 3}), "x y z");
  EXPECT_EQ(guess(4, {1, 2, 3, 255, 1, 2, 3, 2}), "x y z label");
  EXPECT_EQ(guess(4, {1, 2, 3, 255, 1, 2, 3, 3}), "x y z scalar_4");
  EXPECT_EQ(guess(6, {1, 2, 3, 0.6, 0, 0.8}), "x y z nx ny nz");
  EXPECT_EQ(guess(6, {1, 2, 3, 60, 0, 255}), "x y z red green blue");
  EXPECT_EQ(guess(6, {1, 2, 3, 60, 0, 256}), "x y z scalar_4 scalar_5 scalar_6");
  EXPECT_EQ(guess(7, {1, 2, 3, 0, 0, -1, 2}), "x y z nx ny nz label");
  EXPECT_EQ(guess(7, {1, 2, 3, 0, 0, -1, 0.5}), "x y z nx ny nz scalar_7");
  EXPECT_EQ(guess(7, {1, 2, 3, 99, 98, 97, 2}), "x y z red green blue label");
  EXPECT_EQ(guess(7, {1, 2, 3, 99, 98, 97, 96}), "x y z scalar_4 red green blue");
  EXPECT_EQ(guess(7, {1, 2, 3, -1024, 98, 97, 96}), "x y z scalar_4 red green blue");
  EXPECT_EQ(guess(9, {1, 2, 3, 0, 1, 0, 98, 97, 96}), "x y z nx ny nz red green blue");
  EXPECT_EQ(guess(9, {1, 2, 3, 98, 97, 96, 0, 1, 0}), "x y z red green blue nx ny nz");
  EXPECT_EQ(guess(10, {1, 2, 3, 98, 97, 96, 0, 1, 0, 1}), "x y z red green blue nx ny nz label");
  EXPECT_EQ(guess(5, {1, 2, 3, 0, 1}), "x y z scalar_4 label");
}

TEST(Xyz, FindsTheIntensityOfPts) {
  const auto pts = TextKind::kPts, counted = TextKind::kCountedPts;
  EXPECT_EQ(guess(7, {1, 2, 3, -1024, 98, 97, 96}, pts), "x y z intensity red green blue");
  EXPECT_EQ(guess(7, {1, 2, 3, 99, 98, 97, 2}, counted), "x y z intensity red green blue");
  EXPECT_EQ(guess(4, {1, 2, 3, 0.5}, pts), "x y z intensity");
  EXPECT_EQ(guess(4, {1, 2, 3, 0}, pts), "x y z label");
  EXPECT_EQ(guess(4, {1, 2, 3, 0}, counted), "x y z intensity");
  EXPECT_EQ(guess(6, {1, 2, 3, 60, 0, 255}, counted), "x y z red green blue");
  EXPECT_EQ(guess(6, {1, 2, 3, 0.6, 0, 0.8}, counted), "x y z nx ny nz");
}

TEST(Xyz, ReadsEveryScanOfPts) {
  const Scratch scratch;
  const auto loaded = scratch.read("a.pts",
                                   "2\n1 2 3 -5 10 20 30\n4 5 6 -6 11 21 31\n"
                                   "0\n\n1\r\n7 8 9 7 12 22 32\r\n");
  ASSERT_EQ(loaded.cloud.size(), 3u);
  EXPECT_EQ(loaded.cloud.positions[2], Vec3(7, 8, 9));
  EXPECT_EQ(loaded.cloud.colours.at(2), (Rgb{12, 22, 32}));
  ASSERT_TRUE(find_attribute(loaded.cloud, "intensity"));
  EXPECT_EQ(find_attribute(loaded.cloud, "intensity")->value(1), -6);
  for (const char* bytes : {"2\n1 2 3\n1\n4 5 6\n", "1\n1 2 3\n2\n4 5 6\n", "1\n1 2 3\n4 5 6\n1\n",
                            "1\n1 2 3\n18446744073709551615\n"}) {
    error_of(ErrorKind::kUnreadable, [&] { scratch.read("b.pts", bytes); });
  }
}

TEST(Xyz, WritesPtsAsOtherProgramsReadIt) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {Vec3(0.5, 2, 3)};
  cloud.colours = {Rgb{10, 20, 2}};
  cloud.comments = {"a comment"};
  cloud.attributes = {make_attribute("Intensity", std::vector<std::uint16_t>{7})};
  formats::write_cloud(scratch.path("a.pts"), cloud);
  EXPECT_EQ(bytes_of(scratch.path("a.pts")), "1\n0.5 2 3 7 10 20 2\n");
  EXPECT_EQ(formats::losses("a.pts", cloud),
            (std::vector<std::string>{"number types of attributes", "comments"}));
  const PointCloud back = formats::read_cloud(scratch.path("a.pts")).cloud;
  EXPECT_EQ(back.colours, cloud.colours);
  EXPECT_TRUE(find_attribute(back, "intensity"));
  // Further columns are behind these, under names.
  cloud.normals = {Vec3(0, 0, 1)};
  cloud.attributes.insert(cloud.attributes.begin(),
                          make_attribute("height", std::vector<float>{0.25F}));
  formats::write_cloud(scratch.path("b.pts"), cloud);
  EXPECT_EQ(bytes_of(scratch.path("b.pts")),
            "1\n# a comment\n# x y z Intensity red green blue nx ny nz height\n"
            "0.5 2 3 7 10 20 2 0 0 1 0.25\n");
  const PointCloud named = formats::read_cloud(scratch.path("b.pts")).cloud;
  EXPECT_EQ(named.normals, cloud.normals);
  EXPECT_EQ(named.comments, cloud.comments);
  EXPECT_EQ(named.attributes.size(), 2u);
}

TEST(Xyz, SaysWhatItGuessed) {
  const Scratch scratch;
  const auto loaded = scratch.read("a.txt", "1 2 3 0 0 1\n4 5 6 0 1 0\n");
  EXPECT_EQ(loaded.cloud.normals.at(1), Vec3(0, 1, 0));
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_TRUE(contains(loaded.warnings[0], "x y z nx ny nz"));
}

TEST(Xyz, GivesBackEveryBit) {
  const Scratch scratch;
  PointCloud cloud = sample_cloud(10000);
  cloud.position_type = ScalarType::kFloat64;
  Random random(2);
  for (Vec3& p : cloud.positions) p *= std::pow(10.0, random.uniform(-30, 30));
  for (const std::string name : {"a.xyz", "a.txt", "a.asc", "a.pts", "a.csv"}) {
    formats::write_cloud(scratch.path(name), cloud);
    const PointCloud back = formats::read_cloud(scratch.path(name)).cloud;
    EXPECT_TRUE(same_bits(back.positions, cloud.positions)) << name;
    EXPECT_EQ(back.colours, cloud.colours);
    EXPECT_EQ(back.labels, cloud.labels);
    ASSERT_EQ(back.attributes.size(), 4u);
    for (const Attribute& attribute : cloud.attributes) {
      const Attribute* found = find_attribute(back, attribute.name);
      ASSERT_TRUE(found) << attribute.name;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        // Text spells a float as short as it can be; as a float it is the same again.
        const double value = found->value(i);
        EXPECT_EQ(attribute.type == ScalarType::kFloat32 ? static_cast<float>(value) : value,
                  attribute.value(i));
      }
    }
    if (name != "a.csv") {
      EXPECT_EQ(back.comments, cloud.comments);
    }
  }
  EXPECT_EQ(formats::losses("a.csv", cloud).size(), 2u);
  EXPECT_EQ(formats::losses("a.xyz", cloud).size(), 1u);
}

TEST(Xyz, WritesPlainColumnsPlainly) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {Vec3(0.1, -2, 512049.781)};
  cloud.comments = {"lost"};
  formats::write_cloud(scratch.path("a.txt"), cloud);
  EXPECT_EQ(bytes_of(scratch.path("a.txt")), "0.1 -2 512049.781\n");
  EXPECT_EQ(formats::losses("a.txt", cloud), std::vector<std::string>{"comments"});
  formats::write_cloud(scratch.path("a.csv"), cloud);
  EXPECT_EQ(bytes_of(scratch.path("a.csv")), "x,y,z\n0.1,-2,512049.781\n");
  formats::write_cloud(scratch.path("a.pts"), cloud);
  EXPECT_EQ(bytes_of(scratch.path("a.pts")), "1\n0.1 -2 512049.781\n");
  cloud.normals = {Vec3(0, 0, 1)};
  formats::write_cloud(scratch.path("a.xyz"), cloud);
  EXPECT_EQ(bytes_of(scratch.path("a.xyz")), "0.1 -2 512049.781 0 0 1\n");
  formats::write_cloud(scratch.path("b.txt"), cloud);
  EXPECT_EQ(bytes_of(scratch.path("b.txt")), "# lost\n# x y z nx ny nz\n0.1 -2 512049.781 0 0 1\n");
}

TEST(Xyz, ReadsUtf16) {
  const Scratch scratch;
  std::string text = "\xFF\xFE";
  for (const char c : std::string("x;y;z\r\n1,5;2;3\r\n")) text += {c, '\0'};
  const InputFile file(scratch.file("a.csv", text));
  EXPECT_TRUE(begins_as_points(file));
  EXPECT_EQ(read_xyz(file).cloud.positions, std::vector{Vec3(1.5, 2, 3)});
}

TEST(Xyz, WarnsOfNumbersOfPointsThatAreReadAsX) {
  const Scratch scratch;
  const auto warnings = [&](const std::string& text) {
    return read_xyz(InputFile(scratch.file("a.txt", text))).warnings;
  };
  EXPECT_EQ(warnings("7 1 2 3\n8 1 2 3\n9 1 2 3\n10 1 2 3\n"),
            std::vector<std::string>{"no column names: read as x y z scalar_4, although the first "
                                     "column numbers the points; give names, such as: id x y z"});
  EXPECT_EQ(warnings("7 1 2 3\n8 1 2 3\n9 1 2 3\n11 1 2 3\n"),
            std::vector<std::string>{"no column names: read as x y z scalar_4"});
  EXPECT_TRUE(warnings("id x y z\n1 1 2 3\n2 1 2 3\n3 1 2 3\n4 1 2 3\n").empty());
}

TEST(Xyz, TellsPointsFromProse) {
  const Scratch scratch;
  const auto begins = [&](const std::string& text) {
    return begins_as_points(InputFile(scratch.file("a.txt", text)));
  };
  const std::string mark = "\xEF\xBB\xBF", row = "1 2 3\n";
  for (const std::string& start :
       {std::string(), std::string("1\n"), std::string("1,,\n"), std::string("x y z\n1\n"),
        std::string("// a\n\n# b\n"), std::string("Px;X;Y;Z\r\n"),
        std::string("\"x\",\"y\",\"z\"\n"), std::string("a b,x,y,z\n"),
        std::string("Easting Northing Height\n"), std::string("Nr;E;N;H\n")}) {
    EXPECT_TRUE(begins(start + row)) << start;
    EXPECT_TRUE(begins(mark + start + row)) << start;
  }
  EXPECT_TRUE(begins("1,5 2,5 3\n"));
  EXPECT_TRUE(begins("x,y,z\n"));
  EXPECT_TRUE(begins("\"1\",\"2\",\"3\"\n")) << "to be told of, not passed over";
  EXPECT_TRUE(begins("#" + std::string(1 << 16, ' ') + "\nprose"));
  for (const char* prose :
       {"", "1\n", "# x y z\n", "1\n1\n1 2 3\n", "x y z\nx y z\n1 2 3\n",
        "The axes x, y, z are those of the scanner.\n", "1 2\n", "one 2 3 4\n"}) {
    EXPECT_FALSE(begins(prose)) << prose;
  }
}

TEST(Xyz, NamesTheLineThatDoesNotFit) {
  const Scratch scratch;
  const auto unreadable = [&](const std::string& bytes, const std::string& part) {
    const std::string message =
        error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.xyz", bytes); });
    EXPECT_TRUE(contains(message, scratch.path("a.xyz").string() + part)) << message;
  };
  unreadable("1 2\n", ":1: expected at least three numbers");
  unreadable("1 2 3\n\n4 5\n", ":3: 2 numbers where the lines before have 3");
  unreadable("1 2 3\n4\n", ":2: 1 number where the lines before have 3");
  unreadable("1 2 3\n4 5 six\n", ":2: expected a number, not six");
  unreadable("1 2 3\n4 5 -1.8e308\n", ":2: -1.8e308 is beyond the largest double");
  unreadable("hello world\n", ":1: expected numbers, or names");
  unreadable("x y z a\n1 2 3\n", ":2: 3 numbers under 4 names");
  unreadable("3\n1 2 3\n4 5 6\n", ": declares 3 points but holds 2");
  unreadable("7\n", ": declares 7 points but holds 0");
  unreadable("7\n8\n", ":2: expected at least three numbers");
  for (const char* nothing : {"\n", "\n\n", "# only\n####\n//\n", "x y z\n", "0\n"}) {
    EXPECT_TRUE(scratch.read("b.xyz", nothing).cloud.empty()) << nothing;
  }
}

}  // namespace
}  // namespace pcednet::io
