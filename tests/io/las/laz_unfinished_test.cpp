// LAZ whose header counts other points than its chunks hold, as where writing was interrupted.
#include <gtest/gtest.h>

#include "io/las/laz_writer.h"
#include "pcednet/formats/write_cloud.h"

namespace pcednet::io {
namespace {

struct Sample {
  LasTestFile file;
  PointCloud cloud;
};

Sample sample_of(const Scratch& scratch, unsigned format) {
  LasTestFile file{format, 4, las_test_rows(format, 90, 2, 3), 2};
  file.before_points = "bytes of nobody";
  return {file, scratch.read("whole.las", las_bytes(file)).cloud};
}

/// The first points alone, with one warning: what it says.
std::string warning_of(const Scratch& scratch, const Sample& sample, const std::string& bytes,
                       std::size_t points) {
  const LoadedCloud loaded = scratch.read("odd.laz", bytes);
  EXPECT_EQ(loaded.cloud.size(), points);
  EXPECT_EQ(loaded.warnings.size(), 1u);
  for (const Attribute& attribute : loaded.cloud.attributes) {
    const Attribute* whole = find_attribute(sample.cloud, attribute.name);
    const std::size_t count = points * attribute.stride();
    EXPECT_TRUE(std::equal(attribute.bytes.begin(),
                           attribute.bytes.begin() + static_cast<std::ptrdiff_t>(count),
                           whole->bytes.begin()))
        << attribute.name;
  }
  EXPECT_TRUE(std::equal(loaded.cloud.positions.begin(), loaded.cloud.positions.end(),
                         sample.cloud.positions.begin()));
  return loaded.warnings.empty() ? "" : loaded.warnings[0];
}

std::string counting(const std::string& bytes, std::uint64_t points) {
  const bool narrow = get_number<std::uint32_t>(bytes, 107) > 0;
  return with(with(bytes, 247, points), 107, static_cast<std::uint32_t>(narrow ? points : 0));
}

TEST(LazUnfinished, WarnsOfPointsBehindThoseThatTheHeaderCounts) {
  const Scratch scratch;
  for (const unsigned format : {3U, 8U}) {
    const Sample sample = sample_of(scratch, format);
    const std::string any = laz_bytes(sample.file, {.chunks = {40, 30, 20}});
    const std::string counts = "the header counts 60 points and the chunks ";
    EXPECT_EQ(warning_of(scratch, sample, counting(any, 60), 60),
              counts + "hold 30 more: these are left out");
    // Pointwise, the last of equal chunks does not say how many it has.
    const std::string same = laz_bytes(sample.file, {.chunks = {40, 40, 10}, .fixed_size = true});
    EXPECT_EQ(warning_of(scratch, sample, counting(same, 60), 60),
              counts + (format < 6 ? "have room for 40" : "hold 30") + " more: these are left out");
  }
}

TEST(LazUnfinished, ReadsTheChunksOfATableThatTheHeaderDoesNotCount) {
  const Scratch scratch;
  for (const unsigned format : {3U, 8U}) {
    const Sample sample = sample_of(scratch, format);
    const std::string any = laz_bytes(sample.file, {.chunks = {40, 30, 20}});
    EXPECT_EQ(warning_of(scratch, sample, counting(any, 0), 90),
              "the header counts no points, as where writing was interrupted: the 90 of 3 whole "
              "chunks are read");
    formats::write_cloud(scratch.path("back.las"),
                         formats::read_cloud(scratch.path("odd.laz")).cloud,
                         {.overwrite = Overwrite::kYes});
    EXPECT_TRUE(bytes_of(scratch.path("back.las")) == las_bytes(sample.file));
  }
}

TEST(LazUnfinished, CountsTheLastChunkOnlyWhereItTellsItsPoints) {
  const Scratch scratch;
  const LazTestLayout layout{.chunks = {40, 40, 10}, .fixed_size = true};
  const Sample layered = sample_of(scratch, 8), pointwise = sample_of(scratch, 3);
  EXPECT_TRUE(
      contains(warning_of(scratch, layered, counting(laz_bytes(layered.file, layout), 0), 90),
               "the 90 of 3"));
  EXPECT_EQ(warning_of(scratch, pointwise, counting(laz_bytes(pointwise.file, layout), 0), 80),
            "the header counts no points, as where writing was interrupted: the 80 of 2 whole "
            "chunks are read; the last chunk does not say how many it has, and is left out");
}

TEST(LazUnfinished, FindsLayeredChunksWithoutATable) {
  const Scratch scratch;
  const Sample sample = sample_of(scratch, 8);
  const std::string whole = laz_bytes(sample.file, {.chunks = {40, 40, 10}, .fixed_size = true});
  const std::size_t points = get_number<std::uint32_t>(whole, 96);
  const auto table = get_number<std::uint64_t>(whole, points);
  // LASzip leaves the place of the eight bytes themselves there, others -1 or 0.
  for (const std::uint64_t place : {std::uint64_t{points}, UINT64_MAX, std::uint64_t{0}}) {
    const std::string cut = with(counting(whole, 0), points, place).substr(0, table);
    EXPECT_TRUE(contains(warning_of(scratch, sample, cut, 90), "the 90 of 3 whole chunks"));
    const std::string shorter = cut.substr(0, table - 1);
    EXPECT_TRUE(contains(warning_of(scratch, sample, shorter, 80), "the 80 of 2 whole chunks"));
    EXPECT_TRUE(
        contains(warning_of(scratch, sample, cut + std::string(300, 'x'), 90), "the 90 of"));
    const std::string none = cut.substr(0, points + 300);
    EXPECT_TRUE(contains(message_of(scratch, none), "byte 247: no points, though 300 bytes"));
  }
}

TEST(LazUnfinished, SaysThatPointwiseChunksCannotBeFoundWithoutATable) {
  const Scratch scratch;
  const Sample sample = sample_of(scratch, 3);
  const std::string whole = laz_bytes(sample.file, {.chunks = {40, 50}});
  const std::size_t points = get_number<std::uint32_t>(whole, 96);
  const std::string cut = with(whole, points, std::uint64_t{points});
  EXPECT_TRUE(
      contains(message_of(scratch, counting(cut, 0)), "writing of the file was interrupted"));
  EXPECT_TRUE(contains(message_of(scratch, cut), "or its writing was interrupted"));
}

TEST(LazUnfinished, TakesAnEmptyFileForOne) {
  const Scratch scratch;
  for (const unsigned format : {3U, 8U}) {
    LasTestFile file{format, 4};
    file.extended = {{"somebody", 8, std::string(500, 'x')}};
    std::string bytes = laz_bytes(file, {.chunks = {}});
    set_number(bytes, 235, std::uint64_t{bytes.size()});
    for (const LasTestRecord& record : file.extended) bytes += las_test_record(record, true);
    const std::size_t points = get_number<std::uint32_t>(bytes, 96);
    const auto table = get_number<std::uint64_t>(bytes, points);
    const std::size_t table_bytes = get_number<std::uint64_t>(bytes, 235) - table;
    const std::string tableless = with(bytes, points, UINT64_MAX).erase(table, table_bytes);
    for (const std::string& empty : {bytes, with(tableless, 235, table)}) {
      const LoadedCloud loaded = scratch.read("empty.laz", empty);
      EXPECT_EQ(loaded.cloud.size(), 0u);
      EXPECT_TRUE(loaded.warnings.empty());
    }
  }
}

TEST(LazUnfinished, SurvivesDamageAnywhere) {
  const Scratch scratch;
  Random random(5);
  for (const unsigned format : {3U, 8U}) {
    const LasTestFile file{format, 4, las_test_rows(format, 40, 2, 4), 2};
    const std::string whole =
        counting(laz_bytes(file, {.chunks = {15, 15, 10}, .fixed_size = true}), 0);
    expect_to_survive_damage(scratch, "odd.laz", whole, 227, 300, random);
  }
}

}  // namespace
}  // namespace pcednet::io
