#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/scratch.h"
#include "pcednet/io/ply/faces.h"

namespace pcednet::io {
namespace {

constexpr const char* kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

TEST(PlyRead, DecodesEveryTypeNameInEveryEncoding) {
  const Scratch scratch;
  const struct {
    const char* name;
    ScalarType type;
  } types[] = {{"char", ScalarType::kInt8},      {"int8", ScalarType::kInt8},
               {"uchar", ScalarType::kUint8},    {"uint8", ScalarType::kUint8},
               {"short", ScalarType::kInt16},    {"int16", ScalarType::kInt16},
               {"ushort", ScalarType::kUint16},  {"uint16", ScalarType::kUint16},
               {"int", ScalarType::kInt32},      {"int32", ScalarType::kInt32},
               {"uint", ScalarType::kUint32},    {"uint32", ScalarType::kUint32},
               {"float", ScalarType::kFloat32},  {"float32", ScalarType::kFloat32},
               {"double", ScalarType::kFloat64}, {"float64", ScalarType::kFloat64}};
  for (const auto& [name, type] : types) {
    const std::string vertex = std::string("element vertex 2\nproperty ") + name + " v\n" + kXyz;
    std::string little, big;
    visit_scalar(type, [&](auto zero) {
      const auto v = static_cast<decltype(zero)>(-3 + 100);
      const auto w = std::numeric_limits<decltype(zero)>::lowest();
      little = packed(v, 1.5F, 2.5F, 3.5F) + packed(w, 4.5F, 5.5F, -6.5F);
      big = packed_reversed(v, 1.5F, 2.5F, 3.5F) + packed_reversed(w, 4.5F, 5.5F, -6.5F);
    });
    const auto from_little =
        scratch.read("a.ply", header("binary_little_endian", vertex) + little).cloud;
    const auto from_big = scratch.read("b.ply", header("binary_big_endian", vertex) + big).cloud;
    for (const PointCloud* cloud : {&from_little, &from_big}) {
      ASSERT_EQ(cloud->size(), 2u) << name;
      EXPECT_EQ(cloud->positions[0], Vec3(1.5, 2.5, 3.5));
      EXPECT_EQ(cloud->positions[1], Vec3(4.5, 5.5, -6.5));
      EXPECT_EQ(cloud->position_type, ScalarType::kFloat32);
      ASSERT_EQ(cloud->attributes.size(), 1u);
      EXPECT_EQ(cloud->attributes[0].type, type);
      EXPECT_EQ(cloud->attributes[0].name, "v");
      EXPECT_EQ(cloud->attributes[0].value(0), 97.0);
      visit_scalar(type, [&](auto zero) {
        EXPECT_EQ(cloud->attributes[0].value(1),
                  static_cast<double>(std::numeric_limits<decltype(zero)>::lowest()));
      });
    }
    const auto from_text =
        scratch.read("c.ply", header("ascii", vertex) + "97 1 2 3\n5 4 5 6").cloud;
    ASSERT_EQ(from_text.attributes.size(), 1u);
    EXPECT_EQ(from_text.attributes[0].type, type);
    EXPECT_EQ(from_text.attributes[0].value(0), 97.0);
    EXPECT_EQ(from_text.attributes[0].value(1), 5.0);
  }
}

TEST(PlyRead, SortsPropertiesByTheirNamesWhateverTheirOrder) {
  const Scratch scratch;
  const std::string elements =
      "comment  two  words \nobj_info made by hand\nelement vertex 2\nproperty uchar alpha\n"
      "property double nz\nproperty double ny\nproperty double nx\nproperty int label\n"
      "property uchar blue\nproperty uchar green\nproperty uchar red\nproperty double z\n"
      "property double y\nproperty double x\nproperty short scalar_roof\n";
  const auto loaded = scratch.read("a.ply", header("ascii", elements) +
                                                "9 2 0 0 -1 30 20 10 3.5 2.5 0.1 -7\n"
                                                "8 0 4 3 2 31 21 11 6.5 5.5 0.25 7\n");
  const PointCloud& cloud = loaded.cloud;
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.position_type, ScalarType::kFloat64);
  EXPECT_EQ(cloud.positions[0], Vec3(0.1, 2.5, 3.5));
  EXPECT_EQ(cloud.normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(cloud.normals[1], Vec3(0.6, 0.8, 0));
  EXPECT_EQ(cloud.colours[0], (Rgb{10, 20, 30}));
  EXPECT_EQ(cloud.colours[1], (Rgb{11, 21, 31}));
  EXPECT_EQ(cloud.labels, (std::vector<std::uint8_t>{kUnlabelled, kSharpEdge}));
  ASSERT_EQ(cloud.attributes.size(), 2u);
  EXPECT_EQ(cloud.attributes[0].name, "alpha");
  EXPECT_EQ(cloud.attributes[1].name, "scalar_roof");
  EXPECT_EQ(cloud.attributes[1].type, ScalarType::kInt16);
  EXPECT_EQ(cloud.attributes[1].value(0), -7.0);
  EXPECT_EQ(cloud.comments, (std::vector<std::string>{"two  words", "obj_info made by hand"}));
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST(PlyRead, KnowsTheOtherNamesOfNormalsColoursAndLabels) {
  const Scratch scratch;
  const std::string elements =
      std::string("element vertex 1\n") + kXyz +
      "property float normal_x\nproperty float normal_y\nproperty float normal_z\n"
      "property uchar diffuse_red\nproperty uchar diffuse_green\nproperty uchar diffuse_blue\n"
      "property float scalar_Label\n";
  const auto cloud =
      scratch.read("a.ply", header("ascii", elements) + "1 2 3 0 -1 0 4 5 6 1\n").cloud;
  EXPECT_EQ(cloud.normals.at(0), Vec3(0, -1, 0));
  EXPECT_EQ(cloud.colours.at(0), (Rgb{4, 5, 6}));
  EXPECT_EQ(cloud.labels, std::vector<std::uint8_t>{kSmoothEdge});
  EXPECT_TRUE(cloud.attributes.empty());
}

TEST(PlyRead, LeavesIncompleteTriplesAndOddLabelsAsAttributes) {
  const Scratch scratch;
  const std::string elements = std::string("element vertex 2\n") + kXyz +
                               "property float nx\nproperty float ny\nproperty uchar red\n"
                               "property float label\nproperty float x\n";
  const auto cloud =
      scratch.read("a.ply", header("ascii", elements) + "1 2 3 0 1 9 0.5 4\n1 2 3 0 1 9 1 5\n")
          .cloud;
  EXPECT_TRUE(cloud.normals.empty());
  EXPECT_TRUE(cloud.colours.empty());
  EXPECT_TRUE(cloud.labels.empty());
  ASSERT_EQ(cloud.attributes.size(), 5u);
  EXPECT_EQ(cloud.attributes[3].name, "label");
  EXPECT_EQ(cloud.attributes[4].name, "x");
  EXPECT_EQ(cloud.attributes[4].value(1), 5.0);
}

TEST(PlyRead, ConvertsColoursOfOtherTypes) {
  const Scratch scratch;
  const auto read = [&](const std::string& type, const std::string& row) {
    const std::string elements = std::string("element vertex 2\n") + kXyz + "property " + type +
                                 " red\nproperty " + type + " green\nproperty " + type + " blue\n";
    return scratch.read("a.ply", header("ascii", elements) + "0 0 0 " + row + "\n0 0 0 0 0 0\n");
  };
  const auto words = read("ushort", "65535 257 300");
  EXPECT_EQ(words.cloud.colours.at(0), (Rgb{255, 1, 1}));
  EXPECT_EQ(words.warnings.size(), 1u);
  EXPECT_EQ(read("ushort", "255 1 0").cloud.colours.at(0), (Rgb{255, 1, 0}));
  EXPECT_EQ(read("float", "1 0 0.2").cloud.colours.at(0), (Rgb{255, 0, 51}));
  EXPECT_EQ(read("float", "255 0 51").cloud.colours.at(0), (Rgb{255, 0, 51}));
  const auto neither = read("float", "1000 0 0.5");
  EXPECT_TRUE(neither.cloud.colours.empty());
  EXPECT_EQ(neither.cloud.attributes.size(), 3u);
  EXPECT_EQ(neither.warnings.size(), 1u);
}

TEST(PlyRead, ReadsPastListsOfVertices) {
  const Scratch scratch;
  const std::string elements =
      "element vertex 2\nproperty list uchar int nearby\nproperty float x\nproperty float y\n"
      "property list int double far\nproperty float z\nproperty uchar label\n";
  using U8 = std::uint8_t;
  const std::string little = packed(U8{2}, 7, 8, 1.0F, 2.0F, 0, 3.0F, U8{1}) +
                             packed(U8{0}, 4.0F, 5.0F, 1, 0.5, 6.0F, U8{2});
  const std::string big = packed_reversed(U8{2}, 7, 8, 1.0F, 2.0F, 0, 3.0F, U8{1}) +
                          packed_reversed(U8{0}, 4.0F, 5.0F, 1, 0.5, 6.0F, U8{2});
  for (const auto& loaded :
       {scratch.read("a.ply", header("binary_little_endian", elements) + little),
        scratch.read("b.ply", header("binary_big_endian", elements) + big),
        scratch.read("c.ply", header("ascii", elements) + "2 7 8 1 2 0 3 1\n0 4 5 1 .5 6 2\n")}) {
    ASSERT_EQ(loaded.cloud.size(), 2u);
    EXPECT_EQ(loaded.cloud.positions[0], Vec3(1, 2, 3));
    EXPECT_EQ(loaded.cloud.positions[1], Vec3(4, 5, 6));
    EXPECT_EQ(loaded.cloud.labels, (std::vector<U8>{1, 2}));
    EXPECT_EQ(loaded.warnings.size(), 1u);
  }
}

TEST(PlyRead, CarriesOtherElementsAsLittleEndianBytes) {
  const Scratch scratch;
  using U8 = std::uint8_t;
  const std::string camera = "element camera 2\nproperty double focus\nproperty short id\n";
  const std::string face =
      "element face 2\nproperty list uchar int vertex_indices\nproperty uchar flag\n";
  const std::string elements = camera + "element vertex 1\n" + kXyz + face;
  const std::string camera_bytes = packed(1.5, std::int16_t{3}) + packed(2.5, std::int16_t{-4});
  const std::string face_bytes = packed(U8{3}, 0, 1, 2, U8{9}) + packed(U8{1}, 7, U8{8});
  const std::string big = packed_reversed(1.5, std::int16_t{3}, 2.5, std::int16_t{-4}) +
                          packed_reversed(1.0F, 2.0F, 3.0F) +
                          packed_reversed(U8{3}, 0, 1, 2, U8{9}, U8{1}, 7, U8{8});
  for (const auto& loaded :
       {scratch.read("a.ply", header("binary_little_endian", elements) + camera_bytes +
                                  packed(1.0F, 2.0F, 3.0F) + face_bytes),
        scratch.read("b.ply", header("binary_big_endian", elements) + big),
        scratch.read("c.ply",
                     header("ascii", elements) + "1.5 3\n2.5 -4\n1 2 3\n3 0 1 2 9\n1 7 8")}) {
    EXPECT_EQ(loaded.cloud.positions.at(0), Vec3(1, 2, 3));
    const auto& foreign = loaded.cloud.foreign_elements;
    ASSERT_EQ(foreign.size(), 2u);
    EXPECT_EQ(foreign[0].header, camera);
    EXPECT_EQ(foreign[1].header, face);
    const auto text = [](const ForeignElement& element) {
      return std::string(reinterpret_cast<const char*>(element.bytes.data()), element.bytes.size());
    };
    EXPECT_EQ(text(foreign[0]), camera_bytes);
    EXPECT_EQ(text(foreign[1]), face_bytes);
    EXPECT_TRUE(loaded.warnings.empty());
  }
}

TEST(PlyRead, ToleratesHowOthersEndTheirLines) {
  const Scratch scratch;
  for (const std::string end : {"\n", "\r\n", "\r", " \n", "\t\r\n"}) {
    std::string text;
    for (const char* line : {"ply", "format ascii 1.0", "element vertex 2", "property float x",
                             "property float y", "property float z", "end_header", "1 2 3"}) {
      text += line + end;
    }
    const auto cloud = scratch.read("a.ply", text + "  4\t5 6").cloud;
    ASSERT_EQ(cloud.size(), 2u);
    EXPECT_EQ(cloud.positions[1], Vec3(4, 5, 6));
  }
  // Data whose first byte could be taken for a line's end.
  const std::string start =
      header("binary_little_endian", std::string("element vertex 1\n") + kXyz);
  const std::string bytes = std::string("\n\r\n\x41", 4) + packed(1.0F, 2.0F);
  EXPECT_EQ(scratch.read("b.ply", start + bytes).cloud.positions.at(0).y(), 1.0);
}

TEST(PlyRead, KeepsDigitsOfLargeCoordinatesThatAreCalledFloat) {
  const Scratch scratch;
  const std::string start = header("ascii", std::string("element vertex 1\n") + kXyz);
  const auto large = scratch.read("a.ply", start + "289814.15 4320978.61 170.76\n");
  EXPECT_EQ(large.cloud.positions.at(0), Vec3(289814.15, 4320978.61, 170.76));
  EXPECT_EQ(large.cloud.position_type, ScalarType::kFloat64);
  EXPECT_EQ(large.warnings.size(), 1u);
  const auto exact = scratch.read("b.ply", start + "289814.25 4320978.5 170.76\n");
  EXPECT_EQ(exact.cloud.position_type, ScalarType::kFloat32);
  const auto small = scratch.read("c.ply", start + "0.1 0.2 9999.9\n");
  EXPECT_EQ(small.cloud.positions.at(0), Vec3(0.1F, 0.2F, 9999.9F));
  EXPECT_EQ(small.cloud.position_type, ScalarType::kFloat32);
}

TEST(PlyRead, MakesNormalsUnitAndCountsWhatItCannotUse) {
  const Scratch scratch;
  const std::string elements = std::string("element vertex 4\n") + kXyz +
                               "property float nx\nproperty float ny\nproperty float nz\n";
  const auto loaded = scratch.read("a.ply", header("ascii", elements) +
                                                "1 2 3 0 0 0.25\n1 nan 3 0 0 0\n"
                                                "1 2 inf nan 0 1\n-nan -inf 2 3e38 0 0\n");
  EXPECT_EQ(loaded.cloud.normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(loaded.cloud.normals[1], Vec3(0, 0, 0));
  EXPECT_EQ(loaded.cloud.normals[2], Vec3(0, 0, 0));
  EXPECT_EQ(loaded.cloud.normals[3], Vec3(1, 0, 0));
  ASSERT_EQ(loaded.warnings.size(), 2u);
  EXPECT_TRUE(contains(loaded.warnings[0], "2 of 4 normals"));
  EXPECT_TRUE(contains(loaded.warnings[1], "3 of 4 positions"));
  const auto unusable = scratch.read(
      "b.ply", header("ascii", elements) + "1 2 3 0 0 0\n1 2 3 0 0 0\n1 2 3 0 0 0\n1 2 3 0 0 0\n");
  EXPECT_FALSE(unusable.cloud.has_normals());
  EXPECT_EQ(unusable.warnings.size(), 1u);
}

TEST(PlyRead, SaysWhereAFileIsBroken) {
  const Scratch scratch;
  const std::string vertex = std::string("element vertex 2\n") + kXyz;
  const auto error = [&](ErrorKind kind, const std::string& bytes) {
    return error_of(kind, [&] { scratch.read("a.ply", bytes); });
  };
  const auto unreadable = [&](const std::string& bytes, const std::string& part) {
    const std::string message = error(ErrorKind::kUnreadable, bytes);
    EXPECT_TRUE(contains(message, part)) << message;
    EXPECT_TRUE(contains(message, scratch.path("a.ply").string())) << message;
  };
  unreadable("", "the file is empty");
  unreadable("plywood\n", "not a PLY file");
  unreadable("ply\nformat ascii 2.0\n", ":2: expected format");
  unreadable("ply\nformat ascii 1.0\nelement vertex\n", ":3: expected element");
  unreadable("ply\nformat ascii 1.0\nelement vertex -1\n", ":3: expected element");
  unreadable("ply\nformat ascii 1.0\nelement vertex 1\nproperty flaot x\n", ":4: unknown type");
  unreadable("ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int x\n",
             ":4: the length");
  unreadable("ply\nformat ascii 1.0\nproperty float x\n", ":3: expected");
  unreadable("ply\nformat ascii 1.0\n" + vertex, ":7: the header ends");
  unreadable("ply\n" + vertex + "end_header\n", ":6: the header has no format");
  unreadable(header("ascii", vertex) + "1 2 3\n40 50\n", ":9: too few numbers");
  unreadable(header("ascii", vertex) + "1 2 3\n4 5 6 7\n", ":9: too many numbers");
  unreadable(header("ascii", vertex) + "1 2 3\n4 five 6\n", ":9: expected a number of type float");
  unreadable(header("ascii", vertex) + "1 2 3 \n          \n", ":9: the file ends within");
  unreadable(header("ascii", "element vertex 99999999999\n" + std::string(kXyz)) + "1 2 3\n",
             "declares 99999999999 rows");
  unreadable(header("binary_little_endian", vertex) + std::string(23, '\0'), "declares 2 rows");
  EXPECT_TRUE(
      contains(error(ErrorKind::kInsufficient, header("ascii", "element point 1\n")), "point"));
  EXPECT_TRUE(contains(error(ErrorKind::kInsufficient, "ply \nformat ascii 1.0\nend_header\n"),
                       "element vertex"));
  EXPECT_TRUE(contains(
      error(ErrorKind::kInsufficient,
            header("ascii", "element vertex 1\nproperty float x\nproperty float y\n") + "1 2\n"),
      "there is x y"));
}

TEST(PlyRead, RefusesListsThatCannotBe) {
  const Scratch scratch;
  const std::string vertex = std::string("element vertex 1\n") + kXyz;
  const std::string point = packed(1.0F, 2.0F, 3.0F);
  for (const std::string type : {"char", "short", "int"}) {
    const std::string start = header("binary_little_endian",
                                     vertex + "element face 1\nproperty list " + type + " int i\n");
    std::string minus_one = type == "char" ? packed(std::int8_t{-1}) : packed(-1);
    if (type == "short") minus_one = packed(std::int16_t{-1});
    error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.ply", start + point + minus_one); });
  }
  const std::string start =
      header("binary_little_endian", vertex + "element face 1\nproperty list uint double i\n");
  error_of(ErrorKind::kUnreadable,
           [&] { scratch.read("a.ply", start + point + packed(0xFFFFFFFFu, 1.0)); });
  error_of(ErrorKind::kUnreadable, [&] {
    scratch.read("a.ply", header("ascii", vertex + "element face 1\nproperty list int int i\n") +
                              "1 2 3\n99999999999999999999 1\n");
  });
  // An element without properties has no bytes, however many rows it claims.
  const auto cloud = scratch.read(
      "b.ply",
      header("binary_little_endian", vertex + "element face 18446744073709551615\n") + point);
  EXPECT_EQ(cloud.cloud.size(), 1u);
  EXPECT_TRUE(triangles_of(cloud.cloud).empty());
}

TEST(PlyRead, NamesTheRowOfABrokenListOfVertices) {
  const Scratch scratch;
  const std::string start =
      header("binary_little_endian",
             "element vertex 3\n" + std::string(kXyz) + "property list uchar int near\n");
  const std::string row = packed(1.0F, 2.0F, 3.0F, std::uint8_t{1}, 5);
  const std::string cut_off = packed(1.0F, 2.0F, 3.0F, std::uint8_t{200}, 5);
  const std::string message =
      error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.ply", start + row + row + cut_off); });
  const std::size_t begin = start.size() + 2 * row.size();
  EXPECT_TRUE(contains(message, "byte " + std::to_string(begin) + ": row 3 of 3")) << message;
}

TEST(PlyRead, FindsTheFacesForAnyBlanksInTheHeader) {
  const Scratch scratch;
  const auto loaded = scratch.read(
      "a.ply", header("ascii", std::string("element\tvertex  3\n") + kXyz +
                                   "element  face\t1\nproperty list uchar int vertex_indices\n") +
                   "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(triangles_of(loaded.cloud), (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(PlyRead, ReadsClearlyWhatHasNoPoints) {
  const Scratch scratch;
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const auto loaded = scratch.read(
        "a.ply", header(format, std::string("element vertex 0\n") + kXyz +
                                    "property list uchar int l\nproperty uchar label\n"));
    EXPECT_TRUE(loaded.cloud.empty());
    EXPECT_FALSE(loaded.cloud.has_labels());
  }
}

TEST(PlyRead, WarnsOfBytesAfterTheLastElement) {
  const Scratch scratch;
  const std::string vertex = std::string("element vertex 1\n") + kXyz;
  const auto binary = scratch.read(
      "a.ply", header("binary_little_endian", vertex) + packed(1.0F, 2.0F, 3.0F) + "more");
  ASSERT_EQ(binary.warnings.size(), 1u);
  EXPECT_TRUE(contains(binary.warnings[0], "4 bytes"));
  EXPECT_EQ(scratch.read("b.ply", header("ascii", vertex) + "1 2 3\n4 5 6\n").warnings.size(), 1u);
  EXPECT_TRUE(scratch.read("b.ply", header("ascii", vertex) + "1 2 3\n\n  \n").warnings.empty());
}

}  // namespace
}  // namespace pcednet::io
