#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "pcednet/io/coordinate_system.h"
#include "pcednet/io/e57/e57.h"
#include "pcednet/io/e57/points.h"
#include "pcednet/io/scanners.h"

namespace pcednet::io {
namespace {

using Names = std::array<const char*, 3>;
constexpr Names kCartesian = {"cartesianX", "cartesianY", "cartesianZ"};
constexpr Names kSpherical = {"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
constexpr Names kColours = {"colorRed", "colorGreen", "colorBlue"};
constexpr Names kNormals = {"normalX", "normalY", "normalZ"};
constexpr std::array kStates = {"cartesianInvalidState", "sphericalInvalidState"};

bool has_all(const E57Scan& scan, const Names& names) {
  return std::all_of(names.begin(), names.end(),
                     [&](const char* name) { return find_field(scan, name) != nullptr; });
}

/// The content of one scan, one attribute per field.
struct ScanPoints {
  const E57Scan& scan;
  std::vector<Attribute> fields;
  std::vector<std::size_t> valid;  ///< points to keep

  const Attribute* find(std::string_view name) const {
    const E57Field* field = find_field(scan, name);
    return field == nullptr ? nullptr : &fields[static_cast<std::size_t>(field - &scan.fields[0])];
  }

  /// The vectors that three fields hold, of the valid points; the caller has checked has_all().
  std::vector<Vec3> vectors(const Names& names) const {
    std::vector<Vec3> vectors(valid.size());
    for (int axis = 0; axis < 3; ++axis) {
      const Attribute& field = *find(names[static_cast<std::size_t>(axis)]);
      for (std::size_t i = 0; i < valid.size(); ++i) vectors[i][axis] = field.value(valid[i]);
    }
    return vectors;
  }
};

ScanPoints read_points(const E57Pages& pages, const E57Scan& scan) {
  ScanPoints points{scan, read_e57_points(pages, scan), {}};
  const bool cartesian = has_all(scan, kCartesian);
  const Attribute* state = points.find(kStates[cartesian ? 0 : 1]);
  for (std::size_t i = 0; i < scan.points; ++i) {
    if (state == nullptr || state->value(i) == 0.0) points.valid.push_back(i);
  }
  return points;
}

std::vector<Vec3> positions_of(const ScanPoints& points) {
  const E57Scan& scan = points.scan;
  const bool cartesian = has_all(scan, kCartesian);
  std::vector<Vec3> positions = points.vectors(cartesian ? kCartesian : kSpherical);
  const Mat3 rotation = scan.rotation.toRotationMatrix();
  for (Vec3& p : positions) {
    if (!cartesian) {
      const double range = p[0], azimuth = p[1], elevation = p[2];
      const double flat = range * std::cos(elevation);
      p = {flat * std::cos(azimuth), flat * std::sin(azimuth), range * std::sin(elevation)};
    }
    // Without a pose the file's own bits are kept.
    if (scan.moves()) p = rotation * p + scan.translation;
  }
  return positions;
}

/// The values that become 0 and 255: the scan's colour limits, or the range of the field.
E57Limits colour_limits(const E57Scan& scan, std::size_t channel) {
  const auto& given = scan.colour_limits[channel];
  if (given && given->lower < given->upper) return *given;
  const E57Field& field = *find_field(scan, kColours[channel]);
  if (!field.is_integer()) return {field.lower.value_or(0.0), field.upper.value_or(1.0)};
  return {static_cast<double>(field.least) * field.scale + field.offset,
          static_cast<double>(field.largest) * field.scale + field.offset};
}

/// Whether some scan's colours have another range than 0 ... 255.
bool any_colours_scaled(const std::vector<E57Scan>& scans) {
  const auto is_scaled = [](const E57Scan& scan) {
    if (!has_all(scan, kColours)) return false;
    for (std::size_t c = 0; c < 3; ++c) {
      const E57Limits limits = colour_limits(scan, c);
      if (limits.lower != 0.0 || limits.upper != 255.0) return true;
    }
    return false;
  };
  return std::any_of(scans.begin(), scans.end(), is_scaled);
}

void append_colours(const ScanPoints& points, std::vector<Rgb>& colours) {
  const std::size_t begin = colours.size();
  colours.resize(begin + points.valid.size());
  if (!has_all(points.scan, kColours)) return;
  for (std::size_t c = 0; c < 3; ++c) {
    const E57Limits limits = colour_limits(points.scan, c);
    const Attribute& field = *points.find(kColours[c]);
    for (std::size_t i = 0; i < points.valid.size(); ++i) {
      const double part =
          (field.value(points.valid[i]) - limits.lower) / (limits.upper - limits.lower);
      // A NaN fails both comparisons and becomes 0.
      const double channel = part > 0.0 ? std::round(255.0 * std::min(part, 1.0)) : 0.0;
      colours[begin + i][c] = static_cast<std::uint8_t>(channel);
    }
  }
}

void append_normals(const ScanPoints& points, std::vector<Vec3>& normals) {
  if (!has_all(points.scan, kNormals)) {
    normals.resize(normals.size() + points.valid.size(), Vec3::Zero());
    return;
  }
  for (const Vec3& normal : points.vectors(kNormals)) {
    normals.emplace_back(points.scan.moves() ? points.scan.rotation * normal : normal);
  }
}

bool is_attribute(const E57Field& field) {
  const auto is_one_of = [&](const auto& names) {
    return std::find(names.begin(), names.end(), local_name(field.name)) != names.end();
  };
  return field.is_number() && !is_one_of(kCartesian) && !is_one_of(kSpherical) &&
         !is_one_of(kColours) && !is_one_of(kNormals) && !is_one_of(kStates);
}

/// A type for the numbers of both.
ScalarType common_type(ScalarType a, ScalarType b) {
  if (a == b) return a;
  const bool small_integers = a < ScalarType::kInt32 && b < ScalarType::kInt32;
  return small_integers ? ScalarType::kInt32 : ScalarType::kFloat64;
}

/// The attributes of the whole cloud, without numbers yet.
std::vector<Attribute> plan_attributes(const std::vector<E57Scan>& scans) {
  std::vector<Attribute> plan;
  for (const E57Scan& scan : scans) {
    for (const E57Field& field : scan.fields) {
      if (!is_attribute(field)) continue;
      const auto same = [&](const Attribute& a) { return a.name == field.name; };
      const auto known = std::find_if(plan.begin(), plan.end(), same);
      if (known == plan.end()) {
        plan.push_back({field.name, field.type(), 1, {}});
      } else {
        known->type = common_type(known->type, field.type());
      }
    }
  }
  for (Attribute& attribute : plan) {
    const auto lacks = [&](const E57Scan& scan) {
      return std::none_of(scan.fields.begin(), scan.fields.end(), [&](const E57Field& f) {
        return f.is_number() && f.name == attribute.name;
      });
    };
    // Only a float can express a missing number.
    if (!is_floating(attribute.type) && std::any_of(scans.begin(), scans.end(), lacks)) {
      attribute.type = ScalarType::kFloat64;
    }
  }
  return plan;
}

void append_attribute(const ScanPoints& points, Attribute& attribute) {
  const auto& fields = points.fields;
  // Strings were left empty: they count as absent.
  const auto field = std::find_if(fields.begin(), fields.end(), [&](const Attribute& f) {
    return !f.bytes.empty() && f.name == attribute.name;
  });
  const std::size_t begin = attribute.bytes.size(), stride = attribute.stride();
  attribute.bytes.resize(begin + points.valid.size() * stride);
  std::byte* out = attribute.bytes.data() + begin;
  if (field != fields.end() && field->type == attribute.type) {
    for (const std::size_t i : points.valid) {
      std::memcpy(out, field->bytes.data() + i * stride, stride);
      out += stride;
    }
    return;
  }
  visit_scalar(attribute.type, [&](auto number) {
    for (const std::size_t i : points.valid) {
      number = static_cast<decltype(number)>(field == fields.end() ? NAN : field->value(i));
      std::memcpy(out, &number, sizeof number);
      out += sizeof number;
    }
  });
}

/// Flags such as isColorInvalid are kept only where they are raised.
bool says_nothing(const Attribute& attribute) {
  const std::string_view name = attribute.name;
  return name.starts_with("is") && name.ends_with("Invalid") &&
         std::all_of(attribute.bytes.begin(), attribute.bytes.end(),
                     [](std::byte b) { return b == std::byte{0}; });
}

bool is_single(const E57Scan& scan) {
  return !scan.moves() && has_all(scan, kCartesian) &&
         std::all_of(kCartesian.begin(), kCartesian.end(), [&](const char* name) {
           return find_field(scan, name)->kind == E57Field::Kind::kSingle;
         });
}

/// Throws Error(kInsufficient) for a scan whose points have no coordinates.
void check_e57_fields(const InputFile& file, const E57Scan& scan) {
  if (has_all(scan, kCartesian) || has_all(scan, kSpherical)) return;
  std::vector<std::string> names;
  for (const E57Field& field : scan.fields) names.push_back(field.name);
  throw Error(
      ErrorKind::kInsufficient,
      fmt::format("{}: scan {:.60}: points need x, y and z; there is {}", file.path().string(),
                  scan.name, names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, " "))));
}

/// Whether a field of the scan marks invalid points.
bool has_invalid_points(const E57Scan& scan) {
  return std::any_of(kStates.begin(), kStates.end(),
                     [&](const char* state) { return find_field(scan, state) != nullptr; });
}

/// The warnings about the scans, `invalid` of whose points are left out.
std::vector<std::string> e57_warnings(const std::vector<E57Scan>& scans, std::uint64_t invalid) {
  std::vector<std::string> warnings;
  if (invalid > 0) {
    warnings.push_back(fmt::format("{} points are marked invalid: left out", invalid));
  }
  if (any_colours_scaled(scans)) warnings.emplace_back("colours scaled to 8 bits");
  return warnings;
}

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

E57Collector::E57Collector(const std::vector<E57Scan>& scans) : scans_(scans) {
  const auto any = [&](const Names& names) {
    return std::any_of(scans.begin(), scans.end(),
                       [&](const E57Scan& scan) { return has_all(scan, names); });
  };
  has_colours_ = any(kColours);
  has_normals_ = any(kNormals);
  several_ = scans.size() > 1;
  loaded_.cloud.attributes = plan_attributes(scans);
  const bool single = !scans.empty() && std::all_of(scans.begin(), scans.end(), is_single);
  loaded_.cloud.position_type = single ? ScalarType::kFloat32 : ScalarType::kFloat64;
}

void E57Collector::append(const E57Pages& pages, std::size_t index) {
  const ScanPoints points = read_points(pages, scans_[index]);
  PointCloud& cloud = loaded_.cloud;
  const std::vector<Vec3> positions = positions_of(points);
  cloud.positions.insert(cloud.positions.end(), positions.begin(), positions.end());
  if (has_colours_) append_colours(points, cloud.colours);
  if (has_normals_) append_normals(points, cloud.normals);
  for (Attribute& attribute : cloud.attributes) append_attribute(points, attribute);
  if (several_) scan_.resize(cloud.size(), static_cast<std::int32_t>(index));
  invalid_ += points.scan.points - points.valid.size();
}

std::set<std::string> E57Collector::silent() const {
  std::set<std::string> names;
  for (const Attribute& attribute : loaded_.cloud.attributes) {
    if (says_nothing(attribute)) names.insert(attribute.name);
  }
  return names;
}

LoadedCloud E57Collector::finish(const std::set<std::string>& dropped) {
  std::erase_if(loaded_.cloud.attributes,
                [&](const Attribute& a) { return dropped.count(a.name) != 0; });
  if (several_) set_attribute(loaded_.cloud, make_attribute("scan", scan_));
  loaded_.warnings = e57_warnings(scans_, invalid_);
  return std::move(loaded_);
}

void describe_scans(const E57Document& document, PointCloud& cloud) {
  if (!document.coordinate_system.empty()) {
    cloud.comments.push_back(std::string(kSystemComment) + document.coordinate_system);
  }
  for (std::size_t s = 0; s < document.scans.size(); ++s) {
    const E57Scan& scan = document.scans[s];
    const std::string by = scan.sensor.empty() ? "" : ", " + scan.sensor;
    cloud.comments.push_back(fmt::format("scan {}: {}{}", s, scan.name, by));
    add_scanner(scan.knows_scanner() ? scan.translation : Vec3::Constant(NAN), cloud);
  }
}

/// A part is a scan; those without points are passed over.
class E57PartReader : public PartReader {
 public:
  explicit E57PartReader(std::unique_ptr<InputFile> file)
      : file_(std::move(file)), pages_(*file_), document_(read_e57_document(pages_)) {
    const auto& scans = document_.scans;
    check_e57_sizes(pages_, scans);
    for (const E57Scan& scan : scans) check_e57_fields(*file_, scan);
    silent_ = E57Collector(scans).silent();
    const bool any_state = std::any_of(scans.begin(), scans.end(), has_invalid_points);
    const bool must_look = any_state || !silent_.empty();
    std::uint64_t promised = 0;
    for (std::size_t s = 0; s < scans.size(); ++s) {
      promised += scans[s].points;
      std::size_t valid = scans[s].points;
      if (must_look && valid > 0) {
        const E57Collector looked = collect(s);
        const std::set<std::string> silent = looked.silent();
        std::erase_if(silent_, [&](const auto& name) { return silent.count(name) == 0; });
        valid = looked.size();
      }
      if (valid > 0) with_points_.push_back(s);
      points_ += valid;
    }
    warnings = e57_warnings(scans, promised - points_);
  }

  std::size_t points() const override { return points_; }
  std::size_t parts() const override { return with_points_.size(); }

  PointCloud read(std::size_t part) const override {
    PointCloud cloud = collect(with_points_[part]).finish(silent_).cloud;
    if (part == 0) describe_scans(document_, cloud);
    return cloud;
  }

 private:
  E57Collector collect(std::size_t scan) const {
    E57Collector collector(document_.scans);
    collector.append(pages_, scan);
    return collector;
  }

  std::unique_ptr<InputFile> file_;
  E57Pages pages_;
  E57Document document_;
  std::set<std::string> silent_ = {};  ///< attributes that say nothing of any point
  std::vector<std::size_t> with_points_ = {};
  std::size_t points_ = 0;
};

}  // namespace

LoadedCloud read_e57(const InputFile& file) {
  const E57Pages pages(file);
  const E57Document document = read_e57_document(pages);
  check_e57_sizes(pages, document.scans);
  E57Collector collector(document.scans);
  for (std::size_t s = 0; s < document.scans.size(); ++s) {
    check_e57_fields(file, document.scans[s]);
    collector.append(pages, s);
  }
  LoadedCloud loaded = collector.finish(collector.silent());
  describe_scans(document, loaded.cloud);
  return loaded;
}

std::unique_ptr<PartReader> open_e57_parts(std::unique_ptr<InputFile> file) {
  return std::make_unique<E57PartReader>(std::move(file));
}

}  // namespace pcednet::io
