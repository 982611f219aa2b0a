#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/las/las_writer.h"
#include "pcednet/formats/write_cloud.h"

namespace pcednet::io {
namespace {

/// Where the standard has a field: its byte, and its bits if it does not fill it.
struct Place {
  std::string name;
  ScalarType type;
  std::size_t byte;
  unsigned shift = 0, bits = 0;
};

using enum ScalarType;

const std::vector<Place> kOld = {{"Intensity", kUint16, 12},
                                 {"ReturnNumber", kUint8, 14, 0, 3},
                                 {"NumberOfReturns", kUint8, 14, 3, 3},
                                 {"ScanDirectionFlag", kUint8, 14, 6, 1},
                                 {"EdgeOfFlightLine", kUint8, 14, 7, 1},
                                 {"Classification", kUint8, 15, 0, 5},
                                 {"Synthetic", kUint8, 15, 5, 1},
                                 {"KeyPoint", kUint8, 15, 6, 1},
                                 {"Withheld", kUint8, 15, 7, 1},
                                 {"ScanAngleRank", kInt8, 16},
                                 {"UserData", kUint8, 17},
                                 {"PointSourceId", kUint16, 18}};
const std::vector<Place> kNew = {{"Intensity", kUint16, 12},
                                 {"ReturnNumber", kUint8, 14, 0, 4},
                                 {"NumberOfReturns", kUint8, 14, 4, 4},
                                 {"Synthetic", kUint8, 15, 0, 1},
                                 {"KeyPoint", kUint8, 15, 1, 1},
                                 {"Withheld", kUint8, 15, 2, 1},
                                 {"Overlap", kUint8, 15, 3, 1},
                                 {"ScanChannel", kUint8, 15, 4, 2},
                                 {"ScanDirectionFlag", kUint8, 15, 6, 1},
                                 {"EdgeOfFlightLine", kUint8, 15, 7, 1},
                                 {"Classification", kUint8, 16},
                                 {"UserData", kUint8, 17},
                                 {"ScanAngle", kInt16, 18},
                                 {"PointSourceId", kUint16, 20},
                                 {"GpsTime", kFloat64, 22}};

/// The tables of the standard.
std::vector<Place> places_of(unsigned format) {
  std::vector<Place> places = format < 6 ? kOld : kNew;
  // The first byte of time, colours, infrared and wave packet; 0: the format has none.
  constexpr std::size_t kTime[] = {0, 20, 0, 20, 20, 20, 0, 0, 0, 0, 0};
  constexpr std::size_t kColour[] = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
  constexpr std::size_t kInfrared[] = {0, 0, 0, 0, 0, 0, 0, 0, 36, 0, 36};
  constexpr std::size_t kWave[] = {0, 0, 0, 0, 28, 34, 0, 0, 0, 30, 38};
  const auto add = [&](const char* name, ScalarType type, std::size_t first, std::size_t byte) {
    if (first > 0) places.push_back({name, type, first + byte});
  };
  add("GpsTime", kFloat64, kTime[format], 0);
  add("Red", kUint16, kColour[format], 0);
  add("Green", kUint16, kColour[format], 2);
  add("Blue", kUint16, kColour[format], 4);
  add("Infrared", kUint16, kInfrared[format], 0);
  add("WavePacketDescriptorIndex", kUint8, kWave[format], 0);
  add("WaveformDataOffset", kUint64, kWave[format], 1);
  add("WaveformPacketSize", kUint32, kWave[format], 9);
  add("ReturnPointWaveformLocation", kFloat32, kWave[format], 13);
  add("Xt", kFloat32, kWave[format], 17);
  add("Yt", kFloat32, kWave[format], 21);
  add("Zt", kFloat32, kWave[format], 25);
  return places;
}

void expect_column(const PointCloud& cloud, const LasTestFile& file, const Place& place) {
  const Attribute* found = find_attribute(cloud, place.name);
  ASSERT_TRUE(found) << place.name;
  EXPECT_EQ(found->type, place.type) << place.name;
  const std::size_t stride = las_test_stride(file.format, file.extra);
  std::string wanted;
  for (std::size_t at = place.byte; at < file.rows.size(); at += stride) {
    std::string number = file.rows.substr(at, size_of(place.type));
    if (place.bits > 0) {
      const unsigned byte = static_cast<std::uint8_t>(number[0]);
      number[0] = static_cast<char>(byte >> place.shift & ((1U << place.bits) - 1));
    }
    wanted += number;
  }
  EXPECT_EQ(
      std::string_view(reinterpret_cast<const char*>(found->bytes.data()), found->bytes.size()),
      wanted)
      << place.name;
}

TEST(LasRead, ReadsEveryFieldOfEveryFormat) {
  const Scratch scratch;
  for (unsigned format = 0; format <= 10; ++format) {
    LasTestFile file{format, 4, las_test_rows(format, 100, 0, 4)};
    const LoadedCloud loaded = scratch.read("a.las", las_bytes(file));
    EXPECT_TRUE(loaded.warnings.empty());
    ASSERT_EQ(loaded.cloud.size(), 100u);
    const auto places = places_of(format);
    EXPECT_EQ(loaded.cloud.attributes.size(), places.size());
    for (const Place& place : places) expect_column(loaded.cloud, file, place);
    for (std::size_t i = 0; i < 100; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto steps =
            get_number<std::int32_t>(file.rows, i * las_test_stride(format) + 4 * axis);
        EXPECT_EQ(loaded.cloud.positions[i][static_cast<int>(axis)],
                  steps * file.scale[axis] + file.offset[axis]);
      }
    }
  }
}

TEST(LasRead, ReadsExtraBytesOfEveryType) {
  const Scratch scratch;
  const ScalarType types[] = {kUint8, kInt8,   kUint16, kInt16,   kUint32,
                              kInt32, kUint64, kInt64,  kFloat32, kFloat64};
  LasTestFile file{6, 4};
  LasTestRecord record{"LASF_Spec", 4};
  std::vector<Place> places;
  for (unsigned type = 1; type <= 30; ++type) {  // 11 to 30: two and three of them, deprecated
    record.data += las_test_extra("e" + std::to_string(type), type);
    places.push_back({"e" + std::to_string(type), types[(type - 1) % 10], 30 + file.extra});
    file.extra += size_of(places.back().type) * (1 + (type - 1) / 10);
  }
  record.data += las_test_extra("raw", 0, 5) + las_test_extra("Intensity", 3);
  file.extra += 5 + 2;
  file.records = {record};
  file.rows = las_test_rows(6, 40, file.extra);
  const PointCloud cloud = scratch.read("a.las", las_bytes(file)).cloud;
  for (std::size_t i = 0; i < 10; ++i) expect_column(cloud, file, places[i]);
  for (std::size_t i = 10; i < 30; ++i) {
    const Attribute* found = find_attribute(cloud, places[i].name);
    ASSERT_TRUE(found) << places[i].name;
    EXPECT_EQ(found->type, places[i].type);
    ASSERT_EQ(found->components, 1 + i / 10);
    for (std::size_t point = 0; point < 40; ++point) {
      const std::size_t at = point * las_test_stride(6, file.extra) + places[i].byte;
      EXPECT_EQ(
          std::memcmp(&found->bytes[point * found->stride()], &file.rows[at], found->stride()), 0);
    }
  }
  ASSERT_TRUE(find_attribute(cloud, "raw"));
  EXPECT_EQ(find_attribute(cloud, "raw")->components, 5u);
  expect_column(cloud, file, {"Intensity", kUint16, 12});
  expect_column(cloud, file, {"Intensity_", kUint16, 30 + file.extra - 2});
}

/// The only warning about a file that is nevertheless read, all its points.
std::string warning_of(const Scratch& scratch, const std::string& bytes, std::size_t points) {
  const LoadedCloud loaded = scratch.read("odd.las", bytes);
  EXPECT_EQ(loaded.cloud.size(), points);
  EXPECT_EQ(loaded.warnings.size(), 1u);
  return loaded.warnings.empty() ? "" : loaded.warnings[0];
}

template <typename T>
std::string with(std::string bytes, std::size_t at, T value) {
  set_number(bytes, at, value);
  return bytes;
}

TEST(LasRead, WarnsOfWhatIsSlightlyWrong) {
  const Scratch scratch;
  LasTestFile file{3, 4, las_test_rows(3, 20, 2), 2};
  file.records = {{"somebody", 7, "abc"}};
  file.extended = {{"somebody", 8, "abc"}};
  const std::string good = las_bytes(file);
  const auto expect = [&](const std::string& bytes, const char* part) {
    const std::string warning = warning_of(scratch, bytes, 20);
    EXPECT_TRUE(contains(warning, part)) << warning;
  };
  EXPECT_TRUE(scratch.read("good.las", good).warnings.empty());
  const char* left_out = "the others are left out";
  expect(with(good, 100, 2U), left_out);
  expect(with(good, 100, UINT32_MAX), left_out);
  expect(with(good, 375 + 20, std::uint16_t{65535}), left_out);
  expect(with(good, 375 + 20, std::uint16_t{4}), left_out);
  expect(with(good, 243, UINT32_MAX), left_out);
  expect(with(good, 235, good.size() - 5), left_out);
  expect(with(good, 235, UINT64_MAX), left_out);
  expect(with(good, 235, std::uint64_t{1}), "byte 1, before the points");
  const std::size_t extended = good.size() - 63;
  for (const std::uint64_t length : {std::uint64_t{4}, UINT64_MAX, UINT64_MAX - extended - 59}) {
    expect(with(good, extended + 20, length), left_out);
  }
  expect(with(good, 107, 19U), "counts 19 points and, in 64 bits, 20");
  file.records = {{"LASF_Spec", 4, las_test_extra("there", 3) + las_test_extra("absent", 1)}};
  expect(las_bytes(file), "\"absent\" are described but not in the points' 36 bytes");
  std::string short_header = las_bytes({3, 3, las_test_rows(3, 20)});
  expect(with(short_header, 25, std::uint8_t{4}),
         "declares its size as 235 bytes; version 1.4 has 375");
  const std::string newer = with(las_bytes({6, 4, las_test_rows(6, 20)}), 25, std::uint8_t{5});
  expect(newer, "declares its size as 375 bytes; version 1.5 has 393");
}

TEST(LasRead, WarnsOfPointsBehindThoseThatTheHeaderCounts) {
  const Scratch scratch;
  for (const unsigned minor : {0U, 2U, 3U, 4U, 5U}) {
    const unsigned format = minor < 4 ? 1 : 6;
    LasTestFile file{format, minor, las_test_rows(format, 20)};
    const std::size_t count_at = minor < 4 ? 107 : 247;
    const std::string fewer = with(las_bytes(file), count_at, 15U);
    const std::string half = std::string(las_test_stride(format) - 1, 'x');
    for (const std::string& bytes : {fewer, fewer + half}) {
      EXPECT_EQ(warning_of(scratch, bytes, 15),
                "the header counts 15 points and the file has room for 5 more behind them: these "
                "are left out");
    }
    EXPECT_TRUE(scratch.read("a.las", las_bytes(file) + half).warnings.empty());
    // Records behind the points are none.
    if (minor < 3) continue;
    file.extended = {{"LASF_Spec", 65535, std::string(500, 'w')}};
    EXPECT_TRUE(scratch.read("a.las", las_bytes(file)).warnings.empty());
    const std::string warning = warning_of(scratch, with(las_bytes(file), count_at, 15U), 15);
    EXPECT_TRUE(contains(warning, "room for 5 more")) << warning;
  }
}

TEST(LasRead, ReadsThePointsOfAFileWhoseHeaderWasNeverFinished) {
  const Scratch scratch;
  for (const unsigned minor : {2U, 4U}) {
    const unsigned format = minor < 4 ? 3 : 7;
    const LasTestFile file{format, minor, las_test_rows(format, 20)};
    const std::string bytes = las_bytes(file);
    const std::string none = with(bytes, minor < 4 ? 107 : 247, 0U);
    EXPECT_EQ(warning_of(scratch, none, 20),
              "the header counts no points, as where writing was interrupted: the 20 that are "
              "there are read");
    EXPECT_TRUE(contains(warning_of(scratch, none.substr(0, none.size() - 1), 19), "the 19 that"));
    formats::write_cloud(scratch.path("whole.las"), scratch.read("none.las", none).cloud,
                         {.overwrite = Overwrite::kYes});
    EXPECT_TRUE(bytes_of(scratch.path("whole.las")) == bytes);
  }
  LasTestFile empty{6, 4};
  empty.extended = {{"somebody", 8, std::string(500, 'x')}};
  const LoadedCloud loaded = scratch.read("empty.las", las_bytes(empty));
  EXPECT_EQ(loaded.cloud.size(), 0u);
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST(LasRead, TakesTheCountThatIsThere) {
  const Scratch scratch;
  const std::string six = las_bytes({6, 4, las_test_rows(6, 20)});
  EXPECT_EQ(scratch.read("a.las", six).cloud.size(), 20u);
  EXPECT_EQ(scratch.read("a.las", with(with(six, 247, std::uint64_t{0}), 107, 20U)).cloud.size(),
            20u);
  const std::string one = las_bytes({1, 4, las_test_rows(1, 20)});
  EXPECT_EQ(scratch.read("a.las", with(one, 247, std::uint64_t{0})).cloud.size(), 20u);
  EXPECT_EQ(scratch.read("a.las", with(one, 107, 0U)).cloud.size(), 20u);
}

TEST(LasRead, NamesTheByteThatCannotBeTrusted) {
  const Scratch scratch;
  const std::string good = las_bytes({3, 4, las_test_rows(3, 20)});
  const auto expect = [&](const std::string& bytes, const std::string& place) {
    const std::string message =
        error_of(ErrorKind::kUnreadable, [&] { scratch.read("odd.las", bytes); });
    EXPECT_TRUE(contains(message, "odd.las: " + place)) << message;
  };
  const std::string end = "byte " + std::to_string(good.size()) + ": ends after point 20 of ";
  for (const std::uint64_t count : {std::uint64_t{21}, std::uint64_t{UINT32_MAX},
                                    std::uint64_t{1} << 60, UINT64_MAX, UINT64_MAX / 34 + 2}) {
    expect(with(with(good, 247, count), 107, 0U), end + std::to_string(count));
  }
  const std::string old = las_bytes({3, 2, las_test_rows(3, 20)});
  expect(with(old, 107, UINT32_MAX), "byte " + std::to_string(old.size()));
  for (const std::uint32_t offset : {0U, 100U, 374U, UINT32_MAX}) {
    expect(with(good, 96, offset), "byte 96: the points begin at byte " + std::to_string(offset));
  }
  expect(with(good, 94, std::uint16_t{65535}), "byte 96");
  expect(with(good, 24, std::uint8_t{2}), "byte 24: LAS 2.4");
  expect(with(good, 25, std::uint8_t{6}), "byte 24: LAS 1.6");
  expect(with(good, 104, std::uint8_t{11}), "byte 104: point format 11");
  expect(with(good, 104, std::uint8_t{63}), "byte 104: point format 63");
  expect(with(good, 104, std::uint8_t{0x83}), "byte 104: compressed, but without");
  expect(with(good, 104, std::uint8_t{0x43}), "byte 104: compressed, but without");
  for (const std::uint16_t length : {0, 33}) expect(with(good, 105, length), "byte 105: points of");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string scale = "byte " + std::to_string(131 + 8 * axis) + ": a scale of ";
    const std::string offset = "byte " + std::to_string(155 + 8 * axis) + ": an offset of ";
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -0.0, std::nan(""), kInfinity, -kInfinity}) {
      expect(with(good, 131 + 8 * axis, bad), scale);
      if (bad == 0.0) continue;
      expect(with(good, 155 + 8 * axis, bad), offset);
    }
  }
}

TEST(LasRead, RefusesEveryTruncationButThoseBehindThePoints) {
  const Scratch scratch;
  for (unsigned minor = 0; minor <= 4; ++minor) {
    LasTestFile file{minor < 4 ? 1U : 7U, minor, las_test_rows(minor < 4 ? 1 : 7, 3)};
    file.records = {{"somebody", 7, "abc"}};
    const std::size_t end = las_bytes(file).size();
    if (minor == 4) file.extended = {{"somebody", 8, "abc"}};
    const std::string whole = las_bytes(file);
    for (std::size_t length = 0; length < end; ++length) {
      const std::string message = error_of(
          ErrorKind::kUnreadable, [&] { scratch.read("cut.las", whole.substr(0, length)); });
      EXPECT_TRUE(length < 4 || contains(message, "cut.las: byte ")) << message;
    }
    for (std::size_t length = end; length < whole.size(); ++length) {
      EXPECT_TRUE(contains(warning_of(scratch, whole.substr(0, length), 3), "0 of 1"));
    }
  }
}

TEST(LasRead, ReadsRecordsUpToTheirFullLength) {
  const Scratch scratch;
  LasTestFile file{0, 4, las_test_rows(0, 3)};
  file.records.assign(300, {"", 1, "", ""});
  file.records[100].data.assign(65535, 'x');
  file.before_points = std::string(1000, '?');
  file.extended.assign(300, {"", 1, "", ""});
  file.extended[100].data.assign(200000, 'y');
  const LoadedCloud loaded = scratch.read("a.las", las_bytes(file));
  EXPECT_TRUE(loaded.warnings.empty());
  formats::write_cloud(scratch.path("b.las"), loaded.cloud);
  EXPECT_TRUE(bytes_of(scratch.path("b.las")) == las_bytes(file));
}

}  // namespace
}  // namespace pcednet::io
