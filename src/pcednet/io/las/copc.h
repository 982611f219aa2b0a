#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/output_file.h"
#include "pcednet/core/progress.h"
#include "pcednet/core/scratch_file.h"
#include "pcednet/io/las/file.h"
#include "pcednet/io/las/layout.h"
#include "pcednet/io/las/laz.h"
#include "pcednet/spatial/detail_tree.h"

namespace pcednet::io {

/// Whether the name is that of a COPC file: .copc.laz, in small letters or capitals.
bool is_copc_name(const std::filesystem::path& path);

/// Restricts the choices to those that COPC 1.0 allows: LAS 1.4 with a header of 375 bytes, point
/// format 6, 7 with colours, 8 with infrared too. Adds the record that must come first, still
/// empty.
void choose_copc(LasChoices& choices, const PointCloud& first);

/// Writes points as COPC: an octree of levels of detail (see spatial::DetailTree), one chunk a
/// node.
///
/// Points wait in a scratch file beside the output until all are known. Memory is 20 bytes a point
/// and 200 MB. The bytes are the same for any number of threads and any order of the points.
class CopcPointWriter {
 public:
  /// The points begin at `offset` of the file `path`, the position of `out`; `out` and `file` must
  /// outlive it.
  CopcPointWriter(OutputFile& out, const std::filesystem::path& path, const LasFile& file,
                  std::uint64_t offset);

  /// Takes `count` more points.
  void append(std::size_t count, const EncodePoints& encode);

  /// Writes all points and returns the bytes that points and table take. `bounds`: of the points,
  /// as in the header. Throws Error(kCancelled) if `progress`, which may be null, asks to cancel.
  std::uint64_t finish(const BoundingBox& bounds, const Progress* progress);

  /// After finish(): the data of the hierarchy record, whose first byte will be the file's byte
  /// `place`, and the data of the info record.
  const std::string& hierarchy() const { return hierarchy_; }
  std::string info(std::uint64_t place, double first_time, double last_time) const;

 private:
  /// The root of the octree, a cube.
  struct Cube {
    Vec3 corner = Vec3::Zero();
    double side = 1.0;
  };
  std::vector<spatial::TreePoint> tree_points(const Progress* progress) const;
  void write_nodes(const spatial::DetailTree& tree, const Progress* progress);
  std::size_t write_chunks(std::span<const spatial::DetailNode> nodes, std::span<std::byte> rows);
  void gather(const std::vector<std::uint32_t>& places, std::size_t begin,
              std::vector<std::byte>& window, const Progress* progress) const;
  std::size_t points() const { return waiting_.size() / stride_; }
  std::vector<std::byte> rows(std::size_t begin, std::size_t end) const;

  const LasFile& file_;
  std::size_t stride_;
  ScratchFile waiting_;
  LazPointWriter chunks_;
  Cube cube_ = {};
  std::string hierarchy_ = {};
};

}  // namespace pcednet::io
