#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "pcednet/io/las/file.h"
#include "pcednet/io/parts.h"

namespace pcednet::io {

/// Which attributes of a cloud that is not as LAS holds it fill standard fields: texts have every
/// number as double, E57 calls Intensity `intensity`.
struct LasSources {
  /// By field: the attribute of another type, or other capitals, all of whose values it holds.
  std::map<std::string, std::string> attributes = {};
  /// Fields that cannot hold the attribute of their name and type, which becomes extra bytes.
  std::set<std::string> unfit = {};
  std::vector<std::string> losses = {};  ///< the attributes that do not fit, and why
};

/// Fields whose name and type an attribute has take it without a source, unless the file `is_new`
/// and their bits are too few.
LasSources find_las_sources(const LasFile& file, bool is_new, const PartOutline& outline);

/// The attribute for a field; null if there is none.
const Attribute* las_source(const PointCloud& cloud, const LasSources& sources,
                            const std::string& field, ScalarType type);

/// The attributes for Red, Green and Blue; all null unless all are there.
std::array<const Attribute*, 3> las_channels(const PointCloud& cloud, const LasSources& sources);

/// Whether there are attributes that las_channels() may be, if all their values fit.
bool may_have_channels(const PointCloud& first);

/// Whether the colours say anything that Red, Green and Blue do not: these must round to the
/// colours, or have them as their high bytes.
bool colours_are_new(const PartOutline& outline, const LasSources& sources);

}  // namespace pcednet::io
