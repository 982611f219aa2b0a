#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "pcednet/cloud/attribute.h"
#include "pcednet/core/output_file.h"

namespace pcednet::io {

/// Writes one array as NumPy's .npy (version 1.0, C order), part by part: by append() in order, or
/// by put() in any order, not by both.
class NpyWriter {
 public:
  /// `type` must be float32 or float64. Throws like OutputFile.
  NpyWriter(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
            ScalarType type, Overwrite overwrite = Overwrite::kNo);

  /// Appends numbers, converted to the array's type.
  void append(std::span<const float> numbers);
  void append(std::span<const double> numbers);

  /// Writes numbers at number `first` of the array, which must be of the array's type; each must be
  /// put once.
  void put(std::size_t first, std::span<const float> numbers);

  /// Must be called once, last. Throws Error(kFailure) unless the shape is filled exactly.
  void commit();

 private:
  template <typename From>
  void append_as(std::span<const From> numbers);
  void take(std::size_t numbers);

  OutputFile file_;
  std::filesystem::path path_;
  ScalarType type_;
  std::size_t header_ = 0;   ///< bytes
  std::size_t missing_ = 1;  ///< numbers still to come
};

/// An array read from a file, in C order.
struct NpyArray {
  std::vector<std::size_t> shape;
  ScalarType type = ScalarType::kFloat64;  ///< in the file; of 16-bit floats kFloat32
  bool is_bool = false;                    ///< the values are 0 and 1
  std::vector<double> values;
};

/// Reads a .npy file with bools, or little-endian integers or floats, in C or in Fortran order.
/// Throws Error(kUnreadable), naming the cause, for any other, or one whose size does not fit its
/// shape.
NpyArray read_npy(const std::filesystem::path& path);

}  // namespace pcednet::io
