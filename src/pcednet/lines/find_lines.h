#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/lines/curves/curve.h"
#include "pcednet/lines/points/edge_points.h"

namespace pcednet::lines {

/// The steps of find_lines(), each of which can be returned.
enum class LineStage : std::uint8_t {
  kCreases,  ///< a segment of one spacing for each point that may be on an edge
  kChains,   ///< creases in order along edges, as polylines
  kPieces,   ///< segments, arcs and circles, before they meet in corners
  kCurves,   ///< the result
};

/// Their names in options.
inline constexpr std::array<std::pair<std::string_view, LineStage>, 4> kLineStages = {
    {{"creases", LineStage::kCreases},
     {"chains", LineStage::kChains},
     {"pieces", LineStage::kPieces},
     {"curves", LineStage::kCurves}}};

/// Lengths are in the unit of the cloud; those that are 0 come from the spacing of the points.
struct LineOptions {
  double min_length = 0.0;  ///< shorter curves are left out; 0: 3 spacings
  double gap = 0.0;         ///< edge points are joined over gaps up to it; 0: 6 spacings
  double angle = 30.0;  ///< degrees, above 0, up to 180: curves are split where they bend by more
  double tolerance = 0.0;   ///< distance of points to a curve; 0: 0.2 spacings, more with noise
  bool regularise = false;  ///< makes nearly parallel and nearly orthogonal segments exactly so
  bool boundaries = false;  ///< also lines where the sampled surface ends
  LineStage stage = LineStage::kCurves;  ///< the step whose curves are returned
};

/// What was measured of the cloud, what lengths the options came to, in its unit, and what these
/// left out.
struct LineScale {
  double spacing = 0.0;  ///< the side of the square that holds one point, median
  double noise = 0.0;    ///< of points about the plane of their neighbours, in spacings
  double min_length = 0.0, gap = 0.0, tolerance = 0.0;
  std::size_t too_short = 0;  ///< curves left out for their length
};

/// The edges of the cloud as curves that share their corners.
///
/// 1. A crease is fitted beside every edge point: where the planes of two surfaces meet.
/// 2. Creases that continue each other are ordered into chains.
/// 3. A chain is split into the few segments and arcs that explain it.
/// 4. Curves are extended to the corners in which they meet.
///
/// With boundaries, the lines of a roof come from its planes instead. Gap, angle and tolerance are
/// not used there, and every stage but the last returns its pieces.
///
/// Fills in `scale`, if given. The result is the same for any number of threads and any order of
/// the points. Throws Error(kUsage) if an option is negative or not finite, if the angle is 0 or
/// above 180, if the spans differ in length, if the curve lacks a point or has one twice, or if a
/// probability is not in [0, 1].
std::vector<Curve> find_lines(const EdgePoints& points, const LineOptions& options = {},
                              const Progress* progress = nullptr, LineScale* scale = nullptr);

}  // namespace pcednet::lines
