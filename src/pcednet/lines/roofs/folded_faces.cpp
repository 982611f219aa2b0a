#include "pcednet/lines/roofs/folded_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "pcednet/lines/points/chart.h"
#include "pcednet/lines/roofs/parallel_folds.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kLeastInside = 30;  ///< points inside a face, to tell
constexpr std::size_t kSamples = 500;     ///< of them, and more
constexpr double kOffCentre = 0.45;  ///< of the neighbours of a point inside, in their distances
constexpr double kLowSine = 0.35;    ///< of folds whose place the growth of faces hardly sees
constexpr std::size_t kLeastFoldContacts = 10;
constexpr double kAsGood = 1.05;  ///< sums of squares, of a fold

using Points = std::vector<std::uint32_t>;

/// Coordinates in the plane of a face, in spacings.
struct FaceFrame {
  FaceFrame(const Face& of, double unit) : face(of), chart(of.point, of.normal), spacing(unit) {}
  PlacedPoint operator()(const Vec3& place) const {
    const Chart::Flat at = chart.flat(place) / spacing;
    return {at.x(), at.y(), face.height(place) / spacing};
  }

  Face face;
  Chart chart;
  double spacing;
};

/// Whether a point has others on every side. At an eave, beams that meet it half return heights
/// that are too low.
bool is_surrounded(const OrderedPoints& cloud, const Faces& faces, std::uint32_t point) {
  Vec3 sum = Vec3::Zero();
  double distances = 0.0;
  for (const std::uint32_t other : faces.near(point)) {
    const Vec3 offset = cloud.position(other) - cloud.position(point);
    sum += offset;
    distances += offset.norm();
  }
  return sum.norm() < kOffCentre * distances;
}

/// The points of each face, ascending.
std::vector<Points> members_of(const Faces& faces) {
  std::vector<Points> members(faces.faces.size());
  for (std::uint32_t i = 0; i < faces.of_points.size(); ++i) {
    if (faces.of_points[i] != kNoFace) members[faces.of_points[i]].push_back(i);
  }
  return members;
}

/// Some of those points, of one of two faces, whose nearest others are, too.
Points inside_of(const OrderedPoints& cloud, const Faces& faces, const Points& points,
                 std::uint32_t a, std::uint32_t b) {
  Points inside;
  for (const std::uint32_t i : points) {
    if (faces.is_inside(i, a, b) && is_surrounded(cloud, faces, i)) inside.push_back(i);
  }
  const std::size_t step = std::max<std::size_t>(1, inside.size() / kSamples);
  Points some;
  for (std::size_t k = 0; k < inside.size(); k += step) some.push_back(inside[k]);
  return some;
}

Explanation explain(const OrderedPoints& cloud, const Points& points, const FaceFrame& frame) {
  std::vector<PlacedPoint> placed;
  for (const std::uint32_t i : points) placed.push_back(frame(cloud.position(i)));
  return explain(placed);
}

bool divide(const OrderedPoints& cloud, double spacing, std::uint32_t face, const Points& members,
            const Points& inside, Faces& faces) {
  if (inside.size() < kLeastInside) return false;
  const FaceFrame frame(faces.faces[face], spacing);
  const auto [folds, is_curved] = explain(cloud, inside, frame);
  faces.faces[face].is_curved = is_curved && !folds;
  if (!folds) return false;
  const auto first = static_cast<std::uint32_t>(faces.faces.size());
  for (int k = 0; k < folds->count; ++k) faces.faces.push_back(faces.faces[face]);
  for (const std::uint32_t i : members) {
    const int strip = folds->strip_of(frame(cloud.position(i)));
    if (strip > 0) faces.of_points[i] = first + static_cast<std::uint32_t>(strip) - 1;
  }
  return true;
}

/// Divides the points of two faces anew, at one fold.
bool straighten(const OrderedPoints& cloud, double spacing, std::uint32_t a, std::uint32_t b,
                std::vector<Points>& members, Faces& faces) {
  Points all;
  std::merge(members[a].begin(), members[a].end(), members[b].begin(), members[b].end(),
             std::back_inserter(all));
  const Points inside = inside_of(cloud, faces, all, a, b);
  if (inside.size() < kLeastInside) return false;
  double sq_heights = 0.0;
  for (const std::uint32_t i : inside) {
    const double height = faces.faces[faces.of_points[i]].height(cloud.position(i)) / spacing;
    sq_heights += height * height;
  }
  const FaceFrame frame(faces.faces[a], spacing);
  const auto folds = explain(cloud, inside, frame).folds;
  if (!folds || folds->count != 1 || folds->left > kAsGood * sq_heights) return false;
  Points sides[2];
  int of_a = 0, of_b = 0;  // more of them beyond the fold than before it
  for (const std::uint32_t i : all) {
    const int side = folds->strip_of(frame(cloud.position(i)));
    (faces.of_points[i] == a ? of_a : of_b) += side > 0 ? 1 : -1;
    sides[side].push_back(i);
  }
  members[a] = std::move(sides[of_a > of_b]);
  members[b] = std::move(sides[of_a <= of_b]);
  bool moves = false;
  for (const std::uint32_t face : {a, b}) {
    for (const std::uint32_t i : members[face]) {
      moves = moves || faces.of_points[i] != face;
      faces.of_points[i] = face;
    }
  }
  return moves;
}

}  // namespace

bool divide_folded(const OrderedPoints& cloud, double spacing, Faces& faces) {
  const std::vector<Points> members = members_of(faces);
  std::vector<Points> inside;  // before any is divided
  for (std::uint32_t f = 0; f < members.size(); ++f) {
    inside.push_back(inside_of(cloud, faces, members[f], f, f));
  }
  bool any = false;
  for (std::uint32_t f = 0; f < members.size(); ++f) {
    any = divide(cloud, spacing, f, members[f], inside[f], faces) || any;
  }
  return any;
}

bool straighten_folds(const OrderedPoints& cloud, double spacing, Faces& faces) {
  std::vector<Points> members = members_of(faces);
  bool any = false;
  for (const auto& [pair, count] : count_contacts(faces)) {
    const auto [a, b] = pair;
    const double sine = faces.faces[a].normal.cross(faces.faces[b].normal).norm();
    if (count < kLeastFoldContacts || sine > kLowSine) continue;
    any = straighten(cloud, spacing, a, b, members, faces) || any;
  }
  return any;
}

}  // namespace pcednet::lines
