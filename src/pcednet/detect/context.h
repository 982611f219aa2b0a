#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/detect/classify.h"
#include "pcednet/spatial/neighbour_search.h"
#include "pcednet/spatial/places.h"

namespace pcednet::detect {

/// The numbers of nearest points that form the context of a point, size by size.
constexpr std::array<int, 4> kContextSizes = {4, 8, 16, 32};

/// The shape of the context network of a model with `classes` classes.
nn::Architecture context_architecture(int classes);

/// Numbers per size and kind of edge, see ContextMatrix.
constexpr int kContextFeatures = 8;

/// The places of a cloud's points that have a class, for ContextMatrix. Independent of a network's
/// predictions, and so made once for many networks.
class ContextPlaces {
 public:
  /// Points that `found` leaves unlabelled have no place. `curve` is the spatial::curve_order() of
  /// the positions.
  ContextPlaces(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
                const Classification& found);

  const spatial::Places& places() const { return places_; }
  const spatial::NeighbourSearch& search() const { return search_; }

 private:
  spatial::Places places_;
  spatial::NeighbourSearch search_;
};

/// A network's predictions around each point, the input of the context network: edges are lines and
/// bands, which the description of one point does not show.
///
/// Like the scale-space matrix, it has a row per point of sizes x features, smallest size first.
/// The kinds of edge are sharp-edge and, with three classes, any edge. For each kind, let p_j be
/// its probability at the k nearest places, of the surest point there, y_j their positions relative
/// to the point, r the distance of the last, w_j = 1 - |y_j|^2 / (1.2 r^2), c and C the mean and
/// covariance of the y_j / r with weights w_j p_j, and l1 >= l2 >= l3 the eigenvalues of C. The
/// features are
///
///     log(p / (1 - p)) of the point itself    S w p / S w    max p    |c|    sqrt(l1 + l2 + l3)
///     distance of the point from the line through c along C's first axis    sqrt(l1)
///     sqrt(l2 / l1)
///
/// p is clamped to [1e-6, 1 - 1e-6] in the log-odds; the divisor S w p of c and C gains 1e-3, l1 in
/// the last feature gains 1e-6. None depends on the cloud's units, place or orientation.
class ContextMatrix {
 public:
  /// `found` has a class for the points of `around`, which must outlive this.
  ContextMatrix(const ContextPlaces& around, const Classification& found, int classes,
                float least_edge = kLeastEdge);

  /// The points to describe: those with an edge probability of at least `least_edge` and no own
  /// class, in a cache-friendly order that does not depend on their numbering.
  std::span<const std::uint32_t> points() const { return points_; }

  /// Numbers per row.
  std::size_t width() const { return kContextSizes.size() * features(); }
  std::size_t features() const {
    return static_cast<std::size_t>(kContextFeatures) * static_cast<std::size_t>(kinds_);
  }

  /// Describes the points points()[begin] to points()[end] (exclusive), one row each.
  void describe(std::size_t begin, std::size_t end, std::span<float> rows) const;

 private:
  void describe_point(std::size_t place, const std::array<float, 2>& own,
                      std::span<const spatial::Neighbour> near, float* row) const;

  const ContextPlaces* around_;
  int kinds_;
  std::vector<std::array<float, 2>> probabilities_;  ///< by place, of sharp-edge and of any edge
  std::vector<std::uint32_t> points_, places_;       ///< to describe, and their places
  std::vector<std::array<float, 2>> own_;            ///< probabilities of these points
};

/// Replaces the predictions in `result` by those of the context network. `classes` are the
/// edge_outputs() of its model.
void apply_context(const nn::Model& network, const std::vector<std::uint8_t>& classes,
                   const ContextMatrix& matrix, Classification& result,
                   const Progress* progress = nullptr);

/// The same with the model's context network and the matrix of the predictions in `result`.
/// `positions` are those that were classified, `curve` their spatial::curve_order(). The result
/// does not depend on threads or on the order of the points.
void apply_context(const EdgeModel& model, std::span<const Vec3> positions,
                   std::span<const std::uint32_t> curve, Classification& result,
                   const Progress* progress = nullptr);

}  // namespace pcednet::detect
