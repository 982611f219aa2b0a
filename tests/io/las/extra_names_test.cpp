
#include <gtest/gtest.h>

#include "io/las/las_writer.h"
#include "pcednet/formats/parts.h"
#include "pcednet/formats/write_cloud.h"

namespace pcednet::io {
namespace {

using NameList = std::vector<std::string>;

/// The names of extra bytes in a LAS file, one after the other.
NameList extra_names_in(const std::string& bytes) {
  NameList names;
  const std::size_t head = bytes.find("LASF_Spec") - 2;
  const auto length = get_number<std::uint16_t>(bytes, head + 20);
  for (std::size_t at = head + 54; at < head + 54 + length; at += 192) {
    const std::string name = bytes.substr(at + 4, 32);
    names.push_back(name.substr(0, name.find('\0')));
  }
  return names;
}

struct NamedRound {
  NameList names = {}, losses = {};
  PointCloud back = {};
};

NamedRound written_as_las(const Scratch& scratch, const PointCloud& cloud) {
  const auto path = scratch.path("out.las");
  formats::write_cloud(path, cloud, {.overwrite = Overwrite::kYes});
  return {extra_names_in(bytes_of(path)), formats::losses(path, cloud),
          formats::read_cloud(path).cloud};
}

PointCloud cloud_named(const NameList& names) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  for (const std::string& name : names) {
    const auto number = static_cast<float>(cloud.attributes.size());
    cloud.attributes.push_back(make_attribute(name, std::vector<float>{number}));
  }
  return cloud;
}

TEST(LasExtraNames, KeepThirtyTwoBytesWithoutALoss) {
  const Scratch scratch;
  const NameList names = {"a", "scalar_of_just_thirty-two bytes_", "scalar_p_sharp"};
  const NamedRound written = written_as_las(scratch, cloud_named(names));
  EXPECT_EQ(names[1].size(), 32u);
  EXPECT_EQ(written.names, (NameList{"a", names[1], "p_sharp"}));
  EXPECT_EQ(written.losses, NameList{});
  for (const std::string& name : names) EXPECT_TRUE(find_attribute(written.back, name)) << name;
}

TEST(LasExtraNames, StayDifferentWhereTheyAreCut) {
  const Scratch scratch;
  const std::string start = "scalar_distance_to_the_reference";
  ASSERT_EQ(start.size(), 32u);
  // The last one fits, so that no other may become it.
  const NameList names = {start + "_mesh", start + "_cloud", start};
  const NamedRound written = written_as_las(scratch, cloud_named(names));
  const NameList cut = {"scalar_distance_to_the_referen_2", "scalar_distance_to_the_referen_3",
                        start};
  EXPECT_EQ(written.names, cut);
  for (std::size_t a = 0; a < cut.size(); ++a) {
    ASSERT_TRUE(find_attribute(written.back, cut[a]));
    EXPECT_EQ(find_attribute(written.back, cut[a])->value(0), static_cast<double>(a));
  }
  EXPECT_EQ(
      written.losses,
      (NameList{
          "the name of " + names[0] + ", which becomes " + cut[0] + ": LAS has 32 bytes for it",
          "the name of " + names[1] + ", which becomes " + cut[1] + ": LAS has 32 bytes for it"}));
}

TEST(LasExtraNames, DifferFromThoseOfTheFile) {
  const Scratch scratch;
  const std::string own = "thirty-two bytes of another file";
  LasTestFile file{.rows = las_test_rows(6, 3, 1), .extra = 1};
  file.records = {{"LASF_Spec", 4, las_test_extra(own, 1)}};
  PointCloud cloud = scratch.read("in.las", las_bytes(file)).cloud;
  cloud.attributes.push_back(make_attribute(own + " and more", std::vector<std::uint8_t>(3)));
  EXPECT_EQ(written_as_las(scratch, cloud).names, (NameList{own, own.substr(0, 30) + "_2"}));
}

TEST(LasExtraNames, EndWithAWholeCharacter) {
  const Scratch scratch;
  const std::string latin = "\xC3\xB6", han = "\xE9\xAB\x98", smile = "\xF0\x9F\x98\x80";
  const auto cut = [&](const std::string& name) {
    return written_as_las(scratch, cloud_named({name})).names.at(0);
  };
  for (const std::string& character : {latin, han, smile}) {
    for (std::size_t before = 28; before <= 32; ++before) {
      const std::string start(before, 'a'), rest = character + "bcde";
      const std::size_t kept = before + character.size() <= 32 ? character.size() : 0;
      const std::string whole = (start + rest).substr(0, 32);
      EXPECT_EQ(cut(start + rest), kept > 0 ? whole : start) << before << character;
    }
  }
  const std::string no_text(40, '\x80');
  EXPECT_EQ(cut(no_text), no_text.substr(0, 32));
}

TEST(LasExtraNames, NumberTheComponentsOfArrays) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  const auto add = [&](const std::string& name, std::size_t components) {
    cloud.attributes.push_back(
        {name, ScalarType::kUint8, components, std::vector<std::byte>(components)});
  };
  const std::string fits(29, 'f'), start(28, 's');
  add(fits, 2);
  add(start + "one", 11);
  add(start + "two", 2);
  const NamedRound written = written_as_las(scratch, cloud);
  EXPECT_EQ(written.names[0], fits + "[0]");
  EXPECT_EQ(written.names[1], fits + "[1]");
  EXPECT_EQ(written.names[2], start + "[0]");
  EXPECT_EQ(written.names[12], start + "[10]");
  EXPECT_EQ(written.names[13], start + "t[0]");
  EXPECT_EQ(written.losses, (NameList{"the name of " + start + "one, which becomes " + start +
                                          "[0] to " + start + "[10]: LAS has 32 bytes for it",
                                      "the name of " + start + "two, which becomes " + start +
                                          "t[0] to " + start + "t[1]: LAS has 32 bytes for it"}));
}

TEST(LasExtraNames, AreTheSameInParts) {
  const Scratch scratch;
  const std::string name(40, 'n');
  const PointCloud cloud = cloud_named({name + "1", name + "2"});
  const auto outline = outline_of(cloud);
  const auto writer = formats::create_parts(scratch.path("parts.las"), outline, {});
  writer->append(cloud);
  writer->append(cloud);
  writer->commit();
  EXPECT_EQ(writer->losses, formats::losses("a.las", cloud));
  EXPECT_EQ(writer->losses.size(), 2u);
  EXPECT_EQ(extra_names_in(bytes_of(scratch.path("parts.las"))),
            (NameList{name.substr(0, 32), name.substr(0, 30) + "_2"}));
}

}  // namespace
}  // namespace pcednet::io
