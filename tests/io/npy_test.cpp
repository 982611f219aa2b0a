#include "pcednet/io/npy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/scratch.h"
#include "pcednet/core/random.h"
#include "support/expect_error.h"

namespace pcednet::io {
namespace {

/// A file as numpy.save writes it.
std::string numpy_file(const std::string& dictionary, const std::string& numbers) {
  std::string text = dictionary;
  text.append(64 - (10 + text.size() + 1) % 64, ' ');
  text += '\n';
  return std::string("\x93NUMPY\x01\x00", 8) + packed(static_cast<std::uint16_t>(text.size())) +
         text + numbers;
}

TEST(Npy, WritesWhatNumpyReads) {
  const Scratch scratch;
  NpyWriter writer(scratch.path("a.npy"), {2, 3}, ScalarType::kFloat32);
  writer.append(std::vector<float>{1, 2, 3, 4});
  EXPECT_FALSE(std::filesystem::exists(scratch.path("a.npy")));
  writer.append(std::vector<double>{5, 0.1});
  writer.commit();
  const std::string bytes = bytes_of(scratch.path("a.npy"));
  const std::string dictionary = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }";
  ASSERT_EQ(bytes.size(), 128u + 24u);
  EXPECT_EQ(bytes.substr(0, 10), std::string("\x93NUMPY\x01\x00\x76\x00", 10));
  EXPECT_EQ(bytes.substr(10, dictionary.size()), dictionary);
  EXPECT_EQ(bytes.substr(10 + dictionary.size(), 117 - dictionary.size()),
            std::string(117 - dictionary.size(), ' '));
  EXPECT_EQ(bytes.substr(127), "\n" + packed(1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 0.1F));
}

TEST(Npy, PutsNumbersInAnyOrder) {
  const Scratch scratch;
  NpyWriter writer(scratch.path("a.npy"), {3, 2}, ScalarType::kFloat32);
  writer.put(4, std::vector<float>{5, 6});
  writer.put(0, std::vector<float>{1, 2});
  EXPECT_ERROR(ErrorKind::kFailure, writer.put(0, std::vector<float>{1, 2, 3, 4}));
  writer.put(2, std::vector<float>{3, 4});
  writer.commit();
  EXPECT_EQ(read_npy(scratch.path("a.npy")).values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
}

TEST(Npy, ReadsBackEveryShape) {
  const Scratch scratch;
  for (const std::vector<std::size_t>& shape :
       {std::vector<std::size_t>{}, {7}, {0}, {3, 0, 2}, {2, 3, 4}, {1, 1, 1, 1, 1, 1, 1, 1}}) {
    std::size_t count = 1;
    for (const std::size_t size : shape) count *= size;
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(0.1 * static_cast<double>(i));
    NpyWriter writer(scratch.path("a.npy"), shape, ScalarType::kFloat64, Overwrite::kYes);
    writer.append(values);
    writer.commit();
    EXPECT_EQ(bytes_of(scratch.path("a.npy")).size() % 64, count * 8 % 64);
    const NpyArray array = read_npy(scratch.path("a.npy"));
    EXPECT_EQ(array.shape, shape);
    EXPECT_EQ(array.type, ScalarType::kFloat64);
    EXPECT_EQ(array.values, values);
  }
}

TEST(Npy, RefusesToWriteAnotherNumberOfNumbers) {
  const Scratch scratch;
  const std::vector<float> three(3);
  NpyWriter few(scratch.path("a.npy"), {4}, ScalarType::kFloat32);
  few.append(three);
  error_of(ErrorKind::kFailure, [&] { few.commit(); });
  NpyWriter many(scratch.path("b.npy"), {2}, ScalarType::kFloat32);
  error_of(ErrorKind::kFailure, [&] { many.append(three); });
  EXPECT_FALSE(std::filesystem::exists(scratch.path("a.npy")));
}

TEST(Npy, RefusesHostileHeaders) {
  const Scratch scratch;
  const std::string numbers = packed(1.0F, 2.0F);
  const auto dictionary = [](const std::string& type, const std::string& order,
                             const std::string& shape) {
    return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': (" + shape + "), }";
  };
  EXPECT_EQ(
      read_npy(scratch.file("a.npy", numpy_file(dictionary("<f4", "False", "2,"), numbers))).values,
      (std::vector<double>{1, 2}));
  for (const std::string& bad :
       {dictionary("<f4", "Maybe", "2,"), dictionary(">f4", "False", "2,"),
        dictionary("<f4", "False", "3,"), dictionary("<f4", "False", "-2,"),
        dictionary("<f4", "False", "99999999999,"), dictionary("|O", "False", "2,"),
        dictionary("<f4", "False", "4294967296, 4294967296, 4294967296"),
        dictionary("<f4", "False", "18446744073709551615, 2"), std::string("{}"), std::string()}) {
    const auto path = scratch.file("b.npy", numpy_file(bad, numbers));
    EXPECT_TRUE(contains(error_of(ErrorKind::kUnreadable, [&] { read_npy(path); }), path.string()))
        << bad;
  }
  error_of(ErrorKind::kUnreadable,
           [&] { read_npy(scratch.file("c.npy", "PK\3\4 and so on ...")); });
}

TEST(Npy, ReadsBoolHalfAndFortranOrder) {
  const Scratch scratch;
  const auto values_of = [&](const std::string& type, const std::string& order,
                             const std::string& shape, const std::string& numbers) {
    const std::string text =
        "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': (" + shape + "), }";
    return read_npy(scratch.file("a.npy", numpy_file(text, numbers))).values;
  };
  EXPECT_EQ(values_of("|b1", "False", "3,", std::string("\x01\x00\x01", 3)),
            (std::vector<double>{1, 0, 1}));
  const auto half = [](auto... bits) { return packed(static_cast<std::uint16_t>(bits)...); };
  EXPECT_EQ(values_of("<f2", "False", "6,", half(0x3c00, 0xc000, 0x3555, 0x0001, 0x7bff, 0x8000)),
            (std::vector<double>{1, -2, 1365.0 / 4096, std::ldexp(1, -24), 65504, -0.0}));
  EXPECT_EQ(values_of("<f2", "False", "2,", half(0x7c00, 0xfc00)),
            (std::vector<double>{HUGE_VAL, -HUGE_VAL}));
  EXPECT_TRUE(std::isnan(values_of("<f2", "False", "1,", half(0x7e00))[0]));
  EXPECT_EQ(values_of("<f4", "True", "2, 3", packed(1.0F, 4.0F, 2.0F, 5.0F, 3.0F, 6.0F)),
            (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(values_of("|u1", "True", "2, 3, 2",
                      std::string("\x00\x06\x02\x08\x04\x0a\x01\x07\x03\x09\x05\x0b", 12)),
            (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(values_of("<f4", "True", "0, 3", ""), (std::vector<double>{}));
  EXPECT_EQ(values_of("<f4", "True", "2,", packed(1.0F, 2.0F)), (std::vector<double>{1, 2}));
}

TEST(Npy, NamesTheCause) {
  const Scratch scratch;
  const auto path = scratch.file(
      "a.npy", numpy_file("{'descr': '>f4', 'fortran_order': False, 'shape': (1,), }", "1234"));
  const std::string said = error_of(ErrorKind::kUnreadable, [&] { read_npy(path); });
  EXPECT_TRUE(contains(said, "type \">f4\"; expected bool, or little-endian")) << said;
}

TEST(Npy, SurvivesTruncationAndFlippedBytes) {
  const Scratch scratch;
  const std::string good =
      numpy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (2,), }", packed(1.0F, 2.0F));
  for (std::size_t length = 0; length < good.size(); ++length) {
    const auto path = scratch.file("a.npy", good.substr(0, length));
    error_of(ErrorKind::kUnreadable, [&] { read_npy(path); });
  }
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    std::string bytes = good;
    bytes[random.index(80)] = static_cast<char>(random.index(256));
    try {
      const NpyArray array = read_npy(scratch.file("a.npy", bytes));
      EXPECT_LE(array.values.size(), 8u);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUnreadable);
    }
  }
}

}  // namespace
}  // namespace pcednet::io
