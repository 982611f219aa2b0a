#include "pcednet/detect/crease_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "pcednet/core/parallel.h"
#include "pcednet/normals/exact_planes.h"
#include "pcednet/spatial/neighbour_search.h"
#include "pcednet/spatial/places.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kNearest = 24;  ///< nearest others among which faces are looked for
constexpr std::size_t kPointsAtATime = 512;
constexpr int kOtherFaces = 2;

/// Tolerances for a face's plane, relative to the distance of its last neighbour: the first that
/// finds a plane counts.
constexpr std::array<double, 4> kTolerances = {0.003, 0.01, 0.03, 0.08};

constexpr double kLeastSine = 0.438;  ///< between the normals of two faces: 26 degrees

// In the unit.
constexpr double kOnOwnFace = 0.04;    ///< of the points of the point's own face from its plane
constexpr double kOnOtherFace = 0.08;  ///< of those of another
constexpr double kHalfWeight = 0.016;  ///< a point at this distance from another face counts half
constexpr double kCreaseReach = 2.5;   ///< of the points that count, from the crease
constexpr double kGap = 1.6;           ///< of the nearest of them
constexpr double kFarthest = 2.5;      ///< crease
constexpr double kLeastPoints = 3.0;   ///< of another face
constexpr double kOnCrease = 0.02;     ///< of the vertices of a mesh from both faces
constexpr int kLeastVertices = 2;

constexpr float kNoCrease = std::numeric_limits<float>::infinity();

/// The nearest others of a point that are free (on no face found), relative to it, in the unit.
struct NearFaces {
  std::array<Vec3, kNearest> offsets, normals;
  std::array<bool, kNearest> free;
  std::size_t count = 0;
};

/// The line where another face meets the point's own.
struct CreaseBeside {
  double distance = 0.0;
  double points = 0.0;  ///< that the other face explains
  std::size_t face = kNearest;
};

/// The crease with the plane through neighbour `face`; without points if there is none.
CreaseBeside crease_with(std::size_t face, const Vec3& own, const NearFaces& around) {
  const Vec3& normal = around.normals[face];
  const double cosine = normal.dot(own);
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double height = normal.dot(around.offsets[face]);
  if (normal.isZero(0.0) || !(sine > kLeastSine) || std::abs(height) > kFarthest * sine) return {};
  const Vec3 foot = height / (sine * sine) * (normal - cosine * own);
  CreaseBeside crease = {std::abs(height) / sine, 0.0, face};
  double sq_gap = kCreaseReach * kCreaseReach;
  for (std::size_t k = 0; k < around.count; ++k) {
    const double sq_away = (around.offsets[k] - foot).squaredNorm();
    if (!around.free[k] || sq_away > kCreaseReach * kCreaseReach) continue;
    const double off = normal.dot(around.offsets[k]) - height;
    crease.points += 1.0 / (1.0 + off * off / (kHalfWeight * kHalfWeight));
    if (std::abs(off) < kOnOtherFace) sq_gap = std::min(sq_gap, sq_away);
  }
  return sq_gap < kGap * kGap && crease.points >= kLeastPoints ? crease : CreaseBeside{};
}

/// Whether the crease has vertices of a mesh on it: hardly any randomly sampled points are.
bool has_vertices(const CreaseBeside& crease, const Vec3& own, const NearFaces& around) {
  const Vec3 &normal = around.normals[crease.face], place = around.offsets[crease.face];
  int vertices = crease.distance < kOnCrease ? 1 : 0;
  for (std::size_t k = 0; k < around.count; ++k) {
    const Vec3& offset = around.offsets[k];
    const double off_own = std::abs(own.dot(offset)), off = std::abs(normal.dot(offset - place));
    vertices += off_own < kOnCrease && off < kOnCrease ? 1 : 0;
  }
  return vertices >= kLeastVertices;
}

/// `own` is the normal of the point's face. Takes the points of the faces found.
float nearest_crease(const Vec3& own, NearFaces& around) {
  double nearest = kNoCrease;
  for (std::size_t k = 0; k < around.count; ++k) {
    around.free[k] = std::abs(own.dot(around.offsets[k])) > kOnOwnFace;
  }
  for (int i = 0; i < kOtherFaces; ++i) {
    CreaseBeside best;
    for (std::size_t k = 0; k < around.count; ++k) {
      if (!around.free[k]) continue;
      const CreaseBeside crease = crease_with(k, own, around);
      if (crease.points > best.points) best = crease;
    }
    if (best.face == kNearest) break;
    if (has_vertices(best, own, around)) return kNoCrease;
    nearest = std::min(nearest, best.distance);
    const Vec3 &normal = around.normals[best.face], place = around.offsets[best.face];
    for (std::size_t k = 0; k < around.count; ++k) {
      if (std::abs(normal.dot(around.offsets[k] - place)) < kOnOtherFace) around.free[k] = false;
    }
  }
  return static_cast<float>(nearest);
}

/// The places of a cloud's points along its curve.
class FacePlaces {
 public:
  FacePlaces(spatial::Places places, double unit)
      : unit_(unit), places_(std::move(places)), search_(places_.positions) {}

  std::size_t size() const { return places_.size(); }
  std::span<const std::uint32_t> points(std::uint32_t place) const { return places_.points(place); }
  std::size_t available(std::size_t count) const { return search_.available(count); }

  /// The available(count) nearest others of each of `places`, which are ascending, row after row.
  std::vector<std::uint32_t> nearest_others(std::span<const std::uint32_t> places,
                                            std::size_t count) const {
    const std::size_t others = available(count);
    std::vector<std::uint32_t> rows(places.size() * others);
    search_.for_each_neighbourhood(places, others, [&](std::size_t k, const auto& near) {
      for (std::size_t i = 0; i < others; ++i) rows[k * others + i] = near[i].index;
    });
    return rows;
  }

  /// The normal of the face at each of `places`; zero where none was found, and elsewhere.
  std::vector<Vec3> face_normals(std::span<const std::uint32_t> places) const {
    std::vector<Vec3> normals(size(), Vec3::Zero());
    const auto find = [&](std::size_t k, std::span<const spatial::Neighbour> others) {
      std::array<std::uint32_t, normals::kExactNeighbours> near;
      for (std::size_t i = 0; i < others.size(); ++i) near[i] = others[i].index;
      for (const double tolerance : kTolerances) {
        Vec3& normal = normals[places[k]];
        normal = normals::face_normal(places_.positions, places[k],
                                      std::span(near).first(others.size()), tolerance);
        if (!normal.isZero(0.0)) break;
      }
    };
    search_.for_each_neighbourhood(places, normals::kExactNeighbours, find);
    return normals;
  }

  NearFaces near_faces(std::uint32_t place, std::span<const std::uint32_t> near,
                       std::span<const Vec3> normals) const {
    NearFaces around;
    around.count = near.size();
    for (std::size_t k = 0; k < near.size(); ++k) {
      around.offsets[k] = (places_.positions[near[k]] - places_.positions[place]) / unit_;
      around.normals[k] = normals[near[k]];
    }
    return around;
  }

 private:
  double unit_;
  spatial::Places places_;
  spatial::NeighbourSearch search_;
};

std::vector<std::uint32_t> places_where(std::span<const std::uint8_t> marks) {
  std::vector<std::uint32_t> places;
  for (std::uint32_t place = 0; place < marks.size(); ++place) {
    if (marks[place] != 0) places.push_back(place);
  }
  return places;
}

/// `places` and `others`, ascending, each once.
std::vector<std::uint32_t> united(std::span<const std::uint32_t> places,
                                  std::span<const std::uint32_t> others, std::size_t size) {
  std::vector<std::uint8_t> marks(size, 0);
  for (const std::uint32_t place : places) marks[place] = 1;
  for (const std::uint32_t place : others) marks[place] = 1;
  return places_where(marks);
}

}  // namespace

std::vector<float> crease_distances(std::span<const Vec3> positions,
                                    std::span<const std::uint32_t> curve,
                                    std::span<const std::uint8_t> wanted, double unit) {
  const FacePlaces cloud(spatial::places_of(positions, {curve.begin(), curve.end()}), unit);
  std::vector<std::uint32_t> places;
  for (std::uint32_t place = 0; place < cloud.size(); ++place) {
    const auto points = cloud.points(place);
    if (std::any_of(points.begin(), points.end(), [&](auto i) { return wanted[i] != 0; })) {
      places.push_back(place);
    }
  }
  const std::size_t others = cloud.available(kNearest);
  const auto rows = cloud.nearest_others(places, others);
  const auto normals = cloud.face_normals(united(places, rows, cloud.size()));
  std::vector<float> distances(positions.size(), kNoCrease);
  parallel_blocks(places.size(), kPointsAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3& own = normals[places[k]];
      if (own.isZero(0.0)) continue;
      const auto near = std::span(rows).subspan(k * others, others);
      NearFaces around = cloud.near_faces(places[k], near, normals);
      const float distance = nearest_crease(own, around);
      for (const std::uint32_t i : cloud.points(places[k])) {
        if (wanted[i] != 0) distances[i] = distance;
      }
    }
  });
  return distances;
}

}  // namespace pcednet::detect
