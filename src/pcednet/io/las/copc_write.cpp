#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "pcednet/core/bytes.h"
#include "pcednet/core/digest.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/io/las/copc.h"
#include "pcednet/spatial/detail_tree.h"
#include "pcednet/spatial/morton.h"

namespace pcednet::io {
namespace {

constexpr std::size_t kRowsAtOnce = 32768;
constexpr double kCellsPerSide = 1 << 21;       // of the keys of spatial::TreePoint
constexpr double kVoxelsPerSide = 128.0;        // of a node of spatial::DetailTree
constexpr std::size_t kLeastWindow = 1U << 27;  // bytes of rows in memory at once
constexpr std::size_t kChunksAtOnce = 32;
constexpr std::size_t kWindowPerPoint = 16;  // what the points of the tree took

std::array<double, 3> position_of(const LasFile& file, const std::byte* row) {
  std::array<double, 3> position = {};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    position[axis] = load<std::int32_t>(row + 4 * axis) * file.scale(axis) + file.offset(axis);
  }
  return position;
}

/// A number with the order of the time, NaN at the ends.
std::uint64_t order_of_time(const std::byte* row) {
  constexpr std::size_t kGpsTime = 22, kSign = 63;
  const auto bits = load<std::uint64_t>(row + kGpsTime);
  return bits >> kSign ? ~bits : bits | std::uint64_t{1} << kSign;
}

/// The order in which points were measured compresses best.
void sort_by_time(std::span<std::byte> rows, std::size_t stride) {
  const std::vector<std::byte> before(rows.begin(), rows.end());
  std::vector<std::pair<std::uint64_t, const std::byte*>> order(rows.size() / stride);
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = {order_of_time(&before[i * stride]), &before[i * stride]};
  }
  std::sort(order.begin(), order.end());  // where times are equal, by place
  for (std::size_t i = 0; i < order.size(); ++i) {
    std::memcpy(&rows[i * stride], order[i].second, stride);
  }
}

}  // namespace

CopcPointWriter::CopcPointWriter(OutputFile& out, const std::filesystem::path& path,
                                 const LasFile& file, std::uint64_t offset)
    : file_(file),
      stride_(file.record_length()),
      waiting_(path),
      chunks_(out, file, offset, LazChunks::kVariable) {}

void CopcPointWriter::append(std::size_t count, const EncodePoints& encode) {
  write_blocks([&](std::string_view rows) { waiting_.write(rows); }, count, encode);
  if (points() <= UINT32_MAX) return;
  throw Error(ErrorKind::kFailure, "a COPC file of more than 4294967295 points: write several");
}

std::vector<std::byte> CopcPointWriter::rows(std::size_t begin, std::size_t end) const {
  std::vector<std::byte> bytes((end - begin) * stride_);
  waiting_.read(begin * stride_, bytes);
  return bytes;
}

std::vector<spatial::TreePoint> CopcPointWriter::tree_points(const Progress* progress) const {
  std::vector<spatial::TreePoint> found(points());
  Stage stage(progress, "octree", points());
  parallel_blocks(points(), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    const std::vector<std::byte> block = rows(begin, end);
    for (std::size_t i = begin; i < end; ++i) {
      const std::byte* row = &block[(i - begin) * stride_];
      const std::array<double, 3> position = position_of(file_, row);
      std::array<std::uint32_t, 3> cell = {};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double share = (position[axis] - cube_.corner[static_cast<int>(axis)]) / cube_.side;
        cell[axis] = static_cast<std::uint32_t>(
            std::clamp(std::floor(share * kCellsPerSide), 0.0, kCellsPerSide - 1.0));
      }
      const std::uint64_t digest = Digest().add({row, stride_}).lanes()[0];
      found[i] = {spatial::morton_code(cell), static_cast<std::uint32_t>(digest),
                  static_cast<std::uint32_t>(i)};
    }
    stage.advance(end - begin);
  });
  return found;
}

/// Fills `rows` with those of the places from `begin` on.
void CopcPointWriter::gather(const std::vector<std::uint32_t>& places, std::size_t begin,
                             std::vector<std::byte>& window, const Progress* progress) const {
  const std::size_t count = window.size() / stride_;
  parallel_blocks(points(), kRowsAtOnce, [&](std::size_t first, std::size_t last) {
    throw_if_cancelled(progress);
    const std::vector<std::byte> block = rows(first, last);
    for (std::size_t i = first; i < last; ++i) {
      if (places[i] < begin || places[i] - begin >= count) continue;
      std::memcpy(&window[(places[i] - begin) * stride_], &block[(i - first) * stride_], stride_);
    }
  });
}

/// Node after node, as many at once as their rows fit into a window.
void CopcPointWriter::write_nodes(const spatial::DetailTree& tree, const Progress* progress) {
  Stage stage(progress, "compress", points());
  const std::size_t most = std::max(kLeastWindow, kWindowPerPoint * points()) / stride_;
  std::size_t written = 0;
  for (std::size_t first = 0, last = 0; first < tree.nodes.size(); first = last) {
    std::size_t count = 0;
    do {
      count += tree.nodes[last++].points;
    } while (last < tree.nodes.size() && count + tree.nodes[last].points <= most);
    std::vector<std::byte> window(count * stride_);
    gather(tree.places, written, window, progress);
    written += count;
    std::span<std::byte> rest = window;
    for (std::size_t n = first; n < last; n += kChunksAtOnce) {
      const std::size_t nodes = std::min(kChunksAtOnce, last - n);
      const std::size_t taken = write_chunks(std::span(tree.nodes).subspan(n, nodes), rest);
      rest = rest.subspan(taken);
      stage.advance(taken / stride_);
    }
  }
}

/// Writes a chunk for each node, from the rows at the beginning of `rows`; returns their bytes.
std::size_t CopcPointWriter::write_chunks(std::span<const spatial::DetailNode> nodes,
                                          std::span<std::byte> rows) {
  std::vector<std::span<std::byte>> rows_of_nodes;
  std::size_t taken = 0;
  for (const spatial::DetailNode& node : nodes) {
    rows_of_nodes.push_back(rows.subspan(taken, node.points * stride_));
    taken += rows_of_nodes.back().size();
  }
  parallel_blocks(nodes.size(), 1,
                  [&](std::size_t n, std::size_t) { sort_by_time(rows_of_nodes[n], stride_); });
  std::uint64_t place = chunks_.place();
  const std::vector<std::size_t> sizes = chunks_.write_chunks(rows_of_nodes);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    std::string entry(copc_entry::kBytes, '\0');
    put_number(entry, copc_entry::kDepth, nodes[n].depth);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put_number(entry, copc_entry::kCell + 4 * axis, nodes[n].cell[axis]);
    }
    put_number(entry, copc_entry::kPlace, place);
    put_number(entry, copc_entry::kChunkBytes, static_cast<std::int32_t>(sizes[n]));
    put_number(entry, copc_entry::kPoints, static_cast<std::int32_t>(nodes[n].points));
    hierarchy_ += entry;
    place += sizes[n];
  }
  return taken;
}

std::uint64_t CopcPointWriter::finish(const BoundingBox& bounds, const Progress* progress) {
  // The corner is that of the bounds, so that level ground is not cut in its middle; a margin of
  // one step keeps points inside for any rounding by a reader.
  double step = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) step = std::max(step, std::abs(file_.scale(axis)));
  if (points() == 0) {
    hierarchy_.assign(copc_entry::kBytes, '\0');
    return chunks_.finish();
  }
  cube_.corner = bounds.min.array() - step;
  cube_.side = (bounds.max - bounds.min).maxCoeff() + 2.0 * step;
  const spatial::DetailTree tree = spatial::make_detail_tree(tree_points(progress));
  write_nodes(tree, progress);
  return chunks_.finish();
}

std::string CopcPointWriter::info(std::uint64_t place, double first_time, double last_time) const {
  std::string data(copc_info::kBytes, '\0');
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put_number(data, copc_info::kCentre + 8 * axis,
               cube_.corner[static_cast<int>(axis)] + cube_.side / 2);
  }
  put_number(data, copc_info::kHalfSide, cube_.side / 2);
  put_number(data, copc_info::kSpacing, cube_.side / kVoxelsPerSide);
  put_number(data, copc_info::kHierarchy, place);
  put_number<std::uint64_t>(data, copc_info::kHierarchyBytes, hierarchy_.size());
  put_number(data, copc_info::kFirstTime, first_time);
  put_number(data, copc_info::kLastTime, last_time);
  return data;
}

}  // namespace pcednet::io
