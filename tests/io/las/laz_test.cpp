#include "pcednet/io/las/laz.h"

#include <gtest/gtest.h>

#include "io/las/laz_writer.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/las/facts.h"

namespace pcednet::io {
namespace {

std::string converted(const Scratch& scratch, const std::string& from, const std::string& to) {
  formats::write_cloud(scratch.path(to), formats::read_cloud(scratch.path(from)).cloud,
                       {.overwrite = Overwrite::kYes});
  return bytes_of(scratch.path(to));
}

/// Expects the points, fields and records of `a` in `b`, bit for bit.
void expect_equal(const PointCloud& a, const PointCloud& b, unsigned format) {
  EXPECT_TRUE(same_bits(a.positions, b.positions)) << "format " << format;
  ASSERT_EQ(a.attributes.size(), b.attributes.size());
  for (std::size_t i = 0; i < a.attributes.size(); ++i) {
    EXPECT_EQ(a.attributes[i].name, b.attributes[i].name);
    EXPECT_TRUE(same_bits(a.attributes[i].bytes, b.attributes[i].bytes))
        << "format " << format << ": " << a.attributes[i].name;
  }
  const auto records = [](const PointCloud& cloud, const char* which) {
    for (const ForeignElement& element : cloud.foreign_elements) {
      if (contains(element.header, which)) return element.bytes;
    }
    return decltype(ForeignElement::bytes)();
  };
  for (const char* which : {"las_vlrs", "las_evlrs"}) {
    EXPECT_TRUE(same_bits(records(a, which), records(b, which))) << which;
  }
}

/// Compresses a file and expects all of it back; its compressed bytes.
std::string expect_same(const Scratch& scratch, const LasTestFile& file) {
  const PointCloud cloud = scratch.read("in.las", las_bytes(file)).cloud;
  formats::write_cloud(scratch.path("packed.laz"), cloud, {.overwrite = Overwrite::kYes});
  expect_equal(cloud, formats::read_cloud(scratch.path("packed.laz")).cloud, file.format);
  return bytes_of(scratch.path("packed.laz"));
}

TEST(Laz, GivesAWholeFileBackByteForByte) {
  const Scratch scratch;
  for (const unsigned format : {3U, 8U}) {
    LasTestFile file{format, 4, las_test_rows(format, 100)};
    file.records = {{"somebody", 7, "abc"}};
    file.extended = {{"somebody", 8, "abc"}};
    scratch.file("in.las", las_bytes(file));
    converted(scratch, "in.las", "packed.laz");
    EXPECT_TRUE(converted(scratch, "packed.laz", "back.las") == las_bytes(file)) << format;
  }
}

TEST(Laz, GivesEveryFormatBack) {
  const Scratch scratch;
  for (unsigned format = 0; format <= 10; ++format) {
    for (const std::size_t points : {0, 1, 2, 1000}) {
      LasTestFile file{format, 4, las_test_rows(format, points, points % 3, 4), points % 3};
      file.records = {{"somebody", 7, "abc"}};
      file.extended = {{"somebody", 8, "abc"}};
      const std::string packed = expect_same(scratch, file);
      EXPECT_EQ(get_number<std::uint8_t>(packed, 104), format + 128);
    }
  }
}

TEST(Laz, GivesChunksThatAreJustFullBack) {
  const Scratch scratch;
  for (const unsigned format : {2U, 6U}) {
    for (const std::size_t points : {50000, 50001}) {
      const std::string packed = expect_same(scratch, {format, 4, las_test_rows(format, points)});
      const auto table = get_number<std::uint64_t>(packed, get_number<std::uint32_t>(packed, 96));
      EXPECT_EQ(get_number<std::uint32_t>(packed, table + 4), (points + 49999) / 50000);
    }
  }
}

TEST(Laz, GivesNoiseAndConstantsBack) {
  const Scratch scratch;
  Random random(3);
  for (unsigned format = 0; format <= 10; ++format) {
    const std::size_t stride = las_test_stride(format, 4);
    LasTestFile file{format, 4, std::string(2000 * stride, '\0'), 4};
    for (char& byte : file.rows) byte = static_cast<char>(random.next());
    const std::size_t noise = expect_same(scratch, file).size();
    file.rows = "";
    const std::string row = las_test_rows(format, 1, 4);
    for (int i = 0; i < 2000; ++i) file.rows += row;
    EXPECT_LT(expect_same(scratch, file).size(), noise / 20);
  }
}

TEST(Laz, GivesManyConstantBytesOfEachPointBack) {
  const Scratch scratch;
  for (const unsigned format : {1U, 6U}) {
    constexpr std::size_t kBytes = 200;
    const std::string row = las_test_rows(format, 1, kBytes, 4);
    LasTestFile file{format, 4, "", kBytes};
    for (int i = 0; i < 50000; ++i) file.rows += row;
    EXPECT_LT(expect_same(scratch, file).size(), file.rows.size() / 64);
  }
}

void expect_read(const Scratch& scratch, const LasTestFile& file, const LazTestLayout& layout) {
  expect_equal(scratch.read("in.las", las_bytes(file)).cloud,
               scratch.read("in.laz", laz_bytes(file, layout)).cloud, file.format);
}

TEST(Laz, ReadsChunksOfAnySize) {
  const Scratch scratch;
  for (const unsigned format : {0U, 1U, 2U, 3U, 6U, 7U, 8U}) {
    const LasTestFile file{format, 4, las_test_rows(format, 700, 2, 3), 2};
    expect_read(scratch, file, {.chunks = {700}});
    expect_read(scratch, file, {.chunks = {1, 500, 0, 2, 197}});
    expect_read(scratch, file, {.chunks = {300, 400}, .table_at_end = true});
    expect_read(scratch, file, {.chunks = {300, 400}, .size_zero = true});
    expect_read(scratch, file, {.chunks = {350, 350}, .fixed_size = true});
    expect_read(scratch, file, {.chunks = {300, 300, 100}, .fixed_size = true});
    std::vector<std::size_t> single(700, 1);
    expect_read(scratch, file, {.chunks = single});
    if (format < 6) expect_read(scratch, file, {.chunks = {700}, .unchunked = true});
  }
}

TEST(Laz, ReadsItemsOfVersionFour) {
  const Scratch scratch;
  for (const unsigned format : {6U, 7U, 8U}) {
    for (const unsigned channels : {1U, 4U}) {
      const LasTestFile file{format, 4, las_test_rows(format, 500, 3, channels), 3};
      const LazTestLayout third{.chunks = {500}, .version = 3},
          fourth{.chunks = {500}, .version = 4};
      expect_read(scratch, file, third);
      expect_read(scratch, file, fourth);
      // The versions differ in what they predict after a change of the channel.
      const auto points = [&](const LazTestLayout& layout) {
        const std::string bytes = laz_bytes(file, layout);
        return bytes.substr(get_number<std::uint32_t>(bytes, 96));
      };
      EXPECT_EQ(points(third) == points(fourth), channels == 1);
    }
  }
}

TEST(Laz, LeavesOutTheIndexOfCopc) {
  const Scratch scratch;
  LasTestFile file{6, 4, las_test_rows(6, 50)};
  file.records = {{"copc", 1, std::string(160, 'i')}, {"somebody", 7, "abc"}};
  file.extended = {{"somebody", 8, "abc"}, {"copc", 1000, std::string(32, 'h')}};
  scratch.file("plain.las", las_bytes(file));
  EXPECT_TRUE(converted(scratch, "plain.las", "kept.las") == las_bytes(file));
  std::string whole = laz_bytes(file, {.chunks = {20, 30}});
  set_number(whole, 235, std::uint64_t{whole.size()});
  for (const LasTestRecord& record : file.extended) whole += las_test_record(record, true);
  scratch.file("in.laz", whole);
  file.records.erase(file.records.begin());
  file.extended.pop_back();
  EXPECT_TRUE(converted(scratch, "in.laz", "back.las") == las_bytes(file));
}

TEST(Laz, RefusesADamagedChunkTable) {
  const Scratch scratch;
  for (const unsigned format : {3U, 7U}) {
    const LasTestFile file{format, 4, las_test_rows(format, 100)};
    const std::string good = laz_bytes(file, {.chunks = {60, 40}});
    const std::size_t points = get_number<std::uint32_t>(good, 96);
    const auto table = get_number<std::uint64_t>(good, points);
    const auto expect = [&](const std::string& bytes, std::size_t byte, const char* what) {
      const std::string message = message_of(scratch, bytes);
      EXPECT_TRUE(contains(message, "odd.laz: byte " + std::to_string(byte) + ": ")) << message;
      EXPECT_TRUE(contains(message, what)) << message;
    };
    for (const std::int64_t place :
         {std::int64_t{0}, std::int64_t{-1}, std::int64_t{-2}, INT64_MAX, INT64_MIN,
          static_cast<std::int64_t>(points + 7), static_cast<std::int64_t>(good.size() - 7)}) {
      expect(with(good, points, place), points, "the chunk table is at byte");
    }
    expect(with(good, table + 4, UINT32_MAX), table, "4294967295 chunks");
    expect(with(good, table + 4, 1U), table, "chunks for 60 of 100 points");
    expect(with(good, table + 4, 0U), table, "chunks for 0 of 100 points");
    // A table of other sizes than the chunks have.
    const auto retabled = [&](std::vector<std::size_t> chunks, std::vector<std::size_t> bytes) {
      return good.substr(0, table) + test_chunk_table({.chunks = std::move(chunks)}, bytes);
    };
    const std::size_t body = table - points - 8;
    expect(retabled({60, 40}, {body / 2, body}), table, "chunk 1 of 40 points has");
    expect(retabled({60, 40}, {0, body}), table, "chunk 0 of 60 points has 0 bytes");
    expect(retabled({100}, {60}), points + 8, "chunk 0 of 100 points ends early");
    expect(retabled({100}, {UINT32_MAX}), table, "chunk 0 of 100 points has 4294967295 bytes");
    expect(with(with(good, 247, std::uint64_t{1} << 40), 107, 0U), 247, "1099511627776 points");
    expect(with(with(good, 247, std::uint64_t{101}), 107, 0U), table, "100 of 101 points");
  }
}

TEST(Laz, TakesNoMemoryForPointsThatCannotBeThere) {
  const Scratch scratch;
  const std::string good = laz_bytes({0, 4, las_test_rows(0, 1, 60000), 60000}, {.chunks = {1}});
  const std::size_t points = get_number<std::uint32_t>(good, 96);
  const auto table = get_number<std::uint64_t>(good, points);
  const std::size_t body = table - points - 8;
  for (const std::size_t many : {2000UL, 50000000UL}) {
    const LazTestLayout layout{.chunks = {many}};
    std::string bytes = good.substr(0, table) + test_chunk_table(layout, {body});
    bytes = with(with(bytes, 247, std::uint64_t{many}), 107, 0U);
    const std::string what = "chunk 0 of " + std::to_string(many) + " points has ";
    EXPECT_TRUE(contains(message_of(scratch, bytes), what));
  }
}

TEST(Laz, RefusesItemsThatDoNotMakeAPoint) {
  const Scratch scratch;
  const LasTestFile file{3, 2, las_test_rows(3, 10)};
  const std::string good = laz_bytes(file, {.chunks = {10}});
  const std::size_t record = 227 + 54;
  const auto expect = [&](const std::string& bytes, const char* what) {
    const std::string message = message_of(scratch, bytes);
    EXPECT_TRUE(contains(message, what)) << message;
  };
  for (const std::uint16_t compressor : {0, 4, 65535})
    expect(with(good, record, compressor), "1 to 3");
  expect(with(good, record, std::uint16_t{3}), "item 0 of type 6");
  expect(with(good, record + 2, std::uint16_t{1}), "not arithmetic");
  for (const std::uint16_t count : {4, 65535}) expect(with(good, record + 32, count), "ends early");
  for (const std::uint16_t count : {0, 2})
    expect(with(good, record + 32, count), "for points of 34");
  expect(with(good, record + 34, std::uint16_t{5}), "item 0 of type 5");
  expect(with(good, record + 34, std::uint16_t{7}), "item 0 of type 7");
  expect(with(good, record + 36, std::uint16_t{21}), "item 0 of type 6, 21 bytes");
  for (const std::uint16_t version : {0, 3}) {
    expect(with(good, record + 38, version), "item 0 of type 6, 20 bytes, version");
  }
  expect(with(good, 227 + 2, 'x'), "without a laszip record");
}

TEST(Laz, RefusesEveryTruncation) {
  const Scratch scratch;
  const LazTestLayout layouts[] = {{.chunks = {4, 5}},
                                   {.chunks = {1, 1, 2, 1, 1, 1, 1, 1}},
                                   {.chunks = {2, 2, 2, 2, 1}, .fixed_size = true},
                                   {.chunks = {9}, .table_at_end = true}};
  for (const unsigned format : {3U, 8U}) {
    const LasTestFile file{format, 4, las_test_rows(format, 9, 1, 2), 1};
    const PointCloud cloud = scratch.read("in.las", las_bytes(file)).cloud;
    for (const LazTestLayout& layout : layouts) {
      const std::string whole = laz_bytes(file, layout);
      for (std::size_t length = 0; length < whole.size(); ++length) {
        try {
          const LoadedCloud loaded = scratch.read("cut.laz", whole.substr(0, length));
          // The last bytes of a table may be zeros, which a decoder puts behind the end.
          EXPECT_GE(length + 8, whole.size());
          expect_equal(loaded.cloud, cloud, format);
        } catch (const Error& error) {
          EXPECT_TRUE(contains(error.what(), "cut.laz")) << error.what();
        }
      }
    }
  }
}

TEST(Laz, WithoutPointsHasFacts) {
  const Scratch scratch;
  const std::string whole = laz_bytes({0, 2, ""}, {});
  EXPECT_LT(whole.size(), 377U);  // the first record of COPC would end behind it
  scratch.file("none.laz", whole);
  const LasFacts facts = las_facts(InputFile(scratch.path("none.laz")));
  EXPECT_TRUE(facts.compressed);
  EXPECT_FALSE(facts.copc);
}

TEST(Laz, SurvivesDamageAnywhere) {
  const Scratch scratch;
  Random random(9);
  for (const unsigned format : {3U, 5U, 8U, 10U}) {
    scratch.file("in.las", las_bytes({format, 4, las_test_rows(format, 40, 2, 4), 2}));
    const std::string whole = converted(scratch, "in.las", "in.laz");
    expect_to_survive_damage(scratch, "odd.laz", whole, 0, 200, random);
  }
}

}  // namespace
}  // namespace pcednet::io
