#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/cloud/attribute.h"
#include "pcednet/core/vec3.h"
#include "pcednet/io/e57/pages.h"

namespace pcednet::io {

/// One field of the points of a scan, from the prototype in the XML.
struct E57Field {
  enum class Kind { kInteger, kScaledInteger, kSingle, kDouble, kString };
  std::string name;
  Kind kind = Kind::kDouble;
  std::int64_t least = std::numeric_limits<std::int64_t>::min();  ///< of integers, before scaling
  std::int64_t largest = std::numeric_limits<std::int64_t>::max();
  double scale = 1.0;  ///< value = integer * scale + offset
  double offset = 0.0;
  std::optional<double> lower = {};  ///< of floats, if the file states them
  std::optional<double> upper = {};

  bool is_number() const { return kind != Kind::kString; }
  bool is_integer() const { return kind == Kind::kInteger || kind == Kind::kScaledInteger; }
  unsigned bits() const;    ///< per point in the file: 0 if every value is `least`, and for strings
  ScalarType type() const;  ///< the narrowest that holds the values
};

/// The least and the largest possible value of a colour or of the intensity.
struct E57Limits {
  double lower = 0.0;
  double upper = 0.0;
};

/// One scan (a child of data3D), without its points.
struct E57Scan {
  std::string name;
  std::string guid;
  std::string sensor;  ///< vendor, model, serial number; may be empty
  std::uint64_t points = 0;
  std::uint64_t points_offset = 0;  ///< physical, of the section with the points
  std::vector<E57Field> fields;     ///< in the order of their bytestreams
  bool has_pose = false;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit
  Vec3 translation = Vec3::Zero();                      ///< world = rotation * point + translation
  std::vector<std::optional<E57Limits>> colour_limits;  ///< red, green, blue

  bool moves() const;  ///< whether the pose is not the identity
  /// Whether the scanner stood at the origin of the scan: the points are spherical, or lie in rows
  /// and columns, or the pose moves them. Merged clouds have none of these.
  bool knows_scanner() const;
};

/// The XML part.
struct E57Document {
  std::vector<E57Scan> scans;
  std::string coordinate_system;  ///< coordinateMetadata, in one line; may be empty
};

/// Throws Error(kUnreadable) where the XML is damaged or contradicts itself.
E57Document read_e57_document(const E57Pages& pages);

/// The field of that name (without an extension's prefix) if it holds numbers, or null.
const E57Field* find_field(const E57Scan& scan, std::string_view name);

/// The name without the prefix of an extension.
std::string_view local_name(std::string_view name);

}  // namespace pcednet::io
