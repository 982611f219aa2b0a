#include "pcednet/formats/parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/e57/e57_writer.h"
#include "io/sample_cloud.h"
#include "io/scratch.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/parts.h"

namespace pcednet::io {
namespace {

/// A cloud that LAS can hold, its z in hundredths, of more points than a chunk of LAZ has.
PointCloud grid_cloud(std::size_t points) {
  PointCloud cloud = sample_cloud(points);
  cloud.position_type = ScalarType::kFloat64;
  for (std::size_t i = 0; i < points; ++i) {
    const auto number = static_cast<double>(i);
    cloud.positions[i] =
        Vec3(600000 + number / 100, 5e6 + std::floor(number / 7), std::floor(number / 3) / 100);
  }
  std::erase_if(cloud.attributes, [](const Attribute& a) { return a.name == "quality"; });
  return cloud;
}

EachPart each_part_of(const PartReader& reader) {
  return [&](const auto& visit) {
    for (std::size_t p = 0; p < reader.parts(); ++p) {
      PartTally tally;
      PointCloud part = reader.read(p);
      finish_part(part, tally);
      if (!visit(part)) return;
    }
  };
}

/// Writes a file part by part.
std::vector<std::string> copy(const PartReader& reader, const std::filesystem::path& path) {
  PartTally tally;
  PointCloud first = reader.read(0);
  finish_part(first, tally);
  const auto writer = formats::create_parts(
      path, {reader.points(), &first, each_part_of(reader), reader.is_las()}, WriteOptions{});
  each_part_of(reader)([&](const PointCloud& part) {
    writer->append(part);
    return true;
  });
  writer->commit();
  return writer->losses;
}

class Parts : public ::testing::TestWithParam<const char*> {};

TEST_P(Parts, AreTheWholeCloud) {
  const Scratch scratch;
  const auto file = scratch.path(std::string("a.") + GetParam());
  formats::write_cloud(file, grid_cloud(120'000));
  const PointCloud whole = formats::read_cloud(file).cloud;
  const auto reader = formats::open_parts(file, 30'000);
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->points(), 120'000U);
  EXPECT_GE(reader->parts(), 3U);
  std::size_t begin = 0;
  for (std::size_t p = 0; p < reader->parts(); ++p) {
    PointCloud part = reader->read(p);
    PartTally tally;
    finish_part(part, tally);
    for (std::size_t i = 0; i < part.size(); ++i) {
      ASSERT_EQ(part.positions[i], whole.positions[begin + i]);
      ASSERT_EQ(part.normals[i], whole.normals[begin + i]);
      ASSERT_EQ(part.colours[i], whole.colours[begin + i]);
    }
    ASSERT_EQ(part.attributes.size(), whole.attributes.size());
    for (std::size_t a = 0; a < part.attributes.size(); ++a) {
      const Attribute& ours = part.attributes[a];
      const Attribute& theirs = whole.attributes[a];
      ASSERT_EQ(ours.name, theirs.name);
      ASSERT_TRUE(
          std::equal(ours.bytes.begin(), ours.bytes.end(),
                     theirs.bytes.begin() + static_cast<std::ptrdiff_t>(begin * theirs.stride())));
    }
    EXPECT_EQ(part.foreign_elements.size(), p == 0 ? whole.foreign_elements.size() : 0);
    begin += part.size();
  }
  EXPECT_EQ(begin, whole.size());
}

TEST_P(Parts, WriteTheBytesOfTheWhole) {
  const Scratch scratch;
  const auto file = scratch.path(std::string("a.") + GetParam());
  formats::write_cloud(file, grid_cloud(120'000));
  const PointCloud whole = formats::read_cloud(file).cloud;
  const auto reader = formats::open_parts(file, 35'000);
  ASSERT_TRUE(reader);
  for (const char* name : {"o.ply", "o.las", "o.laz", "o.copc.laz", "o.csv", "o.xyz", "o.pts"}) {
    const auto lost = copy(*reader, scratch.path(name));
    const auto expected = scratch.path(std::string("whole_") + name);
    formats::write_cloud(expected, whole);
    EXPECT_EQ(bytes_of(scratch.path(name)), bytes_of(expected)) << name;
    EXPECT_EQ(lost, formats::losses(expected, whole)) << name;
  }
  EXPECT_FALSE(formats::create_parts(scratch.path("o.pcd"), {whole.size(), &whole, {}, false}, {}));
}

INSTANTIATE_TEST_SUITE_P(Formats, Parts,
                         ::testing::Values("ply", "las", "laz", "copc.laz", "xyz", "csv", "pts"));

TEST(PartsOfText, AreTheWholeTextOfAnyForm) {
  const Scratch scratch;
  for (const std::string text :
       {"1 2 3\n4 5 6\n7 8 9\n",
        "\xEF\xBB\xBF"
        "1 2 3\r\n\r\n4 5 6\r\n7 8 9",
        "1 2 3\r4 5 6\r7 8 9\r", "3\n1 2 3 0 0 1\n4 5 6 0 0 1\n# last\n7 8 9 0 1 0\n",
        "# a\n# x y z q\n1 2 3 4\n# b\n2 2 2 2\n", "x;y;z;q\n1;2;3;4,5\n4;5;6;7\n7;8;9;\n",
        "1 2 3\n4 5,5 6\n7 8 9\n10 11 12\n", "1,2,3\n4,5,6\n\n7,8,9\n",
        "Nr;E;N;H;Code\n1;1;2;3;\n2;4;5;6;\n3;7;8;9;a b\n",
        "Nr;E;N;H;Code\nP1;1;2;3;a,b.c\nP2;4;5;6;d\nP3;7;8;9;\n",
        "\"x\",\"y\",\"z\"\n\"1\",\"2\",\"3\"\n4,5,6\n", "x y z r g b\n1 2 3 0 1 1\n4 5 6 1 0 0\n",
        "x y z red g b\n1 2 3 7 8 9\n",
        "x y z red green blue label\n1 2 3 0 1 1 -1\n4 5 6 255 0 1 2\n1 1 1 0 0 0 nan\n",
        "1 2 3 0 0 1 1 1 1 0\n4 5 6 0 1 0 255 255 0 2\n7 8 9 1 0 0 0 0 0 1\n",
        "1 1 1 1\n2 2 2 2\n3 3 3 3\n4 4 4 4\n"}) {
    for (const char* name : {"a.csv", "a.pts"}) {
      const auto file = scratch.file(name, text);
      const LoadedCloud whole = formats::read_cloud(file);
      for (const std::size_t most : {1, 2, 3, 100}) {
        const auto reader = formats::open_parts(file, most);
        ASSERT_TRUE(reader) << text;
        EXPECT_EQ(reader->warnings, whole.warnings) << text;
        ASSERT_EQ(reader->points(), whole.cloud.size()) << text;
        EXPECT_EQ(reader->parts(), (whole.cloud.size() + most - 1) / most) << text;
        EXPECT_EQ(reader->read(0).comments, whole.cloud.comments);
        const auto path = scratch.path("parts.ply"), expected = scratch.path("whole.ply");
        copy(*reader, path);
        formats::write_cloud(expected, whole.cloud);
        EXPECT_EQ(bytes_of(path), bytes_of(expected)) << text << most;
        std::filesystem::remove(path), std::filesystem::remove(expected);
      }
    }
  }
}

TEST(PartsOfText, AreNoneWhereOneDoesNotShowTheColoursOrLabels) {
  const Scratch scratch;
  for (const std::string text :
       {"x y z r g b\n1 2 3 0 1 1\n4 5 6 .5 0 1\n", "x y z label\n1 2 3 1\n4 5 6 1.5\n", "x y z\n",
        "x y z red green blue\n1 2 3 0 1 1\n4 5 6 300 0 1\n",
        "x y z red green blue r g b\n1 2 3 .1 .1 .1 1 1 1\n"}) {
    EXPECT_FALSE(formats::open_parts(scratch.file("a.csv", text), 1)) << text;
  }
  EXPECT_FALSE(formats::open_parts(scratch.file("a.txt", std::string("\xFF\xFE"
                                                                     "1\0 \0002\0 \0003\0",
                                                                     12)),
                                   1));
}

TEST(PartChoices, AreMadeByAllPoints) {
  const Scratch scratch;
  PointCloud cloud = grid_cloud(100);
  cloud.positions[99].x() += 1e-6;  // only the last part has that digit
  formats::write_cloud(scratch.path("a.ply"), cloud);
  const auto reader = formats::open_parts(scratch.path("a.ply"), 10);
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->parts(), 10U);
  copy(*reader, scratch.path("a.las"));
  const PointCloud back = formats::read_cloud(scratch.path("a.las")).cloud;
  EXPECT_NEAR(back.positions[99].x(), cloud.positions[99].x(), 1e-7);
}

TEST(PartChoices, CommentsComeWithTheFirstPart) {
  const Scratch scratch;
  PointCloud cloud = grid_cloud(20);
  cloud.comments = {"scanner 0: 1 2 3", "it\twas\nwindy"};
  formats::write_cloud(scratch.path("a.laz"), cloud);
  const auto before = formats::losses(scratch.path("a.laz"), cloud);
  const std::vector<std::string> kept = {"scanner 0: 1 2 3", "it was", "windy"};
  EXPECT_EQ(formats::read_cloud(scratch.path("a.laz")).cloud.comments, kept);
  const auto reader = formats::open_parts(scratch.path("a.laz"), 10);
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->read(0).comments, kept);
  EXPECT_EQ(reader->read(0).scanners, std::vector<Vec3>{Vec3(1, 2, 3)});
  copy(*reader, scratch.path("b.laz"));
  EXPECT_EQ(formats::read_cloud(scratch.path("b.laz")).cloud.comments, kept);
  cloud.comments = {std::string(70'000, 'a')};
  EXPECT_EQ(formats::losses(scratch.path("a.laz"), cloud).size(), before.size() + 1);
}

TEST(PartChoices, ColoursOfLasAreWideIfOneIs) {
  const Scratch scratch;
  PointCloud cloud = grid_cloud(30);
  cloud.colours.assign(30, Rgb{0, 0, 0});
  cloud.colours[29] = {200, 0, 0};  // 51,400 in the file, all others are 0
  formats::write_cloud(scratch.path("a.las"), cloud);
  const auto reader = formats::open_parts(scratch.path("a.las"), 10);
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->read(2).colours[9], (Rgb{200, 0, 0}));
}

TEST(PartChoices, WideColoursBesideBytesStayColumns) {
  const Scratch scratch;
  PointCloud cloud = grid_cloud(30);
  cloud.colours.assign(30, Rgb{7, 8, 9});
  for (const char* name : {"Red", "Green", "Blue"}) {
    cloud.attributes.push_back(make_attribute(name, std::vector<std::uint16_t>(30, 1799)));
  }
  formats::write_cloud(scratch.path("a.ply"), cloud);
  const auto reader = formats::open_parts(scratch.path("a.ply"), 10);
  ASSERT_TRUE(reader);
  const PointCloud part = reader->read(2), whole = formats::read_cloud(scratch.path("a.ply")).cloud;
  EXPECT_EQ(part.colours[9], (Rgb{7, 8, 9}));
  ASSERT_EQ(part.attributes.size(), whole.attributes.size());
  EXPECT_EQ(find_attribute(part, "Blue")->value(9), 1799.0);
  cloud.colours.clear();  // then numbers decide what the others are
  formats::write_cloud(scratch.path("b.ply"), cloud);
  EXPECT_FALSE(formats::open_parts(scratch.path("b.ply"), 10));
}

TEST(PartChoices, WhatOnlyTheWholeDecidesIsReadAsAWhole) {
  const Scratch scratch;
  PointCloud cloud = grid_cloud(40);
  cloud.normals.assign(40, Vec3::Zero());
  formats::write_cloud(scratch.path("zero.ply"), cloud);
  EXPECT_FALSE(formats::open_parts(scratch.path("zero.ply"), 10));
  cloud.normals[39] = Vec3(0, 0, 1);
  formats::write_cloud(scratch.path("one.ply"), cloud);
  EXPECT_TRUE(formats::open_parts(scratch.path("one.ply"), 10));
  formats::write_cloud(scratch.path("text.ply"), cloud, {.ascii = true});
  EXPECT_FALSE(formats::open_parts(scratch.path("text.ply"), 10));
  cloud.labels.clear();
  cloud.attributes.push_back(make_attribute("scalar_label", std::vector<float>(40, 1.5F)));
  formats::write_cloud(scratch.path("float.ply"), cloud);
  EXPECT_FALSE(formats::open_parts(scratch.path("float.ply"), 10));
  formats::write_cloud(scratch.path("none.las"), grid_cloud(0));
  EXPECT_FALSE(formats::open_parts(scratch.path("none.las"), 10));
  formats::write_cloud(scratch.path("a.pcd"), cloud);
  EXPECT_FALSE(formats::open_parts(scratch.path("a.pcd"), 10));
}

TEST(PartChoices, ScansOfE57AreParts) {
  const Scratch scratch;
  const auto scan = [](std::size_t points, const std::vector<std::int64_t>& states) {
    std::vector<double> x;
    for (std::size_t i = 0; i < points; ++i) x.push_back(static_cast<double>(i) + 0.25);
    return E57TestScan{
        "",
        {e57_double("cartesianX", x), e57_double("cartesianY", x), e57_double("cartesianZ", x),
         e57_integer("cartesianInvalidState", 0, 2, states)},
        points};
  };
  E57TestScan last = scan(2, {0, 0});
  last.fields.push_back(e57_integer("isIntensityInvalid", 0, 1, {0, 1}));
  const auto file = scratch.file(
      "a.e57", e57_file({scan(3, {0, 2, 0}), scan(0, {}), scan(1, {2}), scan(3, {0, 0, 0}), last}));
  const LoadedCloud whole = formats::read_cloud(file);
  const auto reader = formats::open_parts(file);
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->points(), 7U);
  EXPECT_EQ(reader->parts(), 3U);
  EXPECT_EQ(reader->warnings, whole.warnings);
  for (const char* name : {"o.ply", "o.las", "o.csv"}) {
    copy(*reader, scratch.path(name));
    const auto expected = scratch.path(std::string("whole_") + name);
    formats::write_cloud(expected, whole.cloud);
    EXPECT_EQ(bytes_of(scratch.path(name)), bytes_of(expected)) << name;
  }
}

TEST(PartChoices, WarningsCountAllParts) {
  PartTally tally;
  for (int p = 0; p < 2; ++p) {
    PointCloud part;
    part.positions = {Vec3(0, 0, 0), Vec3(0, std::numeric_limits<double>::quiet_NaN(), 0)};
    part.normals = {Vec3(0, 0, 2), Vec3(0, 0, 0)};
    finish_part(part, tally);
    EXPECT_EQ(part.normals[0], Vec3(0, 0, 1));
  }
  EXPECT_EQ(tally.rescaled_normals, 2U);
  EXPECT_EQ(warnings_of(tally), (std::vector<std::string>{"2 of 4 normals are zero or not finite",
                                                          "2 of 4 positions are not finite"}));
}

TEST(PartWriter, RefusesPartsThatDifferAndLeavesNothingBehind) {
  const Scratch scratch;
  const PointCloud first = grid_cloud(10);
  PointCloud other = grid_cloud(10);
  other.attributes.pop_back();
  const EachPart each_part = [&](const auto& visit) { visit(first) && visit(other); };
  for (const char* name : {"a.ply", "a.las", "a.csv"}) {
    const auto path = scratch.path(name);
    {
      const auto writer =
          formats::create_parts(path, {20, &first, each_part, false}, WriteOptions{});
      writer->append(first);
      error_of(ErrorKind::kFailure, [&] { writer->append(other); });
    }
    EXPECT_FALSE(std::filesystem::exists(path)) << name;
  }
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path("")));
}

TEST(PartReader, NamesThePlaceOfADamagedPart) {
  const Scratch scratch;
  formats::write_cloud(scratch.path("a.laz"), grid_cloud(120'000));
  std::string bytes = bytes_of(scratch.path("a.laz"));
  const auto reader = formats::open_parts(scratch.path("a.laz"), 30'000);
  ASSERT_TRUE(reader);
  const auto path = scratch.file("cut.las", bytes.substr(0, bytes.size() / 2));
  EXPECT_TRUE(
      contains(error_of(ErrorKind::kUnreadable, [&] { formats::open_parts(path, 1000); }), "byte"));
}

}  // namespace
}  // namespace pcednet::io
