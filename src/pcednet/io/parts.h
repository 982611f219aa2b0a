#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"
#include "pcednet/io/write_options.h"

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
  /// One part as in the file: finish_part() turns it into what read_cloud() returns. The first call
  /// must have returned before others begin, unless set_narrow_colours() was called.
  virtual PointCloud read(std::size_t part) const = 0;
  /// Whether the numbers of a point come from the scale steps and fields of LAS, and so fit there.
  virtual bool is_las() const { return false; }
  /// Whether all colours are below 256: unless set, LAS reads all parts to find out, before the
  /// first read().
  virtual bool narrow_colours() const { return false; }
  virtual void set_narrow_colours(bool) {}

  std::vector<std::string> warnings = {};
};

/// The counts behind the warnings of read_cloud(), part by part.
struct PartTally {
  std::size_t points = 0;
  std::size_t rescaled_normals = 0, unusable_normals = 0;
  std::size_t not_finite = 0;  ///< positions
};

/// Makes normals unit, unusable ones (0,0,0), and counts.
void finish_part(PointCloud& part, PartTally& tally);

/// The warnings for the counts, once all parts are finished.
std::vector<std::string> warnings_of(const PartTally& tally);

/// Calls `visit` with part after part, finished, until it returns false.
using EachPart = std::function<void(const std::function<bool(const PointCloud&)>& visit)>;

/// Whether all parts are so; reads none after the first that is not.
template <typename IsSo>
bool all_parts(const EachPart& each_part, const IsSo& is_so) {
  bool all = true;
  each_part([&](const PointCloud& part) { return all = is_so(part); });
  return all;
}

/// Writes a cloud part by part; the file appears under its name at commit() only.
class PartWriter {
 public:
  virtual ~PartWriter() = default;
  /// Throws Error(kFailure) for a part whose attributes differ from those of the first.
  virtual void append(const PointCloud& part) = 0;
  virtual void commit() = 0;

  std::vector<std::string> losses = {};  ///< the losses() of the whole cloud
};

/// The information that a writer needs before the first part.
struct PartOutline {
  std::size_t points = 0;
  const PointCloud* first = nullptr;  ///< part 0; must outlive the writer
  EachPart each_part = {};            ///< for decisions that need all points
  bool is_las = false;                ///< see PartReader
};

/// A whole cloud as its only part; it must outlive the outline.
PartOutline outline_of(const PointCloud& cloud);

}  // namespace pcednet::io
