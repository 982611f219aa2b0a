#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/las/file.h"

namespace pcednet::io {

/// Fills a cloud from point records.
class LasRecordSink {
 public:
  /// Allocates for `points` points: the caller has checked that number against the file's size.
  LasRecordSink(const LasFile& file, std::size_t points, std::vector<std::string>& warnings);

  /// Makes room for `points` in all.
  void grow(std::size_t points);

  /// Takes the points [begin, end) of the cloud; disjoint ranges may come from several threads.
  void take(const std::byte* rows, std::size_t begin, std::size_t end);

  /// The cloud, its normals and labels in their places, its colours not yet; call it once.
  PointCloud finish();

 private:
  std::size_t stride_;
  std::array<double, 3> scale_ = {}, offset_ = {};
  std::vector<LasField> fields_ = {};
  PointCloud cloud_ = {};
};

/// Compares the points that an uncompressed file counts with those it has room for. Uncounted
/// points become a warning; where the file counts none, as one whose writing was interrupted, they
/// are its points from here on. Throws Error(kUnreadable) if the file ends before its points do.
void check_las_points(const InputFile& file, LasFile& las, std::vector<std::string>& warnings);

/// Marks a file that was compressed as uncompressed.
void forget_compression(LasFile& las);

/// 8-bit colours from the 16-bit attributes Red, Green and Blue; empty if there are none. Values
/// are divided by 257, or copied if all are `narrow`, below 256.
std::vector<Rgb> las_colours(const PointCloud& cloud, bool narrow);
bool has_narrow_colours(const PointCloud& cloud);

}  // namespace pcednet::io
