#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/parts.h"

namespace CLI {
class App;
}

namespace pcednet::app {

/// The points to keep, by fields that LAS has.
struct PointFilter {
  std::vector<std::uint8_t> kept = {};     ///< codes of the field Classification; none: all
  std::vector<std::uint8_t> dropped = {};  ///< codes whose points are left out
  std::vector<std::string> flags = {};     ///< fields whose set points are left out

  bool is_on() const { return !kept.empty() || !dropped.empty() || !flags.empty(); }
};

/// Adds --keep-class, --drop-class and --drop-flag.
void add_filter_options(CLI::App& command, PointFilter& filter);

/// The points that are kept, with what shapes::select() keeps. Throws Error(kInsufficient) if
/// `cloud` lacks a field of the filter.
PointCloud filtered(PointCloud cloud, const PointFilter& filter);

/// The parts of a file that have points to keep, in order. As with io::PartReader, comments,
/// foreign elements and scanners come with the first.
class FilteredParts {
 public:
  /// `reader` must outlive it. Reads all parts if the filter is on. Throws Error(kInsufficient) as
  /// filtered(), and if no point is kept.
  FilteredParts(const io::PartReader& reader, const PointFilter& filter, const Progress& progress);

  std::size_t points() const { return points_; }
  std::size_t parts() const { return parts_.size(); }
  PointCloud read(std::size_t part) const;

 private:
  const io::PartReader& reader_;
  PointFilter filter_;
  std::vector<std::size_t> parts_ = {};
  std::size_t points_ = 0;
};

/// Throws Error(kInsufficient) for a filter that keeps no point.
void check_some_kept(std::size_t points, const PointFilter& filter);

}  // namespace pcednet::app
