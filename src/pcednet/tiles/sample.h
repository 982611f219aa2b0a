#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/gls/scales.h"
#include "pcednet/tiles/layout.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// Finite positions chosen at random from a stream, or all if they are few: those with the smallest
/// random numbers, which depend only on a point's index in the stream.
class Sample {
 public:
  explicit Sample(std::size_t most) : most_(most) {}

  void add(std::span<const Vec3> positions);

  /// The positions along a curve; call it once, last.
  std::vector<Vec3> take();

  std::size_t seen() const { return seen_; }
  /// Whether nothing was left out.
  bool is_all() const { return seen_ <= most_; }

 private:
  void keep_smallest();

  std::size_t most_, seen_ = 0;
  std::uint64_t limit_ = UINT64_MAX;  ///< larger numbers need not be kept
  std::vector<std::pair<std::uint64_t, Vec3>> chosen_ = {};
};

struct SampledPoints {
  std::span<const Vec3> positions;          ///< in curve order
  bool is_all = false;                      ///< there are no others near them
  std::span<const BoundingBox> inner = {};  ///< unless empty, the spacing is measured in these
};

/// The spacing of the points of a cloud.
struct Spacing {
  gls::ScaleRange range;
  // From the mean distances to the 10 nearest others:
  double median = 0.0;
  double wide = 0.0;  ///< exceeded by one in a thousand
};

/// Reads every point once.
void stream_points(const Plan& plan, const char* stage, const Progress* progress,
                   const std::function<void(std::span<const Vec3>)>& see);

/// The spacings and range of scales, the latter as gls::scale_range() computes it for a cloud in
/// memory: from 16384 positions at equal steps along the curve, with the mean distances to their 10
/// nearest others in the whole cloud. Where the sample is not all there is near it, the positions
/// are taken from it, and all inputs are read once for the distances; every position goes into
/// `counts` then. Rounded positions are spread before, as the plan decides.
Spacing find_spacing(const SampledPoints& sample, const Plan& plan, const gls::ScaleRange& given,
                     CellCounts& counts, const Progress* progress);

}  // namespace pcednet::tiles
