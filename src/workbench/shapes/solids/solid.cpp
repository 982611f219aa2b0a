#include "workbench/shapes/solids/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcednet::shapes {
namespace {

using Side = Profile::Side;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// To the right of the chord, where the bulge of a convex arc is.
bool beyond_chord(const Side& side, const Vec2& p) {
  return cross(side.b - side.a, p - side.a) < 0.0;
}

bool in_bulge(const Side& side, const Vec2& p) {
  if ((p - side.centre).squaredNorm() > side.radius * side.radius) return false;
  return beyond_chord(side, p) == side.convex;
}

double sq_distance(const Side& side, const Vec2& p) {
  if (side.radius > 0.0) {
    const Vec2 offset = p - side.centre;
    const double away = offset.norm();
    const Vec2 on = side.centre + (away > 0.0 ? side.radius / away : 0.0) * offset;
    if (away > 0.0 && beyond_chord(side, on) == side.convex) return (p - on).squaredNorm();
    return std::min((p - side.a).squaredNorm(), (p - side.b).squaredNorm());
  }
  const Vec2 along = side.b - side.a;
  const double t = std::clamp((p - side.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - side.a - t * along).squaredNorm();
}

/// The distance that is too far to be nearer than a squared distance, or as near.
double beyond(double sq) {
  return std::sqrt(1.000001 * sq + 1e-20);
}

Side arc(const Vec2& a, const Vec2& b, const Vec2& centre, bool convex) {
  return {a, b, (a - centre).norm(), centre, convex};
}

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

Profile::Profile(std::vector<Side> sides) : sides_(std::move(sides)) {
  constexpr std::size_t kInRun = 6;
  constexpr double kRounding = 1e-9;
  for (std::size_t begin = 0; begin < sides_.size(); begin += kInRun) {
    const std::size_t end = std::min(begin + kInRun, sides_.size());
    Vec2 middle = Vec2::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      middle += (sides_[i].a + sides_[i].b) / (2.0 * static_cast<double>(end - begin));
    }
    double reach = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec2 half_chord = 0.5 * (sides_[i].b - sides_[i].a);  // an arc stays in its disc
      reach = std::max(reach, (sides_[i].a + half_chord - middle).norm() + half_chord.norm());
    }
    runs_.push_back({begin, end, middle, (1.0 + kRounding) * reach + kRounding});
  }
}

double Profile::distance_to(std::size_t i, const Vec2& p) const {
  const Side& side = sides_[i];
  if (side.radius > 0.0) {
    const double away = (p - side.centre).norm() - side.radius;
    return side.convex ? away : -away;
  }
  return -cross((side.b - side.a).normalized(), p - side.a);
}

/// The squared distance to the sides of the run whose disc is nearest, if there are others.
double Profile::sq_distance_to_nearest_run(const Vec2& p) const {
  double away = std::numeric_limits<double>::infinity(), least = away;
  if (runs_.size() < 2) return least;
  const Run* nearest = nullptr;
  for (const Run& run : runs_) {
    const double to_disc = run.distance_to_disc(p);
    if (to_disc < away) away = to_disc, nearest = &run;
  }
  for (std::size_t i = nearest->begin; i < nearest->end; ++i) {
    least = std::min(least, sq_distance(sides_[i], p));
  }
  return least;
}

double Profile::distance(const Vec2& p, std::size_t& nearest) const {
  double least = std::numeric_limits<double>::infinity();
  const double far = beyond(sq_distance_to_nearest_run(p));
  for (const Run& run : runs_) {
    if (run.distance_to_disc(p) > far) continue;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const double sq = sq_distance(sides_[i], p);
      // Where two sides meet, the one that is farther as a whole is the one seen from here.
      const bool tie = std::abs(sq - least) <= 1e-12 * (sq + 1e-12);
      if (tie ? std::abs(distance_to(i, p)) > std::abs(distance_to(nearest, p)) : sq < least) {
        least = sq;
        nearest = i;
      }
    }
  }
  return contains(p) ? -std::sqrt(least) : std::sqrt(least);
}

/// Inside the polygon of chords, but for the bulges.
bool Profile::contains(const Vec2& p) const {
  bool odd = false;
  for (const Run& run : runs_) {
    const Vec2 offset = p - run.middle;
    if (offset.x() > run.reach || std::abs(offset.y()) > run.reach) continue;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const Side& side = sides_[i];
      const Vec2 &a = side.a, &b = side.b;
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) {
        odd = !odd;
      }
      if (side.radius > 0.0 && in_bulge(side, p)) odd = !odd;
    }
  }
  return odd;
}

Vec2 Profile::low() const {
  Vec2 low = sides_.front().a;
  for (const Side& side : sides_) {
    low = low.cwiseMin(side.a);
    if (side.radius > 0.0) low = low.cwiseMin(side.centre - Vec2::Constant(side.radius));
  }
  return low;
}

Vec2 Profile::high() const {
  Vec2 high = sides_.front().a;
  for (const Side& side : sides_) {
    high = high.cwiseMax(side.a);
    if (side.radius > 0.0) high = high.cwiseMax(side.centre + Vec2::Constant(side.radius));
  }
  return high;
}

Profile outline(const std::vector<Corner>& corners) {
  std::vector<Side> sides;
  const std::size_t n = corners.size();
  std::vector<Vec2> starts(n), ends(n);  // where the sides leave and reach each corner
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 &before = corners[(i + n - 1) % n].at, &at = corners[i].at,
               &after = corners[(i + 1) % n].at;
    const Vec2 in = (before - at).normalized(), out = (after - at).normalized();
    double cut = 0.0;  // of each side
    if (corners[i].shape != Corner::Shape::kSharp) {
      const double half_angle = 0.5 * std::acos(std::clamp(in.dot(out), -1.0, 1.0));
      cut = corners[i].size;
      if (corners[i].shape == Corner::Shape::kFillet) cut /= std::tan(half_angle);
      cut = std::min({cut, 0.45 * (before - at).norm(), 0.45 * (after - at).norm()});
    }
    ends[i] = at + cut * in;
    starts[i] = at + cut * out;
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (corners[i].shape == Corner::Shape::kChamfer) {
      sides.push_back({ends[i], starts[i]});
    } else if (corners[i].shape == Corner::Shape::kFillet) {
      const Vec2& at = corners[i].at;
      const Vec2 in = (ends[i] - at).normalized(), out = (starts[i] - at).normalized();
      const double half_angle = 0.5 * std::acos(std::clamp(in.dot(out), -1.0, 1.0));
      const double to_centre = (ends[i] - at).norm() / std::cos(half_angle);
      const Vec2 centre = at + to_centre * (in + out).normalized();
      sides.push_back(arc(ends[i], starts[i], centre, cross(out, in) > 0.0));
    }
    sides.push_back({starts[i], ends[(i + 1) % n]});
  }
  return Profile(std::move(sides));
}

Profile circle_profile(const Vec2& centre, double radius) {
  std::vector<Side> sides;
  const Vec2 directions[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (int i = 0; i < 4; ++i) {
    const Vec2 a = centre + radius * directions[i], b = centre + radius * directions[(i + 1) % 4];
    sides.push_back(arc(a, b, centre, true));
  }
  return Profile(std::move(sides));
}

Profile slot_profile(const Vec2& a, const Vec2& b, double radius) {
  const Vec2 along = (b - a).normalized();
  const Vec2 right = radius * Vec2(along.y(), -along.x());
  const Vec2 corners[] = {a + right, b + right, b - right, a - right};
  std::vector<Side> sides;
  sides.push_back({corners[0], corners[1]});
  sides.push_back(arc(corners[1], b + radius * along, b, true));
  sides.push_back(arc(b + radius * along, corners[2], b, true));
  sides.push_back({corners[2], corners[3]});
  sides.push_back(arc(corners[3], a - radius * along, a, true));
  sides.push_back(arc(a - radius * along, corners[0], a, true));
  return Profile(std::move(sides));
}

Solid::Value Solid::value(const Vec3& p) const {
  constexpr double kRounding = 1e-9;
  Value result = {std::numeric_limits<double>::infinity(), {}};
  for (std::size_t i = 0; i < volumes_.size(); ++i) {
    const Feature& feature = volumes_[i];
    const auto is_beyond = [&](double away) {  // a volume that is at least so far away
      return feature.filled ? away >= result.distance : -away <= result.distance;
    };
    if (is_beyond((p - feature.centre).norm() - feature.reach)) continue;
    const Vec3 local = feature.to_local * p;
    if (is_beyond(feature.least_distance(local) - kRounding)) continue;
    Value value = value_of(feature.volume, local);
    value.face.volume = static_cast<std::uint32_t>(i);
    if (!feature.filled) value.distance = -value.distance;
    if (feature.filled ? value.distance < result.distance : value.distance > result.distance) {
      result = value;
    }
  }
  return result;
}

double Solid::Feature::least_distance(const Vec3& local) const {
  const Vec2 aside = (profile_place(volume, local) - middle).cwiseAbs() - half_size;
  const double side = aside.maxCoeff();
  if (volume.kind == Volume::Kind::kRevolution) return side;
  return std::max(side, std::abs(local.z()) - volume.half_height);
}

double Solid::distance_to(const Face& face, const Vec3& p) const {
  const auto& [volume, to_local, centre, reach, middle, half_size, filled] = volumes_[face.volume];
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
  const Vec2 low = volume.profile.low(), high = volume.profile.high();
  volumes_.push_back({std::move(volume), to_local, box.centre(), 0.5 * box.diagonal(),
                      0.5 * (low + high), 0.5 * (high - low), filled});
}

}  // namespace pcednet::shapes
