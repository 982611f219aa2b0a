#include "pcednet/io/npy.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "pcednet/core/error.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

std::string header_of(const std::vector<std::size_t>& shape, ScalarType type) {
  std::string sizes;
  for (const std::size_t size : shape) sizes += fmt::format("{}, ", size);
  if (shape.size() > 1) sizes.resize(sizes.size() - 2);
  if (shape.size() == 1) sizes.resize(sizes.size() - 1);
  std::string dictionary = fmt::format(
      "{{'descr': '<f{}', 'fortran_order': False, 'shape': ({}), }}", size_of(type), sizes);
  // The numbers begin at a multiple of 64 bytes, after a line feed.
  const std::size_t before = kMagic.size() + 4;
  dictionary.append(63 - (before + dictionary.size()) % 64, ' ');
  dictionary += '\n';
  std::string header(kMagic);
  header += std::string_view("\x01\x00", 2);
  header += static_cast<char>(dictionary.size() & 0xFF);
  header += static_cast<char>(dictionary.size() >> 8);
  return header + dictionary;
}

/// How a file holds its numbers.
struct Storage {
  std::size_t bytes = 0;                   ///< of a number
  ScalarType type = ScalarType::kFloat64;  ///< that holds all of them
};

std::optional<Storage> parse_storage(std::string_view descr) {
  static constexpr std::pair<std::string_view, Storage> kStorages[] = {
      {"<f2", {2, ScalarType::kFloat32}}, {"<f4", {4, ScalarType::kFloat32}},
      {"<f8", {8, ScalarType::kFloat64}}, {"|b1", {1, ScalarType::kUint8}},
      {"|i1", {1, ScalarType::kInt8}},    {"|u1", {1, ScalarType::kUint8}},
      {"<i2", {2, ScalarType::kInt16}},   {"<u2", {2, ScalarType::kUint16}},
      {"<i4", {4, ScalarType::kInt32}},   {"<u4", {4, ScalarType::kUint32}},
      {"<i8", {8, ScalarType::kInt64}},   {"<u8", {8, ScalarType::kUint64}},
  };
  for (const auto& [name, storage] : kStorages) {
    if (name == descr) return storage;
  }
  return std::nullopt;
}

/// The number in the 16 bits of IEEE 754's binary16.
double half_of(const std::byte* bytes) {
  std::uint16_t bits = 0;
  std::memcpy(&bits, bytes, sizeof(bits));
  const int exponent = (bits >> 10) & 31, fraction = bits & 1023;
  const double size = exponent == 31  ? (fraction == 0 ? HUGE_VAL : std::nan(""))
                      : exponent == 0 ? std::ldexp(fraction, -24)
                                      : std::ldexp(1024 + fraction, exponent - 25);
  return (bits & 0x8000) != 0 ? -size : size;
}

/// Numbers of which the first index varies fastest, so that the last does.
std::vector<double> in_c_order(const std::vector<double>& values,
                               const std::vector<std::size_t>& shape) {
  std::vector<double> ordered;
  ordered.reserve(values.size());
  std::vector<std::size_t> index(shape.size(), 0);
  while (ordered.size() < values.size()) {
    std::size_t from = 0;
    for (std::size_t k = shape.size(); k-- > 0;) from = from * shape[k] + index[k];
    ordered.push_back(values[from]);
    for (std::size_t k = shape.size(); k-- > 0 && ++index[k] == shape[k];) index[k] = 0;
  }
  return ordered;
}

/// The text behind `key` in the dictionary, up to `end`.
std::string_view entry(std::string_view dictionary, std::string_view key, char end) {
  const std::size_t at = dictionary.find(key);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = trim(dictionary.substr(at + key.size()));
  return rest.substr(0, std::min(rest.find(end), rest.size()));
}

/// The shape, or none if it is not one or its product overflows.
std::optional<std::vector<std::size_t>> parse_shape(std::string_view text, std::size_t& product) {
  std::vector<std::string_view> words;
  split(text, words, Separators(" ,"));
  std::vector<std::size_t> shape;
  product = 1;
  for (const std::string_view word : words) {
    const auto size = parse_count(word);
    if (!size || (*size != 0 && product > (SIZE_MAX >> 4) / *size)) return std::nullopt;
    product *= *size;
    shape.push_back(*size);
  }
  return shape;
}

}  // namespace

NpyWriter::NpyWriter(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
                     ScalarType type, Overwrite overwrite)
    : file_(path, overwrite), path_(path), type_(type) {
  for (const std::size_t size : shape) missing_ *= size;
  const std::string header = header_of(shape, type);
  header_ = header.size();
  file_.write(header);
}

void NpyWriter::take(std::size_t numbers) {
  if (numbers > missing_) {
    throw Error(ErrorKind::kFailure,
                fmt::format("{}: more numbers than its shape holds", path_.string()));
  }
  missing_ -= numbers;
}

template <typename From>
void NpyWriter::append_as(std::span<const From> numbers) {
  take(numbers.size());
  if (scalar_type_of<From>() == type_) {
    file_.write(std::as_bytes(numbers));
  } else if (type_ == ScalarType::kFloat32) {
    const std::vector<float> converted(numbers.begin(), numbers.end());
    file_.write(std::as_bytes(std::span(converted)));
  } else {
    const std::vector<double> converted(numbers.begin(), numbers.end());
    file_.write(std::as_bytes(std::span(converted)));
  }
}

void NpyWriter::append(std::span<const float> numbers) {
  append_as(numbers);
}

void NpyWriter::append(std::span<const double> numbers) {
  append_as(numbers);
}

void NpyWriter::put(std::size_t first, std::span<const float> numbers) {
  if (type_ != ScalarType::kFloat32) {
    throw Error(ErrorKind::kFailure, fmt::format("{}: not an array of float32", path_.string()));
  }
  take(numbers.size());
  file_.write_at(header_ + first * sizeof(float), std::as_bytes(numbers));
}

void NpyWriter::commit() {
  if (missing_ != 0) {
    throw Error(ErrorKind::kFailure,
                fmt::format("{}: {} numbers fewer than its shape holds", path_.string(), missing_));
  }
  file_.commit();
}

NpyArray read_npy(const std::filesystem::path& path) {
  const InputFile file(path);
  const std::string start = file.text(0, 12);
  if (start.size() < 12 || !start.starts_with(kMagic)) throw unreadable(path, "not a .npy file");
  const auto byte = [&](std::size_t i) {
    return std::uint64_t{static_cast<unsigned char>(start[i])};
  };
  const bool wide = byte(6) >= 2;  // later versions have four bytes of length
  const std::uint64_t length =
      byte(8) | byte(9) << 8 | (wide ? byte(10) << 16 | byte(11) << 24 : 0);
  const std::uint64_t begin = (wide ? 12 : 10) + length;
  if (begin > file.size()) throw unreadable(path, "ends within its header");
  const std::string dictionary = file.text(wide ? 12 : 10, length);

  NpyArray array;
  std::size_t product = 0;
  const std::string_view descr = trim(entry(dictionary, "'descr': '", '\''));
  const auto storage = parse_storage(descr);
  const auto shape = parse_shape(entry(dictionary, "'shape': (", ')'), product);
  const std::string_view order = entry(dictionary, "'fortran_order': ", ',');
  if (!storage && !descr.empty()) {
    throw unreadable(path, fmt::format("its numbers are of numpy's type \"{}\"; expected bool, or "
                                       "little-endian integers or floats of up to 64 bits",
                                       descr));
  }
  if (!storage || !shape || (order != "False" && order != "True")) {
    throw unreadable(path, "its header is not that of an array of numbers");
  }
  if (product > (file.size() - begin) / storage->bytes) {
    throw unreadable(path, fmt::format("declares {} numbers, but ends {} bytes after byte {}",
                                       product, file.size() - begin, begin));
  }
  Attribute numbers{"", storage->type, 1, std::vector<std::byte>(product * storage->bytes)};
  file.read(begin, numbers.bytes);
  const bool is_half = storage->bytes < size_of(storage->type);
  array.shape = *shape;
  array.type = storage->type;
  array.is_bool = descr == "|b1";
  array.values.reserve(product);
  for (std::size_t i = 0; i < product; ++i) {
    array.values.push_back(is_half ? half_of(numbers.bytes.data() + 2 * i) : numbers.value(i));
  }
  if (order == "True") array.values = in_c_order(array.values, array.shape);
  return array;
}

}  // namespace pcednet::io
