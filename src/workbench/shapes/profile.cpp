#include "workbench/shapes/profile.h"

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

}  // namespace pcednet::shapes
