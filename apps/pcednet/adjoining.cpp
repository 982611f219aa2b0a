#include "adjoining.h"

#include <algorithm>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/formats/format.h"
#include "pcednet/io/las/facts.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

/// A file, and the square of the plane of x and y that its points take.
struct Footprint {
  fs::path file;
  BoundingBox box;

  double side() const { return std::max(along(0), along(1)); }
  double along(int axis) const { return box.max[axis] - box.min[axis]; }
};

std::vector<Footprint> footprints(std::span<const fs::path> files) {
  std::vector<Footprint> found;
  for (const fs::path& path : files) {
    const formats::Format* format = formats::find_format(path);
    std::error_code error;
    if (!format || !format->is_las() || !fs::is_regular_file(path, error)) continue;
    try {
      const io::LasOutline las = io::las_outline(io::InputFile(path));
      if (las.points > 0) found.push_back({path, las.bounds});
    } catch (const Error&) {
      continue;  // told where it is read
    }
  }
  return found;
}

/// The length that both have in common along an axis; below 0: the gap between them.
double overlap(const Footprint& a, const Footprint& b, int axis) {
  return std::min(a.box.max[axis], b.box.max[axis]) - std::max(a.box.min[axis], b.box.min[axis]);
}

bool adjoin(const Footprint& a, const Footprint& b) {
  // A gap is that between points. Files that overlap more are of the same place.
  constexpr double kGap = 0.01, kMostOverlap = 0.25, kLeastEdge = 0.1;
  const double side = std::min(a.side(), b.side());
  for (const int across : {0, 1}) {
    const double common = overlap(a, b, across), edge = overlap(a, b, 1 - across);
    const double most = std::min(a.along(1 - across), b.along(1 - across));
    if (common >= -kGap * side && common <= kMostOverlap * side && edge > kLeastEdge * most) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::optional<std::pair<fs::path, fs::path>> find_adjoining(std::span<const fs::path> files) {
  if (files.size() < 2) return std::nullopt;
  std::vector<Footprint> all = footprints(files);
  // Only files that begin before another ends along x can touch it.
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b) { return a.box.min.x() < b.box.min.x(); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double end = all[i].box.max.x() + all[i].side();
    for (std::size_t k = i + 1; k < all.size() && all[k].box.min.x() <= end; ++k) {
      if (adjoin(all[i], all[k])) return std::pair(all[i].file, all[k].file);
    }
  }
  return std::nullopt;
}

}  // namespace pcednet::app
