#include <gtest/gtest.h>

#include <cmath>

#include "io/sample_cloud.h"
#include "io/scratch.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/pcd/lzf.h"

namespace pcednet::io {
namespace {

std::string header(const std::string& fields, const std::string& sizes, const std::string& types,
                   const std::string& counts, std::size_t points, const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " +
         sizes + "\nTYPE " + types + "\nCOUNT " + counts + "\nWIDTH " + std::to_string(points) +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\nDATA " +
         data + "\n";
}

/// LZF that repeats nothing, or, where it can, the run of one byte.
std::string packed_lzf(const std::string& plain) {
  std::string out;
  for (std::size_t i = 0; i < plain.size();) {
    std::size_t run = 0;
    while (i > 0 && i + run < plain.size() && plain[i + run] == plain[i - 1] && run < 264) ++run;
    if (run >= 9) {
      out += static_cast<char>(7 << 5);
      out += static_cast<char>(run - 9);
      out += '\0';
      i += run;
    } else if (run >= 3) {
      out += static_cast<char>((run - 2) << 5);
      out += '\0';
      i += run;
    } else {
      out += '\0';
      out += plain[i++];
    }
  }
  return out;
}

bool unpack(const std::string& in, std::string& out) {
  return unpack_lzf(std::as_bytes(std::span(in)), std::as_writable_bytes(std::span(out)));
}

TEST(Lzf, UnpacksLiteralsAndRepeats) {
  std::string out(12, '?');
  // "abc", then six bytes from three back (overlapping), then nine less ... two literals.
  EXPECT_TRUE(unpack(std::string("\x02"
                                 "abc"
                                 "\x80\x02"
                                 "\x02"
                                 "xyz",
                                 10),
                     out));
  EXPECT_EQ(out, "abcabcabcxyz");
  // Longest form: 7 in the high bits, 3 more in a byte, 2 on top.
  out.assign(13, '?');
  EXPECT_TRUE(unpack(std::string("\x00"
                                 "a"
                                 "\xE0\x03\x00",
                                 5),
                     out));
  EXPECT_EQ(out, "aaaaaaaaaaaaa");
}

TEST(Lzf, RefusesWhatDoesNotFit) {
  const std::string good(
      "\x02"
      "abc"
      "\x80\x02",
      6);
  std::string out(9, '?');
  ASSERT_TRUE(unpack(good, out));
  for (const std::size_t size : {0u, 3u, 8u, 10u}) {
    std::string other(size, '?');
    EXPECT_FALSE(unpack(good, other)) << size;
  }
  for (std::size_t length = 0; length < good.size(); ++length) {
    EXPECT_FALSE(unpack(good.substr(0, length), out)) << length;
  }
  EXPECT_FALSE(unpack(std::string("\x02"
                                  "abc"
                                  "\x80\x03",
                                  6),
                      out));  // before the start
  EXPECT_FALSE(unpack(std::string("\xE0", 1), out));
  EXPECT_FALSE(unpack(std::string("\xE0\x00", 2), out));
}

TEST(Pcd, SaysHowMuchItDoesNotReadBehindTheLastPoint) {
  const Scratch scratch;
  const auto head = [](const std::string& data, std::size_t points) {
    return header("x y z", "4 4 4", "F F F", "1 1 1", points, data);
  };
  const auto warnings = [&](const std::string& bytes) {
    const auto loaded = scratch.read("a.pcd", bytes);
    EXPECT_LE(loaded.cloud.size(), 2u);
    return loaded.warnings;
  };
  const std::string row = packed(1.0F, 2.0F, 3.0F), plain = packed(1.0F, 2.0F, 3.0F),
                    lzf = packed_lzf(plain);
  const auto size = [](const std::string& text) { return static_cast<std::uint32_t>(text.size()); };
  const std::string compressed =
      head("binary_compressed", 1) + packed(size(lzf), size(plain)) + lzf;
  const auto unread = [](const std::string& figures) {
    return std::vector<std::string>{figures + " of the header were not read"};
  };
  EXPECT_EQ(warnings(head("ascii", 2) + "1 2 3\n4 5 6\n\n7 8 9\n1 1 1"),
            unread("11 bytes after the 2 points"));
  EXPECT_EQ(warnings(head("ascii", 0) + "1 2 3\n"), unread("6 bytes after the 0 points"));
  EXPECT_EQ(warnings(head("binary", 2) + row + row + row), unread("12 bytes after the 2 points"));
  EXPECT_EQ(warnings(compressed + row), unread("12 bytes after the 1 points"));
  for (const std::string& exact :
       {head("ascii", 2) + "1 2 3\n4 5 6\n\n \n", head("binary", 2) + row + row, compressed}) {
    EXPECT_TRUE(warnings(exact).empty());
  }
}

TEST(Pcd, ReadsEveryEncoding) {
  const Scratch scratch;
  using U8 = std::uint8_t;
  const std::string fields = "x _ y z normal_x normal_y normal_z rgb label fpfh count";
  const auto head = [&](const std::string& data) {
    return header(fields, "4 1 4 4 4 4 4 4 4 4 2", "F U F F F F F U U F I", "1 3 1 1 1 1 1 1 1 2 1",
                  2, data);
  };
  const std::uint32_t rgb = 0xFF010203;
  const U8 gap = 9;
  const float nan = std::nanf("");
  const std::string rows = packed(1.5F, gap, gap, gap, 2.5F, 3.5F, 0.0F, 0.0F, 2.0F, rgb, 2u, 0.25F,
                                  0.5F, std::int16_t{-3}) +
                           packed(nan, gap, gap, gap, 5.5F, 6.5F, 1.0F, 0.0F, 0.0F, 0u, 0u, 1.25F,
                                  1.5F, std::int16_t{4});
  const std::string columns =
      packed(1.5F, nan) + std::string(6, 9) + packed(2.5F, 5.5F, 3.5F, 6.5F) +
      packed(0.0F, 1.0F, 0.0F, 0.0F, 2.0F, 0.0F) + packed(rgb, 0u, 2u, 0u) +
      packed(0.25F, 0.5F, 1.25F, 1.5F) + packed(std::int16_t{-3}, std::int16_t{4});
  const std::string lzf = packed_lzf(columns);
  const auto size_of_string = [](const std::string& s) {
    return static_cast<std::uint32_t>(s.size());
  };
  for (const auto& loaded :
       {scratch.read("a.pcd", head("binary") + rows),
        scratch.read("b.pcd", head("binary_compressed") +
                                  packed(size_of_string(lzf), size_of_string(columns)) + lzf),
        scratch.read("c.pcd", head("ascii") + "1.5 9 9 9 2.5 3.5 0 0 2 4278256131 2 0.25 0.5 -3\n"
                                              "nan 9 9 9 5.5 6.5 1 0 0 0 0 1.25 1.5 4\n")}) {
    const PointCloud& cloud = loaded.cloud;
    ASSERT_EQ(cloud.size(), 2u);
    EXPECT_EQ(cloud.positions[0], Vec3(1.5, 2.5, 3.5));
    EXPECT_TRUE(std::isnan(cloud.positions[1].x()));
    EXPECT_EQ(cloud.positions[1].z(), 6.5);
    EXPECT_EQ(cloud.position_type, ScalarType::kFloat32);
    EXPECT_EQ(cloud.normals[0], Vec3(0, 0, 1));
    EXPECT_EQ(cloud.colours[0], (Rgb{1, 2, 3}));
    EXPECT_EQ(cloud.labels, (std::vector<U8>{2, 0}));
    ASSERT_EQ(cloud.attributes.size(), 2u);
    EXPECT_EQ(cloud.attributes[0].name, "fpfh");
    EXPECT_EQ(cloud.attributes[0].components, 2u);
    EXPECT_EQ(cloud.attributes[0].value(0, 1), 0.5);
    EXPECT_EQ(cloud.attributes[0].value(1, 0), 1.25);
    EXPECT_EQ(cloud.attributes[1].type, ScalarType::kInt16);
    EXPECT_EQ(cloud.attributes[1].value(0), -3.0);
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_TRUE(contains(loaded.warnings[0], "1 of 2 positions"));
  }
}

TEST(Pcd, ReadsOldAndSparseHeaders) {
  const Scratch scratch;
  const auto old = scratch.read("a.pcd",
                                "# .PCD v.5 - Point Cloud Data file format\nVERSION .5\n"
                                "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\n"
                                "HEIGHT 1\nPOINTS 2\nDATA ascii\n1 2 3\n4 5 6");
  EXPECT_EQ(old.cloud.positions.at(1), Vec3(4, 5, 6));
  const auto sparse = scratch.read("b.pcd",
                                   "FIELDS X Y Z\r\nSIZE 8 8 8\r\nTYPE F F F\r\nPOINTS 1\r\n"
                                   "DATA binary\r\n" +
                                       packed(1.0, 2.0, 3.0));
  EXPECT_EQ(sparse.cloud.positions.at(0), Vec3(1, 2, 3));
  EXPECT_EQ(sparse.cloud.position_type, ScalarType::kFloat64);
  const auto commented = scratch.read("c.pcd",
                                      "# exported by a robot\n# .PCD v0.7\nVERSION 0.7\n"
                                      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\n"
                                      "DATA ascii\n1 2 3\n");
  EXPECT_EQ(commented.cloud.positions.at(0), Vec3(1, 2, 3));
  EXPECT_EQ(commented.cloud.comments,
            (std::vector<std::string>{"exported by a robot", ".PCD v0.7"}));
}

TEST(Pcd, TakesColoursPackedInAFloat) {
  const Scratch scratch;
  const std::uint32_t argb = 0x80102030;
  float packed_colour = 0;
  std::memcpy(&packed_colour, &argb, sizeof argb);
  const auto read = [&](const std::string& name) {
    return scratch
        .read("a.pcd", header("x y z " + name, "4 4 4 4", "F F F F", "1 1 1 1", 1, "binary") +
                           packed(1.0F, 2.0F, 3.0F, packed_colour))
        .cloud;
  };
  EXPECT_EQ(read("rgb").colours.at(0), (Rgb{16, 32, 48}));
  EXPECT_TRUE(read("rgb").attributes.empty());
  EXPECT_EQ(read("rgba").colours.at(0), (Rgb{16, 32, 48}));
  ASSERT_EQ(read("rgba").attributes.size(), 1u);
  EXPECT_EQ(read("rgba").attributes[0].name, "alpha");
  EXPECT_EQ(read("rgba").attributes[0].value(0), 128.0);
}

TEST(Pcd, GivesBackWhatItWasGiven) {
  const Scratch scratch;
  PointCloud cloud = sample_cloud(20000);
  cloud.comments = {"made by a test", "VIEWPOINT of the scanner at the front door",
                    "VIEWPOINT 1 2 3 0 1 0 0", "WIDTH 200 HEIGHT 100"};
  std::vector<std::byte> bytes(cloud.size() * 12);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i % 61);
  cloud.attributes.push_back({"fpfh", ScalarType::kInt32, 3, bytes});
  cloud.attributes.push_back(
      make_attribute("time", std::vector<std::int64_t>(cloud.size(), -(1ll << 60))));
  EXPECT_TRUE(formats::losses("a.pcd", cloud).empty());
  for (const bool ascii : {false, true}) {
    formats::write_cloud(scratch.path("a.pcd"), cloud,
                         {.overwrite = Overwrite::kYes, .ascii = ascii});
    const std::string start = bytes_of(scratch.path("a.pcd")).substr(0, 600);
    EXPECT_TRUE(
        contains(start, "\nWIDTH 200\nHEIGHT 100\nVIEWPOINT 1 2 3 0 1 0 0\nPOINTS 20000\n"));
    EXPECT_TRUE(contains(start, "\nCOUNT 1 1 1 1 1 1 1 1 1 1 1 3 1 1\n"));
    const PointCloud back = formats::read_cloud(scratch.path("a.pcd")).cloud;
    EXPECT_TRUE(same_bits(back.positions, cloud.positions));
    EXPECT_EQ(back.position_type, cloud.position_type);
    EXPECT_EQ(back.colours, cloud.colours);
    EXPECT_EQ(back.labels, cloud.labels);
    EXPECT_EQ(back.comments, cloud.comments);
    ASSERT_EQ(back.attributes.size(), cloud.attributes.size());
    for (const Attribute& attribute : cloud.attributes) {
      const Attribute* found = find_attribute(back, attribute.name);
      ASSERT_TRUE(found) << attribute.name;
      EXPECT_EQ(found->type, attribute.type);
      EXPECT_EQ(found->components, attribute.components);
      EXPECT_EQ(found->bytes, attribute.bytes);
    }
  }
}

TEST(Pcd, SaysWhereAFileIsBroken) {
  const Scratch scratch;
  const auto unreadable = [&](const std::string& bytes, const std::string& part) {
    const std::string message =
        error_of(ErrorKind::kUnreadable, [&] { scratch.read("a.pcd", bytes); });
    EXPECT_TRUE(contains(message, part)) << message;
    EXPECT_TRUE(contains(message, scratch.path("a.pcd").string())) << message;
  };
  const auto xyz = [](std::size_t points, const std::string& data) {
    return header("x y z", "4 4 4", "F F F", "1 1 1", points, data);
  };
  unreadable("1 2 3\n4 5 6\n", ":1: not a PCD file");
  unreadable("VERSION 0.7\nFIELDS x y z\n", ":2: the header ends without DATA");
  unreadable("VERSION 0.7\nNONSENSE\n", ":2: not a line of a PCD header");
  unreadable("VERSION 0.7\nDATA ascii\n", ":2: the header has no FIELDS");
  unreadable("VERSION 0.7\nWIDTH -1\n", ":2: expected WIDTH");
  unreadable(header("x y z", "4 4", "F F F", "1 1 1", 1, "ascii"), "3 FIELDS with 2 SIZE");
  unreadable(header("x y z", "4 4 3", "F F F", "1 1 1", 1, "ascii"), "field z");
  unreadable(header("x y z", "4 4 4", "F F Q", "1 1 1", 1, "ascii"), "field z");
  unreadable(header("x y z", "4 4 4", "F F F", "1 1 0", 1, "ascii"), "field z");
  unreadable(header("x y z", "4 4 4", "F F F", "1 1 99999999999", 1, "ascii"), "field z");
  unreadable(xyz(1, "binary_squeezed"), "expected DATA");
  unreadable("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 3\nPOINTS 7\nDATA ascii\n",
             "WIDTH 2 times HEIGHT 3 is not POINTS 7");
  unreadable(
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 18446744073709551615\n"
      "HEIGHT 18446744073709551615\nDATA ascii\n",
      "is not POINTS");
  unreadable(xyz(2, "ascii") + "1 2 3\n40 50\n", ":13: 2 numbers instead of 3");
  unreadable(xyz(2, "ascii") + "1 2 3\n4 5 z\n", ":13: z: not a number of its type");
  unreadable(xyz(2, "ascii") + "1 2 3       \n", ":12: the file ends after 1 of 2");
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    unreadable(xyz(99999999999, data) + "1 2 3 4 5 6 7 8 9\n", "");
  }
  unreadable(xyz(1, "binary") + std::string(11, '\0'), "declares 1 points");
  const std::string plain(12, '\0');
  const std::string lzf = packed_lzf(plain);
  const auto size = static_cast<std::uint32_t>(lzf.size());
  EXPECT_EQ(
      scratch.read("b.pcd", xyz(1, "binary_compressed") + packed(size, 12u) + lzf).cloud.size(),
      1u);
  unreadable(xyz(1, "binary_compressed") + packed(size, 13u) + lzf, "13 bytes for 1 points");
  unreadable(xyz(1, "binary_compressed") + packed(size + 1, 12u) + lzf, "declares");
  unreadable(xyz(1, "binary_compressed") + packed(size - 1, 12u) + lzf, "damaged");
  unreadable(xyz(1, "binary_compressed") + packed(size, 0xFFFFFFFCu) + lzf, "declares");
  error_of(ErrorKind::kInsufficient, [&] {
    scratch.read("a.pcd", header("x y", "4 4", "F F", "1 1", 1, "ascii") + "1 2\n");
  });
}

TEST(Pcd, ReadsAndWritesNoPoints) {
  const Scratch scratch;
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    EXPECT_TRUE(
        scratch.read("a.pcd", header("x y z", "4 4 4", "F F F", "1 1 1", 0, data)).cloud.empty());
  }
  formats::write_cloud(scratch.path("b.pcd"), {});
  EXPECT_TRUE(formats::read_cloud(scratch.path("b.pcd")).cloud.empty());
}

}  // namespace
}  // namespace pcednet::io
