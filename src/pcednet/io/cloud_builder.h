#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/loaded_cloud.h"

namespace pcednet::io {

/// One named column of a file's table of points.
struct Column {
  std::string name;
  ScalarType type = ScalarType::kFloat64;
  std::size_t count = 1;  ///< numbers per point
  bool skip = false;      ///< padding: not kept
};

/// Turns columns of numbers into a cloud: identifies each column by its name, in every format, and
/// decodes it.
///
/// x y z are positions; nx ny nz (or normal_x ...) normals; red green blue (or diffuse_red ..., or
/// r g b) and the packed rgb or rgba of PCD colours; label or scalar_label labels, -1 and NaN
/// standing for unlabelled. Case does not matter. Colour and label columns must hold valid colours
/// and labels; if not, they become attributes in their own type, like all other columns, under the
/// names that restore_attributes() finds.
class CloudBuilder {
 public:
  /// Allocates for `points` points: the caller has checked that number against the file's size.
  /// Throws Error(kInsufficient), naming `path`, unless there are x, y and z.
  CloudBuilder(const std::filesystem::path& path, std::vector<Column> columns, std::size_t points);

  /// Takes column `column` of the points [begin, end): the first number at `first`, native byte
  /// order, `stride` bytes from point to point. Disjoint ranges may be filled from several threads.
  void fill(std::size_t column, const std::byte* first, std::size_t stride, std::size_t begin,
            std::size_t end);

  /// fill() of all columns of points that lie one after the other, without gaps.
  void fill_rows(const std::byte* rows, std::size_t begin, std::size_t end);

  std::size_t column_count() const { return columns_.size(); }
  std::size_t row_bytes() const { return row_bytes_; }
  std::size_t size() const { return cloud_.size(); }

  /// The cloud, once every column of every point is filled; call it once.
  LoadedCloud finish();

 private:
  enum class Role { kSkip, kPosition, kNormal, kColour, kLabel, kAttribute };
  struct Target {
    Role role = Role::kAttribute;
    std::size_t index = 0;  ///< which axis, channel or attribute
  };

  Attribute new_attribute(const Column& column) const;
  void store_normals();
  bool take(const std::vector<std::string>& names, Role role, bool bytes_only);
  ScalarType common_position_type() const;

  std::vector<Column> columns_;
  std::vector<Target> targets_;
  std::size_t row_bytes_ = 0;
  PointCloud cloud_;
};

/// Changes columns x, y and z from float to double.
void widen_positions(std::vector<Column>& columns);

}  // namespace pcednet::io
