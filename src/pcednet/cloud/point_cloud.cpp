#include "pcednet/cloud/point_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pcednet/core/error.h"

namespace pcednet {
namespace {

/// (0,0,0) for a vector that is zero or not finite.
Vec3 unit(const Vec3& vector) {
  // The largest component first, so that neither huge nor tiny vectors overflow the square.
  const double largest = vector.cwiseAbs().maxCoeff();
  if (!vector.allFinite() || largest == 0.0) return Vec3::Zero();
  const Vec3 scaled = vector / largest;
  return scaled / scaled.norm();
}

}  // namespace

const Attribute* find_attribute(const PointCloud& cloud, std::string_view name) {
  const auto found = std::find_if(cloud.attributes.begin(), cloud.attributes.end(),
                                  [&](const Attribute& a) { return a.name == name; });
  return found == cloud.attributes.end() ? nullptr : &*found;
}

void set_attribute(PointCloud& cloud, Attribute attribute) {
  for (Attribute& existing : cloud.attributes) {
    if (existing.name == attribute.name) {
      existing = std::move(attribute);
      return;
    }
  }
  cloud.attributes.push_back(std::move(attribute));
}

void erase_attribute(PointCloud& cloud, std::string_view name) {
  std::erase_if(cloud.attributes, [&](const Attribute& a) { return a.name == name; });
}

std::size_t make_normals_unit(PointCloud& cloud) {
  std::size_t unusable = 0;
  for (Vec3& normal : cloud.normals) {
    normal = unit(normal);
    if (normal.isZero(0.0)) ++unusable;
  }
  return unusable;
}

Vec3 stored_normal(const PointCloud& cloud, std::size_t point) {
  const auto& stored = cloud.stored_normals;
  return {stored[0].value(point), stored[1].value(point), stored[2].value(point)};
}

bool normals_are_stored(const PointCloud& cloud) {
  const auto& stored = cloud.stored_normals;
  if (!cloud.has_normals() || stored.size() != 3) return false;
  for (const Attribute& axis : stored) {
    if (axis.bytes.size() != cloud.size() * size_of(axis.type)) return false;
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (unit(stored_normal(cloud, i)) != cloud.normals[i]) return false;
  }
  return true;
}

std::vector<Vec3> scanner_of_points(const PointCloud& cloud) {
  const auto& scanners = cloud.scanners;
  const auto known = [](const Vec3& place) { return place.allFinite(); };
  if (std::none_of(scanners.begin(), scanners.end(), known)) return {};
  const Attribute* scan = find_attribute(cloud, "scan");
  if (scan == nullptr && scanners.size() > 1) return {};
  std::vector<Vec3> places(cloud.size(), Vec3::Constant(NAN));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double s = scan == nullptr ? 0.0 : scan->value(i);
    if (s >= 0.0 && s < static_cast<double>(scanners.size())) {
      places[i] = scanners[static_cast<std::size_t>(s)];
    }
  }
  return std::any_of(places.begin(), places.end(), known) ? places : std::vector<Vec3>{};
}

Defects find_defects(const PointCloud& cloud) {
  Defects defects;
  std::vector<std::uint32_t> order;
  order.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.positions[i].allFinite()) {
      order.push_back(static_cast<std::uint32_t>(i));
    } else {
      ++defects.positions;
    }
  }
  for (const Vec3& normal : cloud.normals) {
    if (!is_usable(normal)) ++defects.normals;
  }
  const auto& p = cloud.positions;
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return is_before(p[a], p[b]); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (p[order[i]] == p[order[i - 1]]) ++defects.duplicates;
  }
  return defects;
}

void check_consistent(const PointCloud& cloud) {
  const auto check = [&](std::size_t size, std::string_view what) {
    if (size != 0 && size != cloud.size()) {
      throw Error(ErrorKind::kUsage, fmt::format("{} {} for {} points", size, what, cloud.size()));
    }
  };
  check(cloud.normals.size(), "normals");
  check(cloud.colours.size(), "colours");
  check(cloud.labels.size(), "labels");
  for (const Attribute& attribute : cloud.attributes) {
    const std::size_t wanted = cloud.size() * attribute.stride();
    if (attribute.bytes.size() != wanted) {
      throw Error(ErrorKind::kUsage, fmt::format("attribute {}: {} bytes instead of {}",
                                                 attribute.name, attribute.bytes.size(), wanted));
    }
  }
}

}  // namespace pcednet
