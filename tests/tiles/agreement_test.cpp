#include "pcednet/tiles/agreement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "io/las/las_writer.h"
#include "pcednet/io/las/file.h"
#include "pcednet/tiles/las_steps.h"
#include "support/own_folder.h"

namespace pcednet::tiles {
namespace {

using io::LasTestFile;

constexpr const char* kUtm =
    R"(PROJCS["UTM 32N",GEOGCS["ETRS89",AUTHORITY["EPSG","4258"]],UNIT["metre",1],)"
    R"(AUTHORITY["EPSG","25832"]])";

LasTestFile some_points(unsigned format = 6) {
  return {.format = format, .rows = io::las_test_rows(format, 500)};
}

io::LasTestRecord system_with_heights(const std::string& code, const char* name = "heights") {
  const std::string authority = code.empty() ? "" : fmt::format(R"(,AUTHORITY["EPSG","{}"])", code);
  return {
      "LASF_Projection", 2112,
      fmt::format(R"(COMPD_CS["both",{},VERT_CS["{}",UNIT["metre",1]{}]])", kUtm, name, authority)};
}

/// Two inputs of a plan.
class Agreement : public testing::Test, protected test::OwnFolder {
 protected:
  IndexedInput indexed(const std::string& name, const LasTestFile& file) const {
    std::ofstream(folder_ / name, std::ios::binary) << io::las_bytes(file);
    std::vector<std::string> notes;
    return index_input(folder_ / name, nullptr, notes, [](const PointCloud&) {});
  }

  /// The reason for which two files are refused; empty if they are not. The notes are in plan_.
  std::string refused(const LasTestFile& a, const LasTestFile& b) {
    plan_ = {};
    try {
      std::vector<IndexedInput> inputs = {indexed("a.las", a), indexed("b.las", b)};
      check_agreement(inputs, plan_);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      const std::string said = error.what();
      const std::string names =
          fmt::format("{}/a.las and {}/b.las ", folder_.string(), folder_.string());
      EXPECT_TRUE(said.starts_with(names)) << said;
      return said.substr(std::min(said.size(), names.size()));
    }
    return "";
  }

  Plan plan_;
};

TEST_F(Agreement, TakesTheColumnsOfAll) {
  const LasTestFile a = some_points();
  EXPECT_EQ(refused(a, a), "");
  EXPECT_EQ(plan_.forms, (std::vector<std::size_t>{0}));
  EXPECT_TRUE(plan_.notes.empty());
  EXPECT_EQ(refused(some_points(8), a), "");
  EXPECT_EQ(plan_.forms, (std::vector<std::size_t>{0}));
  EXPECT_EQ(refused(a, some_points(7)), "");
  EXPECT_EQ(plan_.forms, (std::vector<std::size_t>{0, 1}));
  ASSERT_EQ(plan_.notes.size(), 1u);
  EXPECT_EQ(plan_.notes[0],
            "the inputs have different columns: the tiles have all, with 0 where an input has "
            "none: Blue, Green, Red");
}

TEST_F(Agreement, CountsNumbersOfScansForColumnsOfAll) {
  LasTestFile scans{.rows = io::las_test_rows(6, 100, 4), .extra = 4};
  scans.records = {{"LASF_Spec", 4, io::las_test_extra("scan", 6)},
                   {"pcednet", 1, "scanner 0: 1 2 3\nscanner 1: 4 5 6\n"}};
  std::vector<IndexedInput> inputs = {indexed("a.las", some_points()), indexed("b.las", scans)};
  choose_scanners(inputs, {}, plan_);
  ASSERT_EQ(plan_.scanners.size(), 3u);
  plan_.notes.clear();
  check_agreement(inputs, plan_);
  EXPECT_TRUE(plan_.notes.empty());
  EXPECT_EQ(plan_.forms, (std::vector<std::size_t>{0}));
}

TEST_F(Agreement, NamesTheColumnsThatCannotBeZero) {
  LasTestFile a{.rows = io::las_test_rows(6, 100, 1), .extra = 1};
  LasTestFile b = a;
  a.records = {{"LASF_Spec", 4, io::las_test_extra("Deviation", 1)}};
  b.records = {{"LASF_Spec", 4, io::las_test_extra("label", 1)}};
  EXPECT_EQ(refused(a, b), "have different columns; only " + (folder_ / "a.las").string() +
                               " has Deviation (1 of 1 bytes); only " +
                               (folder_ / "b.las").string() + " has labels: plan them one by one");
}

TEST_F(Agreement, NeedsDescriptionsOfExtraBytesThatDiffer) {
  LasTestFile a{.rows = io::las_test_rows(6, 100, 1), .extra = 1};
  EXPECT_EQ(refused(a, a), "");
  const std::string difference = "have different columns or headers, and ";
  EXPECT_TRUE(refused(some_points(), a).starts_with(difference));
  EXPECT_TRUE(
      refused(a, {.rows = io::las_test_rows(6, 100, 2), .extra = 2}).starts_with(difference));
  LasTestFile named = a;
  named.records = {{"LASF_Projection", 2112, kUtm}};
  EXPECT_EQ(refused(named, a), "");
  EXPECT_TRUE(refused(a, named).starts_with(difference));
}

TEST_F(Agreement, LeavesOutExtraBytesOfAnotherMeaning) {
  LasTestFile a{.rows = io::las_test_rows(6, 100, 2), .extra = 2};
  const auto with = [&](unsigned options, double scale, double offset, double no_data, double least,
                        unsigned type = 3) {
    std::string entry = io::las_test_extra("Height", type, options);
    io::set_number(entry, 40, no_data);
    io::set_number(entry, 64, least);
    io::set_number(entry, 112, scale);
    io::set_number(entry, 136, offset);
    LasTestFile file = a;
    file.records = {{"LASF_Spec", 4, entry}};
    return file;
  };
  const LasTestFile first = with(8, 0.01, 0.0, 0.0, 0.0);
  const auto leaves_out = [&](const LasTestFile& other) {
    std::vector<IndexedInput> inputs = {indexed("a.las", first), indexed("b.las", other)};
    plan_ = {};
    check_agreement(inputs, plan_);
    EXPECT_TRUE(inputs[0].input.left_out.empty());
    return inputs[1].input.left_out == std::vector<std::string>{"Height"};
  };
  EXPECT_TRUE(leaves_out(with(8, 0.1, 0.0, 0.0, 0.0)));
  ASSERT_EQ(plan_.notes.size(), 1u);
  EXPECT_EQ(plan_.notes[0],
            fmt::format("{0}/b.las: Height has another type, scale, offset or no-data value than "
                        "in {0}/a.las: 0 in the tiles",
                        folder_.string()));
  EXPECT_TRUE(leaves_out(with(24, 0.01, 5.0, 0.0, 0.0)));
  EXPECT_TRUE(leaves_out(with(9, 0.01, 0.0, -1.0, 0.0)));
  EXPECT_TRUE(leaves_out(with(0, 0.01, 0.0, 0.0, 0.0)));
  EXPECT_TRUE(leaves_out(with(8, 0.01, 0.0, 0.0, 0.0, 4)));
  // What is not said to be there means nothing; ranges may differ.
  EXPECT_FALSE(leaves_out(first));
  EXPECT_FALSE(leaves_out(with(24, 0.01, 0.0, 7.0, 3.0)));
  EXPECT_FALSE(leaves_out(with(10, 0.01, 9.0, 7.0, 3.0)));
  EXPECT_TRUE(plan_.notes.empty());
}

TEST_F(Agreement, NeedsOneSystemOfHeights) {
  const auto with = [](const io::LasTestRecord& record) {
    LasTestFile file = some_points();
    file.records = {record};
    return file;
  };
  const LasTestFile plain = with({"LASF_Projection", 2112, kUtm});
  const LasTestFile coded = with(system_with_heights("7837"));
  EXPECT_EQ(refused(coded, coded), "");
  EXPECT_EQ(refused(plain, with({"LASF_Projection", 2112, std::string(kUtm) + " "})), "");
  EXPECT_EQ(refused(coded, with(system_with_heights("7837", "other name"))), "");
  EXPECT_TRUE(refused(coded, with(system_with_heights("5783")))
                  .starts_with("have different coordinate systems: EPSG 25832+7837, and "
                               "25832+5783"));
  EXPECT_TRUE(
      refused(with(system_with_heights("", "DHHN92")), with(system_with_heights("", "DHHN2016")))
          .starts_with("have different coordinate systems"));
  const auto as_esri = [&](const char* name) {
    return with(
        {"LASF_Projection", 2112, fmt::format(R"({},VERTCS["{}",UNIT["Meter",1.0]])", kUtm, name)});
  };
  EXPECT_EQ(refused(as_esri("DHHN92"), as_esri("DHHN92")), "");
  EXPECT_TRUE(refused(as_esri("DHHN92"), as_esri("DHHN2016"))
                  .starts_with("have different coordinate systems"));
}

TEST_F(Agreement, TakesASystemThatIsNotNamedForThatOfTheOthers) {
  LasTestFile plain = some_points(), coded = plain;
  plain.records = {{"LASF_Projection", 2112, kUtm}};
  coded.records = {system_with_heights("7837")};
  const auto noted = [&](const LasTestFile& a, const LasTestFile& b) {
    EXPECT_EQ(refused(a, b), "");
    return plan_.notes.size() == 1 ? plan_.notes[0] : "";
  };
  const std::string a = (folder_ / "a.las").string(), b = (folder_ / "b.las").string();
  const std::string no_system = ": no coordinate system is named: taken for that of ";
  const std::string no_heights = ": no system of heights is named: taken for that of ";
  EXPECT_EQ(noted(plain, some_points()), b + no_system + a);
  EXPECT_EQ(plan_.forms, (std::vector<std::size_t>{0}));
  EXPECT_EQ(noted(some_points(), plain), a + no_system + b);
  EXPECT_EQ(plan_.forms, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(noted(plain, coded), a + no_heights + b);
  EXPECT_EQ(noted(coded, plain), b + no_heights + a);
  LasTestFile other = plain;
  other.records = {
      {"LASF_Projection", 2112, R"(PROJCS["UTM 33N",UNIT["metre",1],AUTHORITY["EPSG","25833"]])"}};
  EXPECT_EQ(refused(coded, other),
            "have different coordinate systems: EPSG 25832+7837, and 25833: plan them one by one");
}

TEST_F(Agreement, LeavesOutTimesThatCountFromElsewhere) {
  const auto encoded = [&](const std::string& name, LasTestFile file, unsigned encoding) {
    std::string bytes = io::las_bytes(file);
    io::set_number(bytes, 6, static_cast<std::uint16_t>(encoding));
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    std::vector<std::string> notes;
    return index_input(folder_ / name, nullptr, notes, [](const PointCloud&) {});
  };
  const auto agree = [&](unsigned format, unsigned minor, unsigned its, unsigned others,
                         unsigned offset = 1000) {
    LasTestFile a = some_points(format);
    a.minor = minor;
    LasTestFile b = a;
    b.time_offset = offset;
    std::vector<IndexedInput> inputs = {encoded("a.las", a, its), encoded("b.las", b, others)};
    plan_ = {};
    check_agreement(inputs, plan_);
    return inputs[1].input.left_out.empty();
  };
  EXPECT_TRUE(agree(6, 4, 17, 17));
  EXPECT_FALSE(agree(6, 4, 17, 16));
  EXPECT_TRUE(agree(0, 2, 1, 0));  // no times
  EXPECT_FALSE(agree(1, 2, 1, 0));
  EXPECT_TRUE(agree(6, 5, 17, 17, 1200));
  EXPECT_FALSE(agree(6, 5, 81, 81, 1200));
  EXPECT_FALSE(agree(6, 5, 81, 17));
  ASSERT_EQ(plan_.notes.size(), 1u);
  EXPECT_EQ(
      plan_.notes[0],
      fmt::format("{0}/b.las: GpsTime has another base (seconds of the week, or adjusted) than in "
                  "{0}/a.las: 0 in the tiles",
                  folder_.string()));
  // Times of 0 are none.
  LasTestFile timed = some_points(6), untimed = timed;
  for (std::size_t at = 22; at < untimed.rows.size(); at += io::las_test_stride(6)) {
    io::set_number(untimed.rows, at, 0.0);
  }
  std::vector<IndexedInput> inputs = {encoded("a.las", untimed, 16), encoded("b.las", timed, 17)};
  check_agreement(inputs, plan_);
  EXPECT_TRUE(inputs[0].input.left_out.empty() && inputs[1].input.left_out.empty());
  EXPECT_EQ(plan_.forms, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(plan_.timed, 1u);
  // Only the header of the first can hold an offset.
  timed.minor = 5;
  inputs = {encoded("a.las", untimed, 17), encoded("b.las", timed, 81)};
  check_agreement(inputs, plan_);
  EXPECT_EQ(inputs[1].input.left_out, std::vector<std::string>{"GpsTime"});
  EXPECT_EQ(plan_.timed, 0u);
}

TEST_F(Agreement, RefusesSeveralInputsWithWaveforms) {
  LasTestFile waves = some_points(9), plain = some_points(9);
  waves.records = {{"LASF_Spec", 100, std::string(26, '\0')}};
  waves.extended = {{"LASF_Spec", 65535, "waves"}};
  EXPECT_EQ(refused(plain, plain), "");
  for (const auto& [a, b] : {std::pair(waves, waves), {plain, waves}, {waves, plain}}) {
    EXPECT_TRUE(refused(a, b).starts_with("have waveforms"));
  }
  std::vector<IndexedInput> alone = {indexed("a.las", waves)};
  EXPECT_NO_THROW(check_agreement(alone, plan_));
}

TEST_F(Agreement, NotesRecordsThatGoMissing) {
  LasTestFile a = some_points(), b = some_points();
  a.records = {{"survey", 1, "of a"}, {"survey", 2, "of all"}};
  b.records = a.records;
  EXPECT_EQ(refused(a, b), "");
  EXPECT_TRUE(plan_.notes.empty());
  b.records = {{"survey", 1, "of b"}, {"survey", 2, "of all"}};
  b.extended = {{"project", 42, "b only"}};
  EXPECT_EQ(refused(a, b), "");
  ASSERT_EQ(plan_.notes.size(), 1u);
  EXPECT_EQ(plan_.notes[0], "the tiles have the records of " + (folder_ / "a.las").string() +
                                "; those of other inputs are left out: survey 1, project 42");
}

TEST_F(Agreement, TakesTheFinestStepsOfEachAxis) {
  LasTestFile a = some_points(), b = some_points();
  a.scale = {0.001, 0.001, 0.01}, a.offset = {0.0, 0.0, 0.0};
  b.scale = {0.01, 0.001, 0.001}, b.offset = {10.0, 0.0, 0.0};
  choose_las_steps({indexed("a.las", a), indexed("b.las", b)}, plan_);
  EXPECT_EQ(plan_.las_steps, (std::vector<double>{0.001, 0.0, 0.001, 0.0, 0.001, 0.0}));
  EXPECT_TRUE(plan_.notes.empty());
  b.scale[0] = 0.0025;
  plan_ = {};
  choose_las_steps({indexed("a.las", a), indexed("b.las", b)}, plan_);
  ASSERT_EQ(plan_.notes.size(), 1u);
  EXPECT_EQ(plan_.notes[0],
            "the inputs have different scales and offsets: coordinates are rounded "
            "to steps of 0.001");
}

TEST_F(Agreement, KeepsTheStepsOfASingleInput) {
  LasTestFile a = some_points();
  a.offset = {0.0, 0.0, 0.0};
  io::set_number(a.rows, 4, INT32_MIN);
  const IndexedInput input = indexed("a.las", a);
  plan_.box = input.input.chunks[0].box;
  choose_las_steps({input}, plan_);
  EXPECT_EQ(plan_.las_steps, (std::vector<double>{0.001, 0.0, 0.001, 0.0, 0.0005, 0.0}));
  // Both limits count for several, too.
  Plan two{.box = plan_.box};
  choose_las_steps({input, input}, two);
  EXPECT_EQ(two.las_steps, plan_.las_steps);
  EXPECT_TRUE(two.notes.empty());
  two = {.box = plan_.box};
  two.box.min.y() -= 0.001;
  choose_las_steps({input, input}, two);
  EXPECT_EQ(two.las_steps[2], 0.01);
  ASSERT_EQ(two.notes.size(), 1u);
  EXPECT_EQ(two.notes[0],
            "no steps of the inputs hold them all in 32 bits: coordinates are rounded "
            "to steps of 0.01");
}

TEST_F(Agreement, LeavesTheRangesOfOneInputsExtraBytesOut) {
  LasTestFile a{.rows = io::las_test_rows(6, 100, 2), .extra = 2};
  std::string entry = io::las_test_extra("Height", 3, 14);
  for (const std::size_t at : {64, 88, 112}) io::set_number(entry, at, 0.5);
  a.records = {{"LASF_Spec", 4, entry}};
  plan_.inputs = {indexed("a.las", a).input};
  plan_.las_steps = {0.001, 0.0, 0.001, 0.0, 0.001, 0.0};
  const auto described = [&] { return io::attached_las_file(outline_of(plan_)).records[0].data; };
  EXPECT_EQ(described(), entry);
  plan_.inputs.push_back(indexed("b.las", a).input);
  for (std::size_t at = 64; at < 112; ++at) entry[at] = '\0';
  entry[3] = 8;
  EXPECT_EQ(described(), entry);
}

}  // namespace
}  // namespace pcednet::tiles
