#include "pcednet/cloud/point_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pcednet/core/error.h"

namespace pcednet {
namespace {

bool lexicographically_less(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
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

std::size_t make_normals_unit(PointCloud& cloud) {
  std::size_t unusable = 0;
  for (Vec3& normal : cloud.normals) {
    // The largest component first, so that neither huge nor tiny normals overflow the square.
    const double largest = normal.cwiseAbs().maxCoeff();
    if (!normal.allFinite() || largest == 0.0) {
      normal.setZero();
      ++unusable;
    } else {
      normal /= largest;
      normal /= normal.norm();
    }
  }
  return unusable;
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
    if (!normal.allFinite() || normal.isZero(0.0)) ++defects.normals;
  }
  const auto& p = cloud.positions;
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return lexicographically_less(p[a], p[b]); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (p[order[i]] == p[order[i - 1]]) ++defects.duplicates;
  }
  return defects;
}

void check_consistent(const PointCloud& cloud) {
  const auto check = [&](std::size_t size, std::string_view what) {
    if (size != 0 && size != cloud.size()) {
      throw Error(ErrorKind::kFailure,
                  fmt::format("{} {} for {} points", size, what, cloud.size()));
    }
  };
  check(cloud.normals.size(), "normals");
  check(cloud.colours.size(), "colours");
  check(cloud.labels.size(), "labels");
  for (const Attribute& attribute : cloud.attributes) {
    const std::size_t wanted = cloud.size() * attribute.stride();
    if (attribute.bytes.size() != wanted) {
      throw Error(ErrorKind::kFailure, fmt::format("attribute {}: {} bytes instead of {}",
                                                   attribute.name, attribute.bytes.size(), wanted));
    }
  }
}

}  // namespace pcednet
