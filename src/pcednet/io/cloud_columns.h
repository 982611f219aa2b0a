#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::io {

/// One column of numbers to write, and where in the cloud they are stored.
struct ColumnView {
  std::string name;
  ScalarType type = ScalarType::kFloat64;    ///< to write
  const std::byte* first = nullptr;          ///< the number of point 0
  std::size_t stride = 0;                    ///< bytes from point to point
  ScalarType stored = ScalarType::kFloat64;  ///< type of the numbers in memory
  std::size_t component = 0;                 ///< which one of an attribute's components
};

/// How a format names columns, and its number types.
struct ColumnNames {
  std::vector<std::string> normals = {"nx", "ny", "nz"};
  std::vector<std::string> colours = {"red", "green", "blue"};  ///< empty: colours are left out
  ScalarType label_type = ScalarType::kUint8;
  bool has_int64 = true;    ///< otherwise two columns: kLowHalf and kHighHalf
  bool has_counts = false;  ///< columns of several numbers; otherwise name_0, name_1, ...
};

/// The columns of `cloud`, in the order of create_ply_parts, under unique names made by
/// column_name(). An attribute of several components gives as many adjacent columns.
///
/// Positions get the cloud's position_type if it represents all of them exactly, otherwise double;
/// normals are those of the file, or float. The views point into `cloud`. Throws as
/// check_consistent() does.
std::vector<ColumnView> columns_of(const PointCloud& cloud, const ColumnNames& names);

/// Throws Error(kFailure) unless both have the same names and types.
void check_same_columns(const std::filesystem::path& path, const std::vector<ColumnView>& columns,
                        const std::vector<ColumnView>& others);

/// Bytes of a row of packed columns.
std::size_t row_bytes(const std::vector<ColumnView>& columns);

/// Appends the points [begin, end) to `out` as packed rows.
void append_binary(const std::vector<ColumnView>& columns, std::size_t begin, std::size_t end,
                   std::string& out);

/// Appends the number of type `type` at `number` in the shortest form that reads back exactly.
void append_number(ScalarType type, const std::byte* number, std::string& out);

/// Appends the points [begin, end) to `out` as lines of text, with numbers as append_number()
/// writes them.
void append_text(const std::vector<ColumnView>& columns, std::size_t begin, std::size_t end,
                 char separator, std::string& out);

}  // namespace pcednet::io
