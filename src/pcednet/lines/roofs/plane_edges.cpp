#include "pcednet/lines/roofs/plane_edges.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pcednet/lines/roofs/eaves.h"

namespace pcednet::lines {
namespace {

constexpr double kPlanePart = 0.9;
constexpr double kMostCurved = 300.0;  ///< points: of more the general procedure sees the surface
constexpr std::size_t kMostPoints = 1 << 17;
constexpr std::size_t kFaceSamples = 4000;
constexpr double kAboveOthers = 0.03;  ///< largest share of points above or below others

// In spacings.
constexpr double kBesideInPlan = 0.3, kAbove = 3.0, kPlate = 0.7;

spatial::KdTree plan_of(const OrderedPoints& cloud) {
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < cloud.size(); ++i) places.push_back(in_plan(cloud.position(i)));
  return spatial::KdTree(places);
}

/// Whether few points have others straight above or below them. Those of the other side of a thin
/// plate have opposed normals.
bool is_seen_from_above(const OrderedPoints& cloud, const Sampling& sampling,
                        const spatial::KdTree& plan) {
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kFaceSamples);
  std::size_t seen = 0, above = 0;
  std::vector<spatial::Neighbour> near;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    plan.within_unsorted(in_plan(cloud.position(i)), kBesideInPlan * sampling.spacing, near);
    ++seen;
    above += std::any_of(near.begin(), near.end(), [&](const spatial::Neighbour& other) {
      const bool opposed = sampling.oriented && cloud.face_away(i, other.index);
      return std::abs(cloud.position(other.index).z() - cloud.position(i).z()) >
             (opposed ? kPlate : kAbove) * sampling.spacing;
    });
  }
  return static_cast<double>(above) <= kAboveOthers * static_cast<double>(seen);
}

}  // namespace

std::optional<std::vector<Piece>> find_plane_edges(const OrderedPoints& cloud,
                                                   const Sampling& sampling,
                                                   const Progress* progress) {
  const double spacing = sampling.spacing;
  if (!(spacing > 0.0) || cloud.size() > kMostPoints || cloud.has_scanners()) return std::nullopt;
  const spatial::KdTree plan = plan_of(cloud);
  if (!is_seen_from_above(cloud, sampling, plan)) return std::nullopt;
  const Faces faces = find_faces(cloud, sampling, progress);
  const double curved = (1.0 - faces.share) * static_cast<double>(cloud.size());
  if (faces.share < kPlanePart || curved > kMostCurved) return std::nullopt;
  std::vector<Fold> folds = find_roof_folds(cloud, faces, spacing);
  std::vector<Piece> pieces = find_eaves(cloud, faces, sampling, folds, plan, progress);
  for (Fold& fold : folds) pieces.push_back(std::move(fold.piece));
  return pieces;
}

}  // namespace pcednet::lines
