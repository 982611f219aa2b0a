#include <gtest/gtest.h>

#include <cmath>

#include "io/las/las_writer.h"
#include "pcednet/formats/write_cloud.h"

namespace pcednet::io {
namespace {

constexpr std::size_t kHead = 54;  ///< of a record

std::string written(const Scratch& scratch, const PointCloud& cloud) {
  const auto path = scratch.path("out.las");
  formats::write_cloud(path, cloud, {.overwrite = Overwrite::kYes});
  return bytes_of(path);
}

std::string read_and_written(const Scratch& scratch, const std::string& bytes) {
  return written(scratch, scratch.read("in.las", bytes).cloud);
}

/// A file with records of every kind and three described extra fields.
LasTestFile rich_file(unsigned format, unsigned minor) {
  LasTestFile file{format, minor, las_test_rows(format, 20, 15), 15};
  file.records = {
      {"somebody", 7, "kept as it is", "of mine"},
      {"a name that fills", 65535, "", "a description of thirty-two char"},
      {"LASF_Spec", 4,
       las_test_extra("height", 9) + las_test_extra("code", 8) + las_test_extra("three bytes", 21),
       "extra bytes"}};
  if (minor == 3) file.extended = {{"LASF_Spec", 65535, std::string(100, 'w'), "waves"}};
  if (minor >= 4) {
    file.extended = {{"somebody", 8, std::string(70000, 'x'), "a long one"},
                     {"LASF_Spec", 65535, std::string(100, 'w'), "waves"}};
  }
  return file;
}

TEST(LasWrite, GivesEveryFormatBackInEveryVersionByteForByte) {
  const Scratch scratch;
  for (unsigned minor = 0; minor <= 5; ++minor) {
    for (unsigned format = 0; format <= 10; ++format) {
      LasTestFile file = rich_file(format, minor);
      file.records[1].user.resize(16);
      if (format % 2 == 1) file.before_points = "\xDD\xCC";  // as LAS 1.0 begins its points
      const std::string bytes = las_bytes(file);
      EXPECT_TRUE(read_and_written(scratch, bytes) == bytes) << "1." << minor << ", " << format;
    }
  }
}

TEST(LasWrite, GivesAFileBackThroughPly) {
  const Scratch scratch;
  for (const unsigned format : {3U, 8U}) {
    LasTestFile file{format, 4, las_test_rows(format, 30)};
    file.records = {{"somebody", 7, "kept as it is", "of mine"}};
    file.extended = {{"somebody", 8, "long", ""}};
    const std::string bytes = las_bytes(file);
    formats::write_cloud(scratch.path("a.ply"), scratch.read("in.las", bytes).cloud,
                         {.overwrite = Overwrite::kYes});
    EXPECT_TRUE(written(scratch, formats::read_cloud(scratch.path("a.ply")).cloud) == bytes)
        << format;
  }
}

TEST(LasWrite, KeepsTheBytesBetweenTheRecordsAndThePoints) {
  const Scratch scratch;
  LasTestFile file{6, 4, las_test_rows(6, 30)};
  file.records = {{"somebody", 7, "kept as it is"}};
  file.before_points = std::string(1000, '?') + std::string(3, '\0');
  const std::string bytes = las_bytes(file);
  EXPECT_TRUE(read_and_written(scratch, bytes) == bytes);
  for (const char* name : {"a.ply", "a.laz"}) {
    formats::write_cloud(scratch.path(name), scratch.read("in.las", bytes).cloud);
    EXPECT_TRUE(written(scratch, formats::read_cloud(scratch.path(name)).cloud) == bytes) << name;
  }
  // They stay next to the points when records are added.
  PointCloud cloud = scratch.read("in.las", bytes).cloud;
  cloud.comments = {"a comment"};
  const std::string more = written(scratch, cloud);
  const auto points = get_number<std::uint32_t>(more, 96);
  EXPECT_TRUE(more.substr(points - 1003, 1003) == file.before_points);
  EXPECT_EQ(get_number<std::uint32_t>(more, 100), 2u);
  EXPECT_TRUE(scratch.read("again.las", more).cloud.comments == cloud.comments);
}

TEST(LasWrite, KeepsTheHeadsOfRecordsByteForByte) {
  const Scratch scratch;
  LasTestFile file{7, 4, las_test_rows(7, 5)};
  const std::string after_zero("name\0rubbish", 12);
  file.records = {{after_zero, 7, "data", after_zero, 0xAABB}};
  file.extended = {{after_zero, 8, "data", after_zero, 0xCCDD}};
  const std::string bytes = las_bytes(file);
  EXPECT_TRUE(read_and_written(scratch, bytes) == bytes);
}

TEST(LasWrite, LeavesTheRecordOfExtraBytesInItsPlace) {
  const Scratch scratch;
  LasTestFile file{7, 4, las_test_rows(7, 5, 2), 2};
  file.records = {{"somebody", 7, "data"},
                  {"LASF_Spec", 4, las_test_extra("height", 3) + "odd end", "of a scanner"},
                  {"somebody", 8, "data"}};
  const std::string bytes = las_bytes(file);
  EXPECT_TRUE(read_and_written(scratch, bytes) == bytes);
  PointCloud cloud = scratch.read("in.las", bytes).cloud;
  cloud.attributes.push_back({"more", ScalarType::kUint8, 1, std::vector<std::byte>(5)});
  const std::string more = written(scratch, cloud);
  file.records[1].data = las_test_extra("height", 3) + las_test_extra("more", 1);
  const std::string records = las_test_record(file.records[0], false) +
                              las_test_record(file.records[1], false) +
                              las_test_record(file.records[2], false);
  EXPECT_TRUE(more.substr(375, records.size()) == records);
}

TEST(LasWrite, CountsTheTimesOfLas15Anew) {
  const Scratch scratch;
  const LasTestFile file{7, 5, las_test_rows(7, 200)};
  std::string bytes = las_bytes(file);
  EXPECT_GT(get_number<double>(bytes, 375), get_number<double>(bytes, 383));
  std::string wrong = bytes;
  set_number(wrong, 375, 1.0);
  set_number(wrong, 383, 2.0);
  EXPECT_TRUE(read_and_written(scratch, wrong) == bytes);
  EXPECT_EQ(get_number<std::uint16_t>(bytes, 391), 1000);
  const std::string none = las_bytes({7, 5});
  EXPECT_TRUE(read_and_written(scratch, none) == none);
  // What others added behind the header of the standard stays.
  bytes.insert(393, "more");
  set_number(bytes, 94, std::uint16_t{397});
  set_number(bytes, 96, 397U);
  EXPECT_TRUE(read_and_written(scratch, bytes) == bytes);
}

TEST(LasWrite, GivesTheFarthestIntegersBack) {
  const Scratch scratch;
  LasTestFile file{0, 2, las_test_rows(0, 4)};
  file.scale = {1e-4, -0.01, 1.0};
  constexpr std::int32_t kFar[] = {INT32_MIN, INT32_MAX, -1, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) set_number(file.rows, 20 * i + 4 * axis, kFar[i]);
  }
  const std::string bytes = las_bytes(file);
  EXPECT_TRUE(read_and_written(scratch, bytes) == bytes);
}

TEST(LasWrite, GivesAFileWithoutPointsBack) {
  const Scratch scratch;
  for (unsigned minor = 0; minor <= 4; ++minor) {
    const std::string bytes = las_bytes({1, minor});
    EXPECT_TRUE(read_and_written(scratch, bytes) == bytes) << minor;
  }
}

TEST(LasWrite, PointsToTheWaveformsWhereTheyMoveTo) {
  const Scratch scratch;
  for (const unsigned minor : {3U, 4U}) {
    PointCloud cloud = scratch.read("in.las", las_bytes(rich_file(4, minor))).cloud;
    cloud.attributes.push_back(make_attribute("more", std::vector<double>(20, 0.5)));
    const std::string bytes = written(scratch, cloud);
    const std::string waves = las_test_record(rich_file(4, minor).extended.back(), true);
    EXPECT_EQ(bytes.substr(get_number<std::uint64_t>(bytes, 227)), waves) << minor;
  }
}

TEST(LasWrite, CountsInThePlaceThatTheVersionHas) {
  const Scratch scratch;
  for (unsigned minor = 0; minor <= 4; ++minor) {
    const std::string bytes = read_and_written(scratch, las_bytes({6, minor, las_test_rows(6, 9)}));
    EXPECT_EQ(get_number<std::uint32_t>(bytes, 107), minor < 4 ? 9u : 0u);
    if (minor < 4) continue;
    EXPECT_EQ(get_number<std::uint64_t>(bytes, 247), 9u);
  }
  // A header of 1.4 cut to the length of 1.2, as some programs write.
  std::string short_header = las_bytes({6, 3, las_test_rows(6, 9)});
  short_header[25] = 4;
  EXPECT_EQ(scratch.read("back.las", read_and_written(scratch, short_header)).cloud.size(), 9u);
}

/// The descriptors of the file's extra bytes.
std::string descriptors_of(const std::string& bytes) {
  std::size_t at = get_number<std::uint16_t>(bytes, 94);
  for (auto left = get_number<std::uint32_t>(bytes, 100); left > 0; --left) {
    const auto length = get_number<std::uint16_t>(bytes, at + 20);
    if (bytes.substr(at + 2, 10) == std::string("LASF_Spec\0", 10) && bytes[at + 18] == 4) {
      return bytes.substr(at + kHead, length);
    }
    at += kHead + length;
  }
  return "";
}

TEST(LasWrite, DescribesNewFieldsBehindThoseOfTheFile) {
  const Scratch scratch;
  // One of no bytes, which takes no place; one that is not in the points; 300 bytes not described.
  LasTestFile file{1, 2, las_test_rows(1, 10, 304), 304};
  file.records = {{"LASF_Spec", 4, las_test_extra("nothing", 0, 0) + las_test_extra("height", 9)}};
  PointCloud cloud = scratch.read("in.las", las_bytes(file)).cloud;
  std::vector<std::uint16_t> more = {1, 2, 3, 4, 5, 6, 7, 8, 9, 65535};
  cloud.attributes.push_back(make_attribute("more", more));
  const std::string bytes = written(scratch, cloud);
  const std::string found = descriptors_of(bytes);
  ASSERT_EQ(found.size(), 4 * 192u);
  EXPECT_EQ(found.substr(0, 192), las_test_extra("height", 9));
  EXPECT_EQ(found.substr(192, 192), las_test_extra("ExtraBytes", 0, 255));
  EXPECT_EQ(found.substr(384, 192), las_test_extra("ExtraBytes", 0, 45));
  EXPECT_EQ(found.substr(576, 192), las_test_extra("more", 3));
  const std::size_t points = get_number<std::uint32_t>(bytes, 96), stride = 28 + 304 + 2;
  ASSERT_EQ(get_number<std::uint16_t>(bytes, 105), stride);
  for (std::size_t i = 0; i < 10; ++i) {
    const std::string row = bytes.substr(points + i * stride, stride);
    EXPECT_EQ(row, file.rows.substr(i * 332, 332) + packed(more[i]));
  }
  EXPECT_TRUE(read_and_written(scratch, bytes) == bytes);
}

TEST(LasWrite, DescribesTheEdgeClasses) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {Vec3(1, 2, 3)};
  cloud.attributes = {make_attribute("scalar_edge_class", std::vector<std::uint8_t>{3})};
  const std::string found = descriptors_of(written(scratch, cloud));
  ASSERT_EQ(found.size(), 192u);
  EXPECT_EQ(found.substr(4, 11), std::string("edge_class\0", 11));
  // It ends with a zero, since many readers take the 32 bytes for such a text.
  EXPECT_EQ(found.substr(160), "1 smooth 2 sharp 3 boundary" + std::string(5, '\0'));
}

TEST(LasWrite, NamesTheTypeOfEveryKindOfNumber) {
  const Scratch scratch;
  PointCloud cloud;
  cloud.positions = {Vec3(1, 2, 3)};
  cloud.attributes = {make_attribute("a", std::vector<std::uint8_t>{1}),
                      make_attribute("b", std::vector<std::int8_t>{-1}),
                      make_attribute("c", std::vector<std::uint16_t>{1}),
                      make_attribute("d", std::vector<std::int16_t>{-1}),
                      make_attribute("e", std::vector<std::uint32_t>{1}),
                      make_attribute("f", std::vector<std::int32_t>{-1}),
                      make_attribute("g", std::vector<std::uint64_t>{1}),
                      make_attribute("h", std::vector<std::int64_t>{-1}),
                      make_attribute("i", std::vector<float>{0.5F}),
                      make_attribute("j", std::vector<double>{0.1})};
  const std::string bytes = written(scratch, cloud), found = descriptors_of(bytes);
  ASSERT_EQ(found.size(), 10 * 192u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(found[192 * i + 2], static_cast<char>(i + 1));
  EXPECT_EQ(bytes.substr(get_number<std::uint32_t>(bytes, 96) + 30),
            packed(std::uint8_t{1}, std::int8_t{-1}, std::uint16_t{1}, std::int16_t{-1}, 1U, -1,
                   std::uint64_t{1}, std::int64_t{-1}, 0.5F, 0.1));
}

TEST(LasWrite, RefusesWhatItCannotHold) {
  const Scratch scratch;
  const auto message = [&](ErrorKind kind, const PointCloud& cloud) {
    const std::string text = error_of(kind, [&] { written(scratch, cloud); });
    EXPECT_TRUE(!std::filesystem::exists(scratch.path("out.las")));
    return text;
  };
  PointCloud cloud;
  cloud.positions.assign(5, Vec3(1, 2, 3));
  cloud.positions[3].z() = std::nan("");
  EXPECT_TRUE(contains(message(ErrorKind::kInsufficient, cloud), "out.las: point 3"));
  cloud.positions[3].z() = 0.0;
  // A record of descriptors has 65,535 bytes at most, 192 each.
  for (int i = 0; i < 20'000; ++i) {  // takes minutes if each is compared with all before it
    cloud.attributes.push_back(
        make_attribute("field " + std::to_string(i), std::vector<std::uint8_t>(5)));
  }
  EXPECT_TRUE(contains(message(ErrorKind::kFailure, cloud), "more attributes than LAS can hold"));
  cloud.attributes.resize(342);
  EXPECT_TRUE(contains(message(ErrorKind::kFailure, cloud), "more attributes than LAS can hold"));
  cloud.attributes.pop_back();
  EXPECT_EQ(descriptors_of(written(scratch, cloud)).size(), 341 * 192u);
  std::filesystem::remove(scratch.path("out.las"));
  std::vector<std::uint8_t> codes = {0, 31, 32, 0, 0};
  cloud = scratch.read("in.las", las_bytes({0, 2, las_test_rows(0, 5)})).cloud;
  std::erase_if(cloud.attributes, [](const auto& a) { return a.name == "Classification"; });
  cloud.attributes.push_back(make_attribute("Classification", codes));
  EXPECT_TRUE(contains(message(ErrorKind::kFailure, cloud), "point 2: Classification 32"));
}

}  // namespace
}  // namespace pcednet::io
