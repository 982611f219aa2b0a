#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "pcednet/io/e57/header.h"
#include "pcednet/io/loaded_cloud.h"

namespace pcednet::io {

/// Throws Error(kInsufficient) for a scan whose points have no coordinates.
void check_e57_fields(const InputFile& file, const E57Scan& scan);

/// Whether a field of the scan marks invalid points.
bool has_invalid_points(const E57Scan& scan);

/// The warnings about the scans, `invalid` of whose points are left out.
std::vector<std::string> e57_warnings(const std::vector<E57Scan>& scans, std::uint64_t invalid);

/// Scans appended one after the other; the attributes depend on all scans of the file.
class E57Collector {
 public:
  /// `scans` must outlive it.
  explicit E57Collector(const std::vector<E57Scan>& scans);

  std::size_t size() const { return loaded_.cloud.size(); }

  void append(const E57Pages& pages, std::size_t scan);

  /// Names of attributes that carry no information about the appended points, and need not be kept.
  std::set<std::string> silent() const;

  /// Call it once, last.
  LoadedCloud finish(const std::set<std::string>& dropped);

 private:
  const std::vector<E57Scan>& scans_;
  bool has_colours_ = false;
  bool has_normals_ = false;
  bool several_ = false;
  std::uint64_t invalid_ = 0;
  std::vector<std::int32_t> scan_ = {};
  LoadedCloud loaded_ = {};
};

}  // namespace pcednet::io
