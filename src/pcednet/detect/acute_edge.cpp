#include "pcednet/detect/acute_edge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "pcednet/detect/points/distinct_points.h"
#include "pcednet/detect/spread.h"
#include "pcednet/gls/engine/scale_space.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kAcuteNeighbours = 32, kLeastAcuteNeighbours = 12;
constexpr double kLeastOfFace = 5.0;   ///< points
constexpr double kOneFace = 0.7;       ///< cosine between its normals
constexpr double kFlatness = 0.95;     ///< length of the mean of its unit normals
constexpr double kLeastTilt = 0.25;    ///< sine between the planes: 14 degrees
constexpr double kMostBetween = 0.25;  ///< share of points on neither face
constexpr double kMostPast = 0.1;      ///< share of the points of a face past the edge

// In spacings.
constexpr double kFarthestEdge = 1.73;
constexpr double kPast = 0.5;       ///< from the edge: a face has gone on
constexpr double kGapAtEdge = 0.7;  ///< between the edge and the nearest point of a face
constexpr double kSharpBand = 0.6, kEdgeBand = 1.6, kChangeOfBand = 0.08;

constexpr float kSure = 0.95f;  ///< the probability of an edge in its band

/// A point and its neighbours, relative to it.
struct NearNormals {
  std::array<Vec3, kAcuteNeighbours + 1> offset, normal;
  std::size_t count = 0;

  void add(const Vec3& its_offset, const Vec3& its_normal) {
    offset[count] = its_offset;
    normal[count++] = its_normal;
  }
};

/// Those on one face.
struct NearFace {
  std::array<std::uint8_t, kAcuteNeighbours + 1> members = {};
  double count = 0.0, flatness = 0.0;
  Vec3 normal = Vec3::Zero(), centre = Vec3::Zero();

  void finish(const NearNormals& around) {
    for (std::size_t k = 0; k < around.count; ++k) {
      if (!members[k]) continue;
      count += 1.0;
      normal += around.normal[k];
      centre += around.offset[k];
    }
    flatness = normal.norm() / count;
    normal.normalize();
    centre /= count;
  }
};

/// The face with the most points of those that the gate hides from `own`.
NearFace hidden_face(const NearNormals& around, const Vec3& own, double gate) {
  std::array<std::uint8_t, kAcuteNeighbours + 1> hidden = {}, best = {};
  std::ptrdiff_t most = 0;
  for (std::size_t k = 0; k < around.count; ++k) hidden[k] = around.normal[k].dot(own) <= gate;
  for (std::size_t seed = 0; seed < around.count; ++seed) {
    if (!hidden[seed]) continue;
    std::array<std::uint8_t, kAcuteNeighbours + 1> members = {};
    for (std::size_t k = 0; k < around.count; ++k) {
      members[k] = hidden[k] && around.normal[k].dot(around.normal[seed]) >= kOneFace;
    }
    const auto count = std::count(members.begin(), members.end(), 1);
    if (count <= most) continue;
    most = count;
    best = members;
  }
  NearFace face{.members = best};
  if (most > 0) face.finish(around);
  return face;
}

/// The points whose normals are about `own`.
NearFace own_face(const NearNormals& around, const Vec3& own) {
  NearFace face;
  for (std::size_t k = 0; k < around.count; ++k) {
    face.members[k] = around.normal[k].dot(own) >= kOneFace;
  }
  face.finish(around);
  return face;
}

/// Whether the face comes near to the line through `foot` along `line`, and does not go on past
/// it.
bool ends_at(const NearFace& face, const NearNormals& around, const Vec3& foot, const Vec3& line,
             double spacing) {
  Vec3 inwards = face.normal.cross(line);
  if (inwards.dot(face.centre - foot) < 0.0) inwards = -inwards;
  double past = 0.0, nearest = kFarthestEdge;
  for (std::size_t k = 0; k < around.count; ++k) {
    if (!face.members[k]) continue;
    const double inside = inwards.dot(around.offset[k] - foot) / spacing;
    past += inside < -kPast ? 1.0 : 0.0;
    nearest = std::min(nearest, std::max(0.0, inside));
  }
  return past <= kMostPast * face.count && nearest <= kGapAtEdge;
}

/// The distance of the first point of `around`, in spacings, to the edge that the gate hides from
/// it.
std::optional<double> distance_to_edge(const NearNormals& around, double gate, double radius) {
  const Vec3& own = around.normal[0];
  const NearFace other = hidden_face(around, own, gate);
  if (other.count < kLeastOfFace) return std::nullopt;
  const NearFace face = own_face(around, own);
  const double seen = static_cast<double>(around.count);
  if (face.count < kLeastOfFace || seen - face.count - other.count > kMostBetween * seen) {
    return std::nullopt;
  }
  if (std::min(face.flatness, other.flatness) < kFlatness) return std::nullopt;
  const double cosine = face.normal.dot(other.normal);
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  if (sine < kLeastTilt) return std::nullopt;

  const Vec3 on_face = face.normal.dot(face.centre) * face.normal;
  const Vec3 across = (other.normal - cosine * face.normal) / sine;
  const double to_edge = other.normal.dot(other.centre - on_face) / sine;
  const double distance = std::abs(to_edge);
  const double spacing = radius * std::sqrt(std::numbers::pi / seen);  // as of one face
  if (distance > kFarthestEdge * spacing) return std::nullopt;

  const Vec3 foot = on_face + to_edge * across, line = across.cross(face.normal);
  if (!ends_at(face, around, foot, line, spacing)) return std::nullopt;
  if (!ends_at(other, around, foot, line, spacing)) return std::nullopt;
  return distance / spacing;
}

/// 1 within a band, 0 beyond it.
float share_within(double distance, double band) {
  return static_cast<float>(1.0 / (1.0 + std::exp((distance - band) / kChangeOfBand)));
}

struct FoundEdge {
  std::uint32_t place = 0;
  float distance = 0.0f;
  std::array<std::uint32_t, kAcuteNeighbours> others = {};
  std::size_t count = 0;
};

std::optional<FoundEdge> edge_at(const DistinctPoints& points, std::span<const Vec3> normals,
                                 double gate, std::uint32_t place,
                                 std::span<const spatial::Neighbour> near) {
  const Vec3& own = normals[place];
  const bool hides = std::any_of(near.begin(), near.end(), [&](const auto& other) {
    return normals[other.index].dot(own) <= gate && !normals[other.index].isZero(0.0);
  });
  if (!hides || own.isZero(0.0)) return std::nullopt;
  NearNormals around;
  around.add(Vec3::Zero(), own);
  FoundEdge it;
  it.place = place;
  for (const spatial::Neighbour& other : near) {
    it.others[it.count++] = other.index;
    const Vec3& normal = normals[other.index];
    if (normal.isZero(0.0)) continue;
    around.add(points.positions[other.index] - points.positions[place], normal);
  }
  const auto distance = distance_to_edge(around, gate, std::sqrt(near.back().sq_distance));
  if (!distance) return std::nullopt;
  it.distance = static_cast<float>(*distance);
  return it;
}

/// The cosine between normals at which all gates hide one point from the other, if any do.
std::optional<double> hiding_gate(const PreparedCloud& cloud,
                                  const gls::ScaleSpaceOptions& descriptor) {
  const bool estimated = cloud.decision.made && !cloud.reoriented;
  if (estimated && !cloud.decision.exact_planes) return std::nullopt;
  double loosest = 1.0;
  for (const std::optional<double>& gate : gls::gates_of(descriptor)) {
    if (!gate) return std::nullopt;
    loosest = std::min(loosest, *gate);
  }
  return loosest < 0.0 ? std::optional(loosest) : std::nullopt;
}

}  // namespace

std::vector<AcuteEdgePoint> find_acute_edges(const PreparedCloud& cloud,
                                             const gls::ScaleSpaceOptions& descriptor,
                                             const Progress* progress) {
  const std::optional<double> gate = hiding_gate(cloud, descriptor);
  if (!gate) return {};
  const DistinctPoints points(cloud);
  const spatial::NeighbourSearch search(points.positions);
  if (search.available(kAcuteNeighbours) < kLeastAcuteNeighbours) return {};
  std::vector<Vec3> normals(points.size());
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = points.normal(i);
  std::vector<AcuteEdgePoint> edges;
  Stage stage(progress, "acute", points.size());
  const auto try_places = [&](std::span<const std::uint32_t> todo) {
    std::vector<std::uint32_t> around;
    const auto found = found_at<FoundEdge>(search, todo, kAcuteNeighbours, stage,
                                           [&](std::uint32_t place, const auto& near) {
                                             return edge_at(points, normals, *gate, place, near);
                                           });
    for (const FoundEdge& it : found) {
      around.insert(around.end(), it.others.begin(), it.others.begin() + it.count);
      for (const std::uint32_t copy : points.points(it.place)) edges.push_back({copy, it.distance});
    }
    return around;
  };
  const auto first = first_places(points.positions, cloud.part);
  stage.advance(points.size() - spread(points.size(), first, try_places));
  std::sort(edges.begin(), edges.end(),
            [](const AcuteEdgePoint& a, const AcuteEdgePoint& b) { return a.point < b.point; });
  return edges;
}

void mark_acute_edges(std::span<const AcuteEdgePoint> points, const EdgeModel& model,
                      Classification& found) {
  const std::vector<std::uint8_t> outputs = edge_outputs(model);
  const bool has_smooth = std::find(outputs.begin(), outputs.end(), kSmoothEdge) != outputs.end();
  for (const AcuteEdgePoint& it : points) {
    std::uint8_t& its_class = found.classes[it.point];
    if (its_class != kNonEdge) continue;
    float &sharp = found.p_sharp[it.point], &smooth = found.p_smooth[it.point];
    const double distance = static_cast<double>(it.distance);
    const float near = share_within(distance, kSharpBand);
    if (has_smooth) {
      const float edge = std::max(sharp + smooth, kSure * share_within(distance, kEdgeBand));
      sharp = edge * near;
      smooth = edge - sharp;
    } else {
      sharp = std::max(sharp, kSure * near);
    }
    if (sharp + smooth > 0.5f) its_class = sharp >= smooth ? kSharpEdge : kSmoothEdge;
    if (!found.p_class.empty()) {
      found.p_class[it.point] =
          its_class == kNonEdge ? 1.0f - sharp - smooth : std::max(sharp, smooth);
    }
  }
}

}  // namespace pcednet::detect
