#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/core/random.h"
#include "pcednet/formats/read_cloud.h"
#include "support/own_folder.h"

namespace pcednet::io {

/// A folder of a test's own with files to read.
class Scratch : public test::OwnFolder {
 public:
  std::filesystem::path file(const std::string& name, std::string_view bytes) const {
    std::filesystem::create_directories(path(name).parent_path());
    // Truncating an old file makes some file systems wait for the disk.
    std::filesystem::remove(path(name));
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

  LoadedCloud read(const std::string& name, std::string_view bytes) const {
    return formats::read_cloud(file(name, bytes));
  }
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The bytes of numbers one after the other, of the types they are given in.
template <typename... Numbers>
std::string packed(Numbers... numbers) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
  return bytes;
}

/// The same with the bytes of each number reversed.
template <typename... Numbers>
std::string packed_reversed(Numbers... numbers) {
  std::string bytes;
  const auto add = [&](const auto& number) {
    const std::string one = packed(number);
    bytes.append(one.rbegin(), one.rend());
  };
  (add(numbers), ...);
  return bytes;
}

/// The message of the Error that `action` throws; the test fails unless it is of that kind.
template <typename Action>
std::string error_of(ErrorKind kind, Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(static_cast<int>(error.kind()), static_cast<int>(kind)) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return "";
}

inline bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// What reading a damaged LAZ says.
inline std::string message_of(const Scratch& scratch, const std::string& bytes) {
  return error_of(ErrorKind::kUnreadable, [&] { scratch.read("odd.laz", bytes); });
}

/// Reads the file `name` so many times with one to four bytes from `begin` on replaced: what is
/// read must be consistent, and an Error must name the file.
inline void expect_to_survive_damage(const Scratch& scratch, const std::string& name,
                                     const std::string& whole, std::size_t begin, int times,
                                     Random& random) {
  for (int i = 0; i < times; ++i) {
    std::string bytes = whole;
    for (std::size_t changes = 1 + random.index(4); changes > 0; --changes) {
      bytes[begin + random.index(bytes.size() - begin)] = static_cast<char>(random.next());
    }
    try {
      check_consistent(scratch.read(name, bytes).cloud);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUnreadable) << error.what();
      EXPECT_TRUE(contains(error.what(), name)) << error.what();
    }
  }
}

/// Whether two vectors have the same bits, NaN included.
template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace pcednet::io
