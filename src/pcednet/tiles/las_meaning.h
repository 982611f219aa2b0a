#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/las/file.h"

/// The facts that decide whether the points of two LAS files can stand in one.
namespace pcednet::tiles {

/// The meaning of the numbers of an extra field (LASF_Spec 4).
struct ExtraMeaning {
  std::uint8_t type = 0;
  std::size_t components = 1;
  std::string no_data = {};                     ///< bytes; empty: every number is data
  std::vector<double> scale = {}, offset = {};  ///< of each number

  bool operator==(const ExtraMeaning&) const = default;
};

/// The meaning of each extra field that is described.
std::map<std::string, ExtraMeaning> extra_meanings(const io::LasFile& file);

/// How much a file names of a coordinate system: 0 nothing, 1 x and y, 2 heights, too.
int system_rank(const io::LasFile& file);

/// Both systems, as a phrase, where two clouds name different ones; empty if these are the same as
/// far as both are named.
std::string different_systems(const PointCloud& a, const PointCloud& b);

/// How GPS times count: from the week or adjusted, and by which offset (LAS 1.5).
struct TimeBase {
  bool is_adjusted = false, has_offset = false;
  std::uint16_t offset = 0;

  bool operator==(const TimeBase&) const = default;
};
TimeBase time_base(const io::LasFile& file);

/// Whether records describe or hold waveforms.
bool has_waveforms(const io::LasFile& file);

}  // namespace pcednet::tiles
