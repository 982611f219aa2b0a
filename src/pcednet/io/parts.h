#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"
#include "pcednet/io/write_cloud.h"

namespace pcednet::io {

/// A point file read part by part, so that it need not fit into memory.
///
/// The points of all parts, one part after the other, are those of read_cloud. Comments, foreign
/// elements and scanners come with part 0.
class PartReader {
 public:
  virtual ~PartReader() = default;

  virtual std::size_t points() const = 0;
  virtual std::size_t parts() const = 0;
  /// One part, as the file has it: finish_part() makes of it what read_cloud gives.
  virtual PointCloud read(std::size_t part) const = 0;
  /// Whether the numbers of a point come from the steps and fields of LAS, so that they fit there.
  virtual bool is_las() const { return false; }

  std::vector<std::string> warnings = {};
};

/// Opens LAS, LAZ and binary PLY for reading in parts of about `most` points (LAZ: in whole
/// chunks), E57 scan by scan. Null for what is read only as a whole: other formats, no points, PLY
/// with lists in its vertices, much besides them, or colours or labels of other types than uint8.
/// Throws as read_cloud.
std::unique_ptr<PartReader> open_parts(const std::filesystem::path& path,
                                       std::size_t most = std::size_t{1} << 19);

/// What read_cloud says of the points, counted part by part.
struct PartTally {
  std::size_t points = 0;
  std::size_t rescaled_normals = 0, unusable_normals = 0;
  std::size_t not_finite = 0;  ///< positions
};

/// Makes normals unit, unusable ones (0,0,0), and counts.
void finish_part(PointCloud& part, PartTally& tally);

/// The warnings that the counts deserve, once all parts are finished.
std::vector<std::string> warnings_of(const PartTally& tally);

/// Calls `visit` with part after part, finished, until it returns false.
using EachPart = std::function<void(const std::function<bool(const PointCloud&)>& visit)>;

/// Writes a cloud part by part; the file appears under its name at commit() only.
class PartWriter {
 public:
  virtual ~PartWriter() = default;
  /// Throws Error(kFailure) for a part whose attributes differ from those of the first.
  virtual void append(const PointCloud& part) = 0;
  virtual void commit() = 0;

  std::vector<std::string> losses = {};  ///< as losses() of the whole cloud
};

/// What a writer must know before the first part.
struct PartOutline {
  std::size_t points = 0;
  const PointCloud* first = nullptr;  ///< part 0; must outlive the writer
  EachPart each_part = {};            ///< for what takes all points to decide
  bool is_las = false;                ///< see PartReader
};

/// Opens a file to append the parts that `outline` tells of: the same bytes as write_cloud of them
/// all. Null for formats written only as a whole: .pcd and .obj. Throws as write_cloud.
std::unique_ptr<PartWriter> create_parts(const std::filesystem::path& path,
                                         const PartOutline& outline, const WriteOptions& options);

}  // namespace pcednet::io
