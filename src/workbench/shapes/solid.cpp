#include "workbench/shapes/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcednet::shapes {
namespace {

Vec2 profile_place(const Volume& volume, const Vec3& local) {
  if (volume.kind == Volume::Kind::kRevolution) {
    return {std::hypot(local.x(), local.y()), local.z()};
  }
  return {local.x(), local.y()};
}

/// The surface between side and cap, both given by their distances.
double rim_distance(const Volume& volume, double side, double cap) {
  const double size = volume.rim_size;
  if (volume.rim == Corner::Shape::kFillet) return std::hypot(side + size, cap + size) - size;
  return (side + cap + size) / std::sqrt(2.0);
}

/// The value for a single volume.
Solid::Value value_of(const Volume& volume, const Vec3& local) {
  std::size_t nearest = 0;
  const double side = volume.profile.distance(profile_place(volume, local), nearest);
  Face face;
  face.side = static_cast<std::uint16_t>(nearest);
  if (volume.kind == Volume::Kind::kRevolution) return {side, face};
  const bool top = local.z() > 0.0;
  const double cap = std::abs(local.z()) - volume.half_height;
  const bool in_rim = volume.rim == Corner::Shape::kFillet
                          ? side + volume.rim_size > 0.0 && cap + volume.rim_size > 0.0
                          : volume.rim == Corner::Shape::kChamfer &&
                                rim_distance(volume, side, cap) > std::max(side, cap);
  if (in_rim) {
    face.part = top ? Face::Part::kTopRim : Face::Part::kBottomRim;
    return {rim_distance(volume, side, cap), face};
  }
  if (side >= cap) return {side, face};
  return {cap, {0, 0, top ? Face::Part::kTop : Face::Part::kBottom}};
}

/// The box of a volume placed by its frame.
BoundingBox box_of(const Volume& volume) {
  const Vec2 low = volume.profile.low(), high = volume.profile.high();
  const bool turned = volume.kind == Volume::Kind::kRevolution;
  BoundingBox box;
  for (int corner = 0; corner < 8; ++corner) {
    const bool x = corner & 1, y = corner & 2, z = corner & 4;
    const Vec3 local =
        turned ? Vec3(x ? high.x() : -high.x(), y ? high.x() : -high.x(), z ? high.y() : low.y())
               : Vec3(x ? high.x() : low.x(), y ? high.y() : low.y(),
                      z ? volume.half_height : -volume.half_height);
    box.add(Vec3(volume.frame * local));
  }
  return box;
}

}  // namespace

Solid::Value Solid::value(const Vec3& p) const {
  Value result = {std::numeric_limits<double>::infinity(), {}};
  for (std::size_t i = 0; i < volumes_.size(); ++i) {
    const Feature& feature = volumes_[i];
    const double away = (p - feature.centre).norm() - feature.reach;  // at most
    if (feature.filled ? away >= result.distance : -away <= result.distance) continue;
    Value value = value_of(feature.volume, feature.to_local * p);
    value.face.volume = static_cast<std::uint32_t>(i);
    if (!feature.filled) value.distance = -value.distance;
    if (feature.filled ? value.distance < result.distance : value.distance > result.distance) {
      result = value;
    }
  }
  return result;
}

double Solid::distance_to(const Face& face, const Vec3& p) const {
  const auto& [volume, to_local, centre, reach, filled] = volumes_[face.volume];
  const Vec3 local = to_local * p;
  const double cap = (face.part == Face::Part::kTop || face.part == Face::Part::kTopRim)
                         ? local.z() - volume.half_height
                         : -local.z() - volume.half_height;
  const double side = volume.profile.distance_to(face.side, profile_place(volume, local));
  double distance = side;
  if (face.part == Face::Part::kTop || face.part == Face::Part::kBottom) distance = cap;
  if (face.part == Face::Part::kTopRim || face.part == Face::Part::kBottomRim) {
    distance = rim_distance(volume, side, cap);
  }
  return filled ? distance : -distance;
}

Vec3 Solid::normal_of(const Face& face, const Vec3& p) const {
  constexpr double kStep = 1e-6;  // solids are about one unit large
  Vec3 gradient;
  for (int a = 0; a < 3; ++a) {
    Vec3 offset = Vec3::Zero();
    offset[a] = kStep;
    gradient[a] = distance_to(face, p + offset) - distance_to(face, p - offset);
  }
  return gradient.normalized();
}

bool Solid::is_curved(const Face& face) const {
  const Volume& volume = volumes_[face.volume].volume;
  if (face.part == Face::Part::kTop || face.part == Face::Part::kBottom) return false;
  if (volume.profile.is_round(face.side)) return true;
  if (volume.kind == Volume::Kind::kRevolution) return !volume.profile.is_level(face.side);
  return face.part != Face::Part::kSide && volume.rim == Corner::Shape::kFillet;
}

void Solid::put(Volume volume, bool filled) {
  const BoundingBox box = box_of(volume);
  if (filled) box_.add(box);
  const Eigen::Isometry3d to_local = volume.frame.inverse();
  volumes_.push_back({std::move(volume), to_local, box.centre(), 0.5 * box.diagonal(), filled});
}

}  // namespace pcednet::shapes
