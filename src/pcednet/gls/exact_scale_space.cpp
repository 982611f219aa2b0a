#include "pcednet/gls/exact_scale_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "pcednet/core/parallel.h"
#include "pcednet/gls/covariance_plane.h"
#include "pcednet/gls/descriptor.h"
#include "pcednet/gls/features.h"
#include "pcednet/gls/fit_limits.h"
#include "pcednet/gls/moments.h"
#include "pcednet/gls/projection.h"
#include "pcednet/gls/scales.h"
#include "pcednet/gls/sphere_fit.h"

namespace pcednet::gls {
namespace {

/// Writes `features` as Numbers; false, with zeros written, if one of them is not finite then.
template <typename Number>
bool store(std::span<const double> features, std::span<Number> out) {
  std::transform(features.begin(), features.end(), out.begin(),
                 [](double f) { return static_cast<Number>(f); });
  if (std::all_of(out.begin(), out.end(), [](Number f) { return std::isfinite(f); })) return true;
  std::fill(out.begin(), out.end(), Number(0));
  return false;
}

}  // namespace

/// A surface fitted around an evaluation point, and its description there.
struct ExactScaleSpace::Fit {
  FitStatus status = FitStatus::kUndefined;
  AlgebraicSphere surface;
  Descriptor descriptor;
};

/// A thread's buffers for describing points, kept from point to point.
struct ExactScaleSpace::Scratch {
  std::vector<spatial::Neighbour> all;    ///< around the point, at the largest scale
  std::vector<spatial::Neighbour> found;  ///< around its projection
  std::vector<spatial::Neighbour> unordered;
  Neighbourhood neighbours;  ///< of the point, at the largest scale
  Neighbourhood projected;   ///< of its projection, at one scale
};

ExactScaleSpace::ExactScaleSpace(OrientedPoints points, const ScaleSpaceOptions& options,
                                 const Progress* progress)
    : options_(options), gates_(gates_of(options)), tree_({}) {
  check(points, options);
  Stage stage(progress, "prepare", 3);
  PointOrder ordered = point_order(points);
  const std::vector<std::uint32_t> distinct = distinct_points(points, ordered);
  order_ = std::move(ordered.order);
  place_ = places_in(distinct, points.positions.size());
  add_copies(points, distinct, order_, place_);
  for (const std::uint32_t i : distinct) {
    positions_.push_back(points.positions[i]);
    normals_.push_back(is_usable(points.normals[i]) ? points.normals[i] : Vec3::Zero());
  }
  stage.advance();
  tree_ = spatial::KdTree(positions_);
  stage.advance();
  const auto spacings = [&] { return spacings_of_places(points.positions, distinct); };
  range_ = scale_range(positions_, options.range, spacings);
  scales_ = sample_scales(range_, options.scales);
  stage.advance();
}

void ExactScaleSpace::take_octave(std::size_t octave) {
  scales_ = sample_scales(at_octave(range_, octave), options_.scales);
}

/// The points `found` relative to a position at `offset` from the point at `place`, whose normal
/// the gate uses. An offset, not a position, so that differences of large coordinates are taken
/// before anything small is added.
void ExactScaleSpace::localise(std::span<const spatial::Neighbour> found, std::uint32_t place,
                               const Vec3& offset, double radius,
                               const std::optional<double>& gate_threshold,
                               Neighbourhood& neighbours) const {
  const Vec3& own = normals_[place];
  const bool gated = gate_threshold && !own.isZero(0.0);
  const bool moved = !offset.isZero(0.0);
  neighbours.clear();
  for (const spatial::Neighbour& neighbour : found) {
    const Vec3& n = normals_[neighbour.index];
    if (n.isZero(0.0)) continue;
    const double gate = gated ? side_gate(n, own, *gate_threshold) : 1.0;
    if (gate == 0.0) continue;
    const Vec3 y = (positions_[neighbour.index] - positions_[place]) - offset;
    const double sq_distance = moved ? y.squaredNorm() : neighbour.sq_distance;
    if (sq_distance < radius * radius) neighbours.emplace_back(y, n, sq_distance, gate);
  }
}

ExactScaleSpace::Fit ExactScaleSpace::fit(std::span<const LocalNeighbour> neighbours,
                                          double t) const {
  switch (options_.reconstruction) {
    case Reconstruction::kCovariancePlane:
    case Reconstruction::kPlaneMls: {
      const CovariancePlane plane = fit_covariance_plane(neighbours, t);
      return {plane.status, plane.plane, plane.descriptor};
    }
    case Reconstruction::kSphere:
    case Reconstruction::kSphereMls:
      break;
  }
  const MomentSet moments = sum_moments(neighbours, t);
  const SphereFit sphere = fit_sphere(moments.value, moments.count, t);
  return {sphere.status, sphere.sphere, describe_sphere(sphere, moments)};
}

/// Moves the evaluation point onto the surface until it hardly moves (or the fit is not stable, or
/// the next one would be undefined). The descriptor is that of the last evaluation point, except
/// that tau is the distance of the point itself to the last surface.
ExactScaleSpace::Fit ExactScaleSpace::project(std::uint32_t place, Fit fit, double t,
                                              const std::optional<double>& gate,
                                              Scratch& scratch) const {
  if (fit.status == FitStatus::kUndefined) return fit;
  Vec3 offset = Vec3::Zero();
  for (int step = 0; step < options_.max_projection_steps; ++step) {
    if (fit.status != FitStatus::kStable) break;
    const Vec3 move = projection_move(fit.surface);
    tree_.within_unsorted(positions_[place] + (offset + move), t, scratch.found);
    localise(scratch.found, place, offset + move, t, gate, scratch.projected);
    const Fit next = this->fit(scratch.projected, t);
    if (next.status == FitStatus::kUndefined) break;
    fit = next;
    offset += move;
    if (move.norm() < kSmallestMove * t) break;
  }
  fit.descriptor.tau = algebraic_distance(fit.surface, -offset);
  return fit;
}

template <typename Number>
void ExactScaleSpace::describe_point(std::uint32_t place, Scratch& scratch, std::span<Number> out,
                                     std::span<FitStatus> status) const {
  const auto width = static_cast<std::size_t>(feature_count(options_.features));
  std::array<double, 28> features;
  tree_.within_unsorted(positions_[place], scales_.back(), scratch.all);
  order_by_shell(scales_, scratch.all, scratch.unordered);
  std::fill(status.begin(), status.end(), FitStatus::kStable);
  for (std::size_t g = 0; g < gates_.size(); ++g) {
    localise(scratch.all, place, Vec3::Zero(), scales_.back(), gates_[g], scratch.neighbours);
    const std::span<const LocalNeighbour> neighbours = scratch.neighbours;
    std::size_t count = 0;
    for (std::size_t s = 0; s < scales_.size(); ++s) {
      const double t = scales_[s];
      while (count < neighbours.size() && neighbours[count].sq_distance() < t * t) ++count;
      Fit fit = this->fit(neighbours.first(count), t);
      if (projects(options_.reconstruction)) fit = project(place, fit, t, gates_[g], scratch);
      write_features(options_.features, fit.descriptor, t, features);
      const bool finite = store<Number>(std::span(features).first(width),
                                        out.subspan((s * gates_.size() + g) * width, width));
      status[s] = std::max(status[s], finite ? fit.status : FitStatus::kUndefined);
    }
  }
}

template <typename Number>
void ExactScaleSpace::describe_all(std::span<const std::uint32_t> targets, std::span<Number> out,
                                   std::span<FitStatus> status, const Progress* progress) const {
  const std::size_t scales = scales_.size();
  const auto width = static_cast<std::size_t>(column_count(options_));
  const std::size_t row = scales * width;
  check_room(targets.size(), scales, width, out.size(), status.size());
  const std::vector<Visit> visits = plan_visits(targets, place_);

  constexpr std::size_t kBlock = 64;
  Stage stage(progress, "describe", visits.size());
  parallel_blocks(visits.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    Scratch scratch;
    for (std::size_t v = begin; v < end; ++v) {
      const auto [place, i] = visits[v];
      const std::span<Number> features = out.subspan(i * row, row);
      const std::span<FitStatus> statuses = status.subspan(i * scales, scales);
      if (place == kNowhere) {
        std::fill(features.begin(), features.end(), Number(0));
        std::fill(statuses.begin(), statuses.end(), FitStatus::kUndefined);
      } else {
        describe_point(place, scratch, features, statuses);
      }
    }
    stage.advance(end - begin);
  });
}

void ExactScaleSpace::describe(std::span<const std::uint32_t> targets, std::span<float> out,
                               std::span<FitStatus> status, const Progress* progress) const {
  describe_all(targets, out, status, progress);
}

void ExactScaleSpace::describe(std::span<const std::uint32_t> targets, std::span<double> out,
                               std::span<FitStatus> status, const Progress* progress) const {
  describe_all(targets, out, status, progress);
}

}  // namespace pcednet::gls
