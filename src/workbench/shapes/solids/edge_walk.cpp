#include "workbench/shapes/solids/edge_walk.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "pcednet/core/random.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/core/sort_unique.h"
#include "workbench/shapes/solids/mesh_vertices.h"

namespace pcednet::shapes {
namespace {

constexpr double kReach = 1e-6;          // of the test whether both faces are there
constexpr double kOnBoundary = 1e-9;     // largest distance of a point on a face
constexpr double kLongestStep = 0.0025;  // of the diagonal
constexpr double kShortestStep = 1e-7;
constexpr double kLargestBend = 0.06;  // radians from step to step
constexpr double kLost = 10.0;         // a bend larger than any
constexpr double kShortest = 1e-6;     // edge

/// Surfaces touch rather than cross below this sine of their angle.
constexpr double kTouching = 0.02;

}  // namespace

SurfaceIndex::SurfaceIndex(const Solid& solid) : solid_(solid) {
  constexpr int kProbes = 6;
  Random random(1);
  const Vec3 extent = solid.box().max - solid.box().min;
  for (int i = 0; i < kProbes; ++i) {
    const Vec3 place = uniform_vector(random);
    probes_.push_back(solid.box().min + extent.cwiseProduct(place));
  }
}

std::size_t SurfaceIndex::of(const Face& face) {
  const auto key = std::tuple(face.volume, face.side, face.part);
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  std::vector<double> distances;
  for (const Vec3& probe : probes_) distances.push_back(solid_.distance_to(face, probe));
  const auto equal = [&](const std::vector<double>& other) {
    return std::equal(other.begin(), other.end(), distances.begin(),
                      [](double a, double b) { return std::abs(a - b) < 1e-9; });
  };
  const auto same = std::find_if(distances_.begin(), distances_.end(), equal);
  const auto surface = static_cast<std::size_t>(same - distances_.begin());
  if (same == distances_.end()) {
    distances_.push_back(std::move(distances));
    faces_.push_back(face);
  }
  known_.emplace(key, surface);
  return surface;
}

EdgeWalk::EdgeWalk(const Solid& solid, std::span<const BorderPoint> borders)
    : solid_(solid), surfaces_(solid), longest_step_(kLongestStep * solid.box().diagonal()) {
  for (const BorderPoint& border : borders) {
    if (border.turn() < kSharpTurn) continue;
    seeds_.push_back({border.position, surfaces_.of(border.a), surfaces_.of(border.b)});
  }
  std::reverse(seeds_.begin(), seeds_.end());
  while (!seeds_.empty()) {
    const Seed seed = seeds_.back();
    seeds_.pop_back();
    follow(seed);
  }
}

Vec3 EdgeWalk::Place::tangent() const {
  return normal_a.cross(normal_b).normalized();
}

double EdgeWalk::Place::turn() const {
  return std::atan2(normal_a.cross(normal_b).norm(), normal_a.dot(normal_b));
}

std::optional<EdgeWalk::Place> EdgeWalk::onto(std::size_t a, std::size_t b, Vec3 p) const {
  constexpr int kSteps = 12;
  const Face &face_a = surfaces_.face(a), &face_b = surfaces_.face(b);
  for (int i = 0; i < kSteps; ++i) {
    const Place place = {p, solid_.normal_of(face_a, p), solid_.normal_of(face_b, p)};
    const double along = place.normal_a.dot(place.normal_b);
    if (!(1.0 - along * along > kTouching * kTouching)) return std::nullopt;
    const double fa = solid_.distance_to(face_a, p), fb = solid_.distance_to(face_b, p);
    if (std::max(std::abs(fa), std::abs(fb)) < 1e-13) return place;
    const double scale = 1.0 / (1.0 - along * along);
    const Vec3 step =
        scale * ((fa - along * fb) * place.normal_a + (fb - along * fa) * place.normal_b);
    p -= step;
    // Rounding may keep the distances from falling further.
    if (step.norm() < 1e-12) return place;
  }
  return std::nullopt;
}

/// On the boundary, on a face of the surface.
bool EdgeWalk::has_face(std::size_t surface, const Vec3& p) {
  const Face& face = surfaces_.face(surface);
  Vec3 on = p;
  for (int i = 0; i < 2; ++i) on -= solid_.distance_to(face, on) * solid_.normal_of(face, on);
  const Solid::Value value = solid_.value(on);
  return std::abs(value.distance) < kOnBoundary && surfaces_.of(value.face) == surface;
}

/// True if faces of both surfaces leave the place, both below the other surface (a convex edge) or
/// both above (a concave one), and turn enough.
bool EdgeWalk::is_edge(std::size_t a, std::size_t b, const Place& place, double reach) {
  const Vec3 &na = place.normal_a, &nb = place.normal_b;
  if (place.turn() < kSharpTurn) return false;
  const Vec3 tangent = place.tangent();
  const Vec3 up_along_a = tangent.cross(na) * (tangent.cross(na).dot(nb) > 0.0 ? 1.0 : -1.0);
  const Vec3 up_along_b = tangent.cross(nb) * (tangent.cross(nb).dot(na) > 0.0 ? 1.0 : -1.0);
  for (const double side : {-reach, reach}) {
    if (has_face(a, place.position + side * up_along_a) &&
        has_face(b, place.position + side * up_along_b)) {
      return true;
    }
  }
  return false;
}

/// Whether an edge has been followed through the seed.
bool EdgeWalk::is_known(const Seed& seed) const {
  const auto found = by_pair_.find(std::minmax(seed.a, seed.b));
  if (found == by_pair_.end()) return false;
  for (const std::size_t e : found->second) {
    const WalkedEdge& edge = edges_[e];
    const std::size_t pieces = edge.closed ? edge.points.size() : edge.points.size() - 1;
    for (std::size_t i = 0; i < pieces; ++i) {
      const Vec3 &from = edge.points[i], &to = edge.points[(i + 1) % edge.points.size()];
      const Vec3 along = to - from;
      const double t =
          std::clamp((seed.position - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double away = (seed.position - from - t * along).norm();
      if (away < 0.02 * along.norm() + 1e-6) return true;
    }
  }
  return false;
}

void EdgeWalk::follow(const Seed& seed) {
  if (seed.a == seed.b || is_known(seed)) return;
  WalkedEdge edge = {std::min(seed.a, seed.b), std::max(seed.a, seed.b), {}};
  const auto start = onto(edge.a, edge.b, seed.position);
  if (!start || (start->position - seed.position).norm() > 1e-5) return;
  if (!is_edge(edge.a, edge.b, *start, kReach)) return;
  edge.closed = advance(edge, *start, 1.0);
  if (!edge.closed) {
    std::reverse(edge.points.begin(), edge.points.end());
    edge.points.push_back(start->position);
    advance(edge, *start, -1.0);
  } else {
    edge.points.insert(edge.points.begin(), start->position);
  }
  double length = 0.0;
  for (std::size_t i = 1; i < edge.points.size(); ++i) {
    length += (edge.points[i] - edge.points[i - 1]).norm();
  }
  if (length < kShortest) return;
  for (const Vec3& p : edge.points) {
    const auto place = onto(edge.a, edge.b, p);
    edge.turn += (place ? *place : *start).turn() / static_cast<double>(edge.points.size());
  }
  by_pair_[{edge.a, edge.b}].push_back(edges_.size());
  edges_.push_back(std::move(edge));
}

/// Appends the points from `start`, which is not, to the end of the edge that way; true if the way
/// leads back to the start.
bool EdgeWalk::advance(WalkedEdge& edge, const Place& start, double sign) {
  constexpr std::size_t kMostSteps = 100000;
  Place at = start;
  double step = 0.25 * longest_step_;
  for (std::size_t i = 0; i < kMostSteps; ++i) {
    const Vec3 ahead = sign * at.tangent();
    const auto next = onto(edge.a, edge.b, at.position + step * ahead);
    const auto half = onto(edge.a, edge.b, at.position + 0.5 * step * ahead);
    const auto bend = [&](const std::optional<Place>& place) {
      if (!place || (place->position - at.position).norm() > 1.5 * step) return kLost;
      return std::acos(std::min((sign * place->tangent()).dot(ahead), 1.0));
    };
    if (std::max(bend(next), bend(half)) > kLargestBend) {
      if ((step *= 0.5) < kShortestStep) return false;
      continue;
    }
    if (!is_edge(edge.a, edge.b, *half, kReach) || !is_edge(edge.a, edge.b, *next, kReach)) {
      edge.points.push_back(finish_end(edge, at, step * ahead));
      return false;
    }
    const Vec3 way = next->position - at.position;
    const double t = (start.position - at.position).dot(way) / way.squaredNorm();
    const bool is_back = (at.position + t * way - start.position).norm() < 0.05 * step;
    if (i > 2 && t > 0.0 && t <= 1.0 && is_back) return true;
    edge.points.push_back(next->position);
    if (bend(next) < 0.5 * kLargestBend) step = std::min(1.5 * step, longest_step_);
    at = *next;
  }
  return false;
}

/// The end of the edge by a test of this reach, between `last` and `ahead` of it.
Vec3 EdgeWalk::end_beyond(const WalkedEdge& edge, const Place& last, const Vec3& ahead,
                          double reach) {
  double low = 0.0, high = 1.0;
  Vec3 end = last.position;
  while ((high - low) * ahead.norm() > 1e-12) {
    const double middle = 0.5 * (low + high);
    const auto place = onto(edge.a, edge.b, last.position + middle * ahead);
    if (place && is_edge(edge.a, edge.b, *place, reach)) {
      low = middle;
      end = place->position;
    } else {
      high = middle;
    }
  }
  return end;
}

/// The surfaces around the end of an edge other than its own.
std::vector<std::size_t> EdgeWalk::thirds_at(const WalkedEdge& edge, const Vec3& end) {
  std::vector<std::size_t> thirds;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const Vec3 p = end + 5.0 * kReach * Vec3(x, y, z);
        const std::size_t surface = surfaces_.of(solid_.value(p).face);
        if (surface != edge.a && surface != edge.b) thirds.push_back(surface);
      }
    }
  }
  sort_unique(thirds);
  return thirds;
}

/// The point common to three surfaces near `p`, if they cross there.
std::optional<Vec3> EdgeWalk::corner_near(const std::array<std::size_t, 3>& surfaces,
                                          Vec3 p) const {
  constexpr int kSteps = 8;
  for (int i = 0; i < kSteps; ++i) {
    Mat3 normals;
    Vec3 distances;
    for (int row = 0; row < 3; ++row) {
      const Face& face = surfaces_.face(surfaces[static_cast<std::size_t>(row)]);
      normals.row(row) = solid_.normal_of(face, p).transpose();
      distances[row] = solid_.distance_to(face, p);
    }
    if (!(std::abs(normals.determinant()) > 1e-3)) return std::nullopt;
    p -= normals.inverse() * distances;
    if (distances.norm() < 1e-13) return p;
  }
  return std::nullopt;
}

/// The end of an edge: the point common to its surfaces and a third, else where the test ends it in
/// the limit of no reach.
Vec3 EdgeWalk::finish_end(const WalkedEdge& edge, const Place& last, const Vec3& ahead) {
  constexpr double kFarthest = 20.0 * kReach;
  const Vec3 near = end_beyond(edge, last, ahead, kReach);
  Vec3 estimate = near + (near - end_beyond(edge, last, ahead, 2.0 * kReach));
  if ((estimate - near).norm() > kFarthest) estimate = near;
  const std::vector<std::size_t> thirds = thirds_at(edge, estimate);
  Vec3 end = estimate;
  double least = kFarthest;
  for (const std::size_t third : thirds) {
    const auto corner = corner_near({edge.a, edge.b, third}, estimate);
    if (!corner || (*corner - estimate).norm() >= least) continue;
    least = (*corner - estimate).norm();
    end = *corner;
  }
  for (const std::size_t third : thirds) {
    add_seeds(edge.a, third, end);
    add_seeds(edge.b, third, end);
  }
  return end;
}

/// Edges of the two surfaces may start at `corner`.
void EdgeWalk::add_seeds(std::size_t a, std::size_t b, const Vec3& corner) {
  constexpr double kAway = 1e-4;
  const auto place = onto(a, b, corner);
  if (!place || (place->position - corner).norm() > kAway) return;
  for (const double away : {-kAway, kAway}) {
    const auto seed = onto(a, b, place->position + away * place->tangent());
    if (seed) seeds_.push_back({seed->position, a, b});
  }
}

std::optional<Vec3> EdgeWalk::onto_edge(const WalkedEdge& edge, const Vec3& p) const {
  const auto place = onto(edge.a, edge.b, p);
  return place ? std::optional(place->position) : std::nullopt;
}

}  // namespace pcednet::shapes
