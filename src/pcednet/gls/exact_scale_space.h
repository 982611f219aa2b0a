#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/gls/fit_status.h"
#include "pcednet/gls/neighbourhood.h"
#include "pcednet/gls/oriented_points.h"
#include "pcednet/gls/scales.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::gls {

/// The scale-space matrix of a cloud, evaluated from exact neighbourhoods in double precision.
///
/// Made once for a cloud, then asked for any of its points. The neighbourhood of a point at scale t
/// is every point closer than t, itself included, except points whose normal is unusable (or whose
/// gate is closed): these are not counted. All results are the same bits for any numbering of the
/// points and any number of threads, and never NaN or infinite.
class ExactScaleSpace {
 public:
  /// Copies what it needs of `points`. Throws as check() does, and Error(kInsufficient) for clouds
  /// without a range of scales (see scale_range()).
  ExactScaleSpace(OrientedPoints points, const ScaleSpaceOptions& options,
                  const Progress* progress = nullptr);

  const ScaleSpaceOptions& options() const { return options_; }

  /// The support radii, smallest first; of several octaves, those of the first, or those of the one
  /// taken since.
  const std::vector<double>& scales() const { return scales_; }
  const ScaleRange& range() const { return range_; }

  /// Changes to the scales of an octave, below the octave_count() of the range. Not while others
  /// describe.
  void take_octave(std::size_t octave);

  /// The finite points along a curve: targets may come in any order, but this one makes the best
  /// use of the caches.
  std::span<const std::uint32_t> order() const { return order_; }

  /// Describes the points numbered `targets`, on all threads. `out` is targets x scales x
  /// column_count() numbers, `status` targets x scales; with two gates a status is the worse of
  /// both. A point that is not finite is undefined at
  /// every scale; so is a description beyond the range of float. May be called from many threads.
  /// Throws Error(kUsage) if a target or a size is wrong.
  void describe(std::span<const std::uint32_t> targets, std::span<float> out,
                std::span<FitStatus> status, const Progress* progress = nullptr) const;
  void describe(std::span<const std::uint32_t> targets, std::span<double> out,
                std::span<FitStatus> status, const Progress* progress = nullptr) const;

 private:
  struct Fit;
  struct Scratch;

  void localise(std::span<const spatial::Neighbour> found, std::uint32_t place, const Vec3& offset,
                double radius, const std::optional<double>& gate, Neighbourhood& neighbours) const;
  Fit fit(std::span<const LocalNeighbour> neighbours, double t) const;
  Fit project(std::uint32_t place, Fit fit, double t, const std::optional<double>& gate,
              Scratch& scratch) const;
  template <typename Number>
  void describe_point(std::uint32_t place, Scratch& scratch, std::span<Number> out,
                      std::span<FitStatus> status) const;
  template <typename Number>
  void describe_all(std::span<const std::uint32_t> targets, std::span<Number> out,
                    std::span<FitStatus> status, const Progress* progress) const;

  ScaleSpaceOptions options_;
  std::vector<std::optional<double>> gates_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> place_;  ///< of each point in the arrays below, or kNowhere
  std::vector<Vec3> positions_;  ///< the finite points, in an order independent of their numbering
  std::vector<Vec3> normals_;    ///< (0,0,0) where unusable
  spatial::KdTree tree_;
  ScaleRange range_;
  std::vector<double> scales_;
};

}  // namespace pcednet::gls
