#include <gtest/gtest.h>

#include <sys/resource.h>

#include <csignal>

#include "io/e57/e57_writer.h"
#include "io/las/las_writer.h"
#include "io/sample_cloud.h"
#include "io/scratch.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/write_cloud.h"

namespace pcednet::io {
namespace {

struct Example {
  std::string name;
  std::string bytes;
  bool knows_its_size;  ///< a truncated one cannot pass for whole
};

std::string with_foreign(const std::string& format, const std::string& body) {
  return "ply\nformat " + format +
         " 1.0\ncomment c\nelement vertex 3\nproperty double x\nproperty double y\n"
         "property float z\nproperty list uchar short near\nproperty uchar red\n"
         "property uchar green\nproperty uchar blue\nproperty int label\n"
         "element face 2\nproperty list uchar int vertex_indices\nend_header\n" +
         body;
}

std::string big_endian_body() {
  using U8 = std::uint8_t;
  std::string body;
  for (int i = 0; i < 3; ++i) {
    body += packed_reversed(0.5 * i, 1.5, 2.5F, U8{2}, std::int16_t{4}, std::int16_t{5}, U8{1},
                            U8{2}, U8{3}, i);
  }
  return body + packed_reversed(U8{3}, 0, 1, 2, U8{3}, 2, 1, 0);
}

std::string e57_example() {
  return e57_file({{"<name>a</name>",
                    {e57_double("cartesianX", {1, 2, 3}), e57_single("cartesianY", {1, 2, 3}),
                     e57_integer("cartesianZ", -1, 5, {1, 2, 3})},
                    3}});
}

std::string stl_example() {
  std::string bytes = std::string(80, ' ') + packed(2u);
  for (const float z : {0.0F, 1.0F}) {
    bytes +=
        packed(0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, z, 0.0F, 1.0F, z, std::uint16_t{0});
  }
  return bytes;
}

const char* const kAsciiStl =
    "solid a\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
    "   vertex 0 1 0\n  endloop\n endfacet\nendsolid a\n";

const char* const kOff =
    "# a\nCNOFF\n4 2 0\n0 0 0 0 0 1 9 8 7\n1 0 0 0 0 1 9 8 7 255\n1 1 0 0 0 1 1 2 3\n"
    "0 1 0 0 0 1 0 0 0\n3 0 1 2\n3 0 2 3 .5 .5 .5\n";

const char* const kPtx =
    "2\n2\n4 5 6\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n4 5 6 1\n1 2 3 .5 7 8 9\n"
    "0 0 0 .5\n3 2 1 .5 7 8 9\n1 1 1 1 0 0 0\n";

/// A small file of every format and encoding.
std::vector<Example> examples(const Scratch& scratch) {
  const PointCloud cloud = sample_cloud(5);
  const auto written = [&](const std::string& name, bool ascii) {
    formats::write_cloud(scratch.path(name), cloud, {.overwrite = Overwrite::kYes, .ascii = ascii});
    return bytes_of(scratch.path(name));
  };
  const std::string las = las_bytes({3, 2, las_test_rows(3, 5)});
  formats::write_cloud(scratch.path("b.copc.laz"), scratch.read("b.las", las).cloud,
                       {.overwrite = Overwrite::kYes});
  // Six literal bytes, then runs: x y z of four points, all bytes 7.
  const std::string lzf("\x05\7\7\7\7\7\7\xE0\x21\x00", 10);
  const std::string compressed =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 4\n"
      "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA binary_compressed\n" +
      packed(static_cast<std::uint32_t>(lzf.size()), 48u) + lzf;
  return {
      {"little.ply", written("a.ply", false), true},
      {"text.ply", written("a.ply", true), false},
      {"big.ply", with_foreign("binary_big_endian", big_endian_body()), true},
      {"lists.ply",
       with_foreign("ascii",
                    "0 1 2 1 9 1 2 3 0\n4 5 6 0 1 2 3 1\n7 8 9 2 1 1 4 5 6 -1\n"
                    "3 0 1 2\n3 2 1 0\n"),
       false},
      {"binary.pcd", written("a.pcd", false), true},
      {"text.pcd", written("a.pcd", true), false},
      {"packed.pcd", compressed, true},
      {"a.obj", written("a.obj", false) + "f 1//1 2//2 -1//-1\n", false},
      {"a.off", kOff, false},
      {"a.stl", stl_example(), true},
      {"text.stl", kAsciiStl, false},
      {"a.ptx", kPtx, false},
      {"a.xyz", written("a.xyz", false), false},
      {"a.csv", written("a.csv", false), false},
      {"a.pts", written("a.pts", false), false},
      {"a.e57", e57_example(), true},
      {"a.las", las, true},
      {"a.copc.laz", bytes_of(scratch.path("b.copc.laz")), false},
  };
}

/// Reads `bytes`; what comes back is either consistent or an Error that names the file.
std::size_t try_to_read(const Scratch& scratch, const std::string& name, const std::string& bytes) {
  const auto path = scratch.file(name, bytes);
  try {
    const LoadedCloud loaded = formats::read_cloud(path);
    check_consistent(loaded.cloud);
    for (const Vec3& normal : loaded.cloud.normals) {
      EXPECT_TRUE(normal.isZero(0.0) || std::abs(normal.norm() - 1.0) < 1e-12);
    }
    return loaded.cloud.size();
  } catch (const Error& error) {
    EXPECT_TRUE(error.kind() == ErrorKind::kUnreadable || error.kind() == ErrorKind::kInsufficient);
    EXPECT_TRUE(contains(error.what(), path.string())) << error.what();
    return 0;
  }
}

TEST(Robustness, ReadsItsOwnExamples) {
  const Scratch scratch;
  for (const Example& example : examples(scratch)) {
    const std::size_t points = try_to_read(scratch, example.name, example.bytes);
    EXPECT_GE(points, 3u) << example.name;
  }
}

TEST(Robustness, SurvivesEveryTruncation) {
  const Scratch scratch;
  for (const Example& example : examples(scratch)) {
    const std::size_t whole = try_to_read(scratch, example.name, example.bytes);
    for (std::size_t length = 0; length < example.bytes.size(); ++length) {
      const std::size_t points =
          try_to_read(scratch, example.name, example.bytes.substr(0, length));
      EXPECT_LE(points, whole) << example.name << " cut at " << length;
      if (example.knows_its_size) {
        EXPECT_EQ(points, 0u) << example.name << " cut at " << length;
      }
    }
  }
}

TEST(Robustness, SurvivesFlippedBytes) {
  const Scratch scratch;
  Random random(42);
  for (const Example& example : examples(scratch)) {
    for (int i = 0; i < 1500; ++i) {
      std::string bytes = example.bytes;
      for (std::size_t flips = 1 + random.index(4); flips > 0; --flips) {
        const std::size_t place = random.index(bytes.size());
        switch (random.index(4)) {
          case 0:
            bytes[place] = static_cast<char>(random.index(256));
            break;
          case 1:
            bytes[place] = "0123456789-+.e \n\r/#,;"[random.index(21)];
            break;
          case 2:
            bytes.erase(place, 1 + random.index(4));
            break;
          default: {
            const std::size_t length = random.index(20);
            bytes.insert(place, bytes.substr(random.index(bytes.size()), length));
          }
        }
        if (bytes.empty()) bytes = "\n";
      }
      EXPECT_LE(try_to_read(scratch, example.name, bytes), bytes.size());
    }
  }
}

TEST(Robustness, SurvivesNoise) {
  const Scratch scratch;
  Random random(43);
  for (const char* name :
       {"a.ply", "a.pcd", "a.obj", "a.off", "a.stl", "a.ptx", "a.xyz", "a.csv"}) {
    for (int i = 0; i < 300; ++i) {
      std::string bytes = i % 2 ? "" : std::string(name) == "a.ply" ? "ply\n" : "# .PCD\n";
      for (std::size_t n = random.index(300); n > 0; --n) {
        bytes += static_cast<char>(random.index(i % 3 ? 256 : 64));
      }
      try_to_read(scratch, name, bytes);
    }
  }
}

TEST(ReadCloud, ChoosesByContentFirst) {
  const Scratch scratch;
  const auto ply = scratch.file("a.xyz",
                                "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\n"
                                "property int y\nproperty int z\nend_header\n1 2 3\n");
  EXPECT_EQ(formats::read_cloud(ply).cloud.position_type, ScalarType::kInt32);
  EXPECT_EQ(formats::format_of(InputFile(ply)).name, "PLY");
  EXPECT_EQ(formats::format_of(InputFile(scratch.file("a.OBJ", "v 1 2 3\n"))).name, "OBJ");
  EXPECT_EQ(formats::format_of(InputFile(scratch.file("b.Txt", "1 2 3\n"))).name, "text");
}

TEST(ReadCloud, SaysWhatItWouldAccept) {
  const Scratch scratch;
  const auto message = [&](const std::string& name, const std::string& bytes) {
    return error_of(ErrorKind::kUnreadable, [&] { scratch.read(name, bytes); });
  };
  EXPECT_TRUE(contains(message("a.las", "LASF"), "ends within the LAS header"));
  EXPECT_TRUE(contains(message("a.laz", "LA"), "must begin with LASF"));
  for (const char* name :
       {"a.ply", "a.pcd", "a.las", "a.e57", "a.obj", "a.off", "a.stl", "a.ptx", "a.xyz", "a.csv"}) {
    EXPECT_TRUE(contains(message(name, ""), std::string(name) + ": the file is empty")) << name;
  }
  EXPECT_TRUE(contains(message("a.e57", "ASTM-E57"), "ends at byte"));
  EXPECT_TRUE(contains(message("a.step", "solid"), "accepted: .ply"));
  EXPECT_TRUE(contains(message("a", "solid"), "accepted: .ply"));
  error_of(ErrorKind::kUnreadable, [&] { formats::read_cloud(scratch.path("missing.ply")); });
  error_of(ErrorKind::kUnreadable, [&] { formats::read_cloud(scratch.path("")); });
  error_of(ErrorKind::kUnreadable, [&] { formats::read_cloud("/dev/null"); });
}

TEST(WriteCloud, RefusesWhatItCannotDo) {
  const Scratch scratch;
  PointCloud cloud = sample_cloud(3);
  error_of(ErrorKind::kUsage, [&] { formats::write_cloud(scratch.path("a.e57"), cloud); });
  error_of(ErrorKind::kUsage, [&] { formats::losses(scratch.path("a"), cloud); });
  scratch.file("a.ply", "mine");
  error_of(ErrorKind::kUsage, [&] { formats::write_cloud(scratch.path("a.ply"), cloud); });
  EXPECT_EQ(bytes_of(scratch.path("a.ply")), "mine");
  error_of(ErrorKind::kFailure,
           [&] { formats::write_cloud(scratch.path("no/such/a.ply"), cloud); });
  cloud.labels.pop_back();
  for (const char* name : {"b.ply", "b.pcd", "b.obj", "b.xyz"}) {
    error_of(ErrorKind::kUsage, [&] { formats::write_cloud(scratch.path(name), cloud); });
    EXPECT_FALSE(std::filesystem::exists(scratch.path(name)));
  }
}

TEST(WriteCloud, LeavesNothingBehindWhenTheDiskTakesNoMore) {
  const Scratch scratch;
  PointCloud cloud = sample_cloud(20000);
  cloud.positions[2].y() = 0.0;  // LAS has no NaN
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const rlimit small = {100000, old_limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  for (const char* name : {"a.ply", "a.pcd", "a.obj", "a.csv", "a.las", "a.laz", "a.copc.laz"}) {
    const auto path = scratch.path(name);
    const std::string message =
        error_of(ErrorKind::kFailure, [&] { formats::write_cloud(path, cloud); });
    EXPECT_TRUE(contains(message, path.string())) << message;
  }
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path("")));
}

TEST(WriteCloud, RefusesAnElementShorterThanItsHeader) {
  const Scratch scratch;
  PointCloud cloud = sample_cloud(3);
  cloud.foreign_elements = {{"element face 1\nproperty uchar a\n", {}}};
  error_of(ErrorKind::kFailure,
           [&] { formats::write_cloud(scratch.path("a.ply"), cloud, {.ascii = true}); });
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path("")));
}

}  // namespace
}  // namespace pcednet::io
