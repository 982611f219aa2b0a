#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/attribute.h"
#include "pcednet/core/vec3.h"

namespace pcednet {

/// The classes of a point, as stored in labels and in files.
enum EdgeClass : std::uint8_t { kNonEdge = 0, kSmoothEdge = 1, kSharpEdge = 2, kUnlabelled = 255 };

using Rgb = std::array<std::uint8_t, 3>;

/// A further element of a PLY file (faces, edges, ...), carried through unread.
struct ForeignElement {
  std::string header;            ///< its "element" and "property" lines, each ended by \n
  std::vector<std::byte> bytes;  ///< its rows, binary little-endian
};

/// Points with what their file says about them.
///
/// Every per-point vector but `positions` may be empty; otherwise it has the size of `positions`.
/// Positions and normals may hold NaN or infinity: see find_defects().
struct PointCloud {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< unit length, or (0,0,0) where the file's normal was unusable
  /// The normals as their file has them, of any length: x, y and z, or nothing. Writers give them
  /// back while normals_are_stored().
  std::vector<Attribute> stored_normals;
  std::vector<Rgb> colours;
  std::vector<std::uint8_t> labels;  ///< EdgeClass values
  std::vector<Attribute> attributes;
  ScalarType position_type = ScalarType::kFloat64;  ///< what the file holds, and output gets back
  std::vector<std::string> comments;
  std::vector<ForeignElement> foreign_elements;
  std::vector<Vec3> scanners;  ///< where each scan was taken from; NaN where that is unknown

  std::size_t size() const { return positions.size(); }
  bool empty() const { return positions.empty(); }
  bool has_normals() const { return !normals.empty(); }
  bool has_labels() const { return !labels.empty(); }
};

/// The attribute of that name, or null.
const Attribute* find_attribute(const PointCloud& cloud, std::string_view name);

/// Adds `attribute`, replacing one of the same name.
void set_attribute(PointCloud& cloud, Attribute attribute);

/// Scales every normal to unit length; a normal that is zero or not finite becomes (0,0,0).
/// Returns how many of these there are.
std::size_t make_normals_unit(PointCloud& cloud);

/// The normal of `point` as the file has it; there must be some.
Vec3 stored_normal(const PointCloud& cloud, std::size_t point);

/// Whether the normals are `stored_normals` made unit, that is, nobody changed them since.
bool normals_are_stored(const PointCloud& cloud);

/// Where each point was seen from: cloud.scanners[s] for the s that the attribute `scan` names, or
/// for all points if there is one scanner and no such attribute; NaN where unknown. Empty if it is
/// known of no point.
std::vector<Vec3> scanner_of_points(const PointCloud& cloud);

/// What a cloud holds that cannot be computed with.
struct Defects {
  std::size_t positions = 0;   ///< points whose position is not finite
  std::size_t normals = 0;     ///< points whose normal is zero or not finite
  std::size_t duplicates = 0;  ///< points at exactly the position of an earlier point
};
Defects find_defects(const PointCloud& cloud);

/// Throws Error(kFailure) unless every per-point vector has the size of `positions`.
void check_consistent(const PointCloud& cloud);

}  // namespace pcednet
