#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/attribute.h"
#include "pcednet/core/vec3.h"

namespace pcednet {

/// The classes of a point, as stored in labels and in files. No network predicts kBoundary, the end
/// of a surface: geometry alone finds it.
enum EdgeClass : std::uint8_t {
  kNonEdge = 0,
  kSmoothEdge = 1,
  kSharpEdge = 2,
  kBoundary = 3,
  kUnlabelled = 255
};

using Rgb = std::array<std::uint8_t, 3>;

/// Another element of a PLY file (faces, edges, ...), kept unparsed.
struct ForeignElement {
  std::string header;            ///< its "element" and "property" lines, each ended by \n
  std::vector<std::byte> bytes;  ///< its rows, binary little-endian
};

/// The points of a file with all their fields.
///
/// Every per-point vector but `positions` may be empty; otherwise it has the size of `positions`.
/// Positions may hold NaN or infinity, and so may normals that no reader made: see find_defects().
struct PointCloud {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< unit length; where the file's is unusable, readers give (0,0,0)
  /// The normals as in the file, of any length: x, y and z, or empty. Writers use them while
  /// normals_are_stored().
  std::vector<Attribute> stored_normals;
  std::vector<Rgb> colours;
  std::vector<std::uint8_t> labels;  ///< EdgeClass values
  std::vector<Attribute> attributes;
  ScalarType position_type = ScalarType::kFloat64;  ///< in the file, and in the output
  std::vector<std::string> comments;
  std::vector<ForeignElement> foreign_elements;
  std::vector<Vec3> scanners;  ///< the position of each scan's scanner; NaN where unknown

  std::size_t size() const { return positions.size(); }
  bool empty() const { return positions.empty(); }
  bool has_normals() const { return !normals.empty(); }
  bool has_labels() const { return !labels.empty(); }
};

/// The attribute of that name, or null.
const Attribute* find_attribute(const PointCloud& cloud, std::string_view name);

/// Adds `attribute`, replacing one of the same name.
void set_attribute(PointCloud& cloud, Attribute attribute);

/// Removes the attribute of that name, if there is one.
void erase_attribute(PointCloud& cloud, std::string_view name);

/// Whether a normal is finite and has a direction.
inline bool is_usable(const Vec3& normal) {
  return normal.allFinite() && !normal.isZero(0.0);
}

/// Scales every normal to unit length; a normal that is zero or not finite becomes (0,0,0).
/// Returns the number of these.
std::size_t make_normals_unit(PointCloud& cloud);

/// The normal of `point` as in the file, which must have normals.
Vec3 stored_normal(const PointCloud& cloud, std::size_t point);

/// Whether the normals are still the normalised `stored_normals`, that is, unchanged.
bool normals_are_stored(const PointCloud& cloud);

/// The scanner position of each point: cloud.scanners[s] with s from the attribute `scan`, or the
/// only scanner if there is one and no such attribute; NaN where unknown. Empty if unknown for all
/// points.
std::vector<Vec3> scanner_of_points(const PointCloud& cloud);

/// Values of a cloud that cannot be used in computations.
struct Defects {
  std::size_t positions = 0;   ///< points whose position is not finite
  std::size_t normals = 0;     ///< points whose normal is zero or not finite
  std::size_t duplicates = 0;  ///< points at exactly the position of an earlier point
};
Defects find_defects(const PointCloud& cloud);

/// Throws Error(kUsage) unless every per-point vector has the size of `positions`.
void check_consistent(const PointCloud& cloud);

}  // namespace pcednet
