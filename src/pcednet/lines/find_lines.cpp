#include "pcednet/lines/find_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/parallel_loops.h"
#include "pcednet/lines/creases/boundary.h"
#include "pcednet/lines/creases/crease.h"
#include "pcednet/lines/curves/chain.h"
#include "pcednet/lines/curves/split.h"
#include "pcednet/lines/exact/apexes.h"
#include "pcednet/lines/exact/edges.h"
#include "pcednet/lines/pieces/bores.h"
#include "pcednet/lines/pieces/bridge.h"
#include "pcednet/lines/pieces/circles.h"
#include "pcednet/lines/pieces/coaxial.h"
#include "pcednet/lines/pieces/extent.h"
#include "pcednet/lines/pieces/finish.h"
#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/pieces/refine.h"
#include "pcednet/lines/pieces/regularise.h"
#include "pcednet/lines/pieces/rounding.h"
#include "pcednet/lines/pieces/smooth_joints.h"
#include "pcednet/lines/pieces/strings.h"
#include "pcednet/lines/pieces/virtual_edges.h"
#include "pcednet/lines/points/ordered_points.h"
#include "pcednet/lines/points/sampling.h"
#include "pcednet/lines/roofs/plane_edges.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kLeastNodes = 2;
constexpr std::size_t kManyParts = std::numeric_limits<std::size_t>::max();
constexpr double kRoundWithin = 6.5;  ///< tolerances from the curves round a circle to it

/// The options, and what they are where the spacing decides.
struct Limits {
  double gap, min_exact, min_length;  ///< in the unit of the cloud
  double tolerance, smooth_within;    ///< in spacings
  double angle;                       ///< radians
};

Limits limits_of(const LineOptions& options, const Sampling& sampling) {
  const auto given = [](double value, double otherwise) { return value > 0.0 ? value : otherwise; };
  return {.gap = given(options.gap, 6.0 * sampling.spacing),
          .min_exact = given(options.min_length, sampling.spacing),
          .min_length = given(options.min_length, 3.0 * sampling.spacing),
          .tolerance = given(options.tolerance / sampling.spacing, usual_tolerance(sampling.noise)),
          .smooth_within = 1.5 + 2.0 * sampling.noise,
          .angle = options.angle * std::numbers::pi / 180.0};
}

LineScale scale_of(const Sampling& sampling, const Limits& limits) {
  return {sampling.spacing, sampling.noise, limits.min_length, limits.gap,
          limits.tolerance * sampling.spacing};
}

/// Throws unless the curve, if known, has every finite point once.
void check_curve(const EdgePoints& points) {
  if (points.curve.empty()) return;
  const auto finite = [&](std::size_t i) { return points.positions[i].allFinite(); };
  const std::size_t count = count_where(points.positions.size(), finite);
  std::vector<char> seen(points.positions.size());
  const bool is_once = std::all_of(points.curve.begin(), points.curve.end(), [&](std::uint32_t i) {
    return i < seen.size() && finite(i) && !std::exchange(seen[i], 1);
  });
  if (is_once && points.curve.size() == count) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("the curve is not of the {} points with a finite position", count));
}

void check(const EdgePoints& points, const LineOptions& options) {
  for (const double number : {options.min_length, options.gap, options.angle, options.tolerance}) {
    if (!(number >= 0.0) || !std::isfinite(number)) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("{} is neither a length nor an angle: it must be 0 or more", number));
    }
  }
  if (!(options.angle > 0.0 && options.angle <= 180.0)) {
    throw Error(ErrorKind::kUsage,
                fmt::format("the angle {} is not above 0, up to 180 degrees", options.angle));
  }
  const std::size_t count = points.positions.size();
  const auto fits = [&](std::size_t size) { return size == count; };
  const bool sound = fits(points.normals.size()) && fits(points.classes.size()) &&
                     (points.p_sharp.empty() || fits(points.p_sharp.size())) &&
                     (points.p_smooth.empty() || fits(points.p_smooth.size())) &&
                     (points.partial.empty() || fits(points.partial.size())) &&
                     (points.scanners.empty() || fits(points.scanners.size()));
  if (!sound) {
    throw Error(ErrorKind::kUsage,
                "positions, normals, classes and probabilities differ in number");
  }
  check_curve(points);
  for (const std::span<const float> probabilities : {points.p_sharp, points.p_smooth}) {
    for (const float p : probabilities) {
      if (p >= 0.0f && p <= 1.0f) continue;
      throw Error(ErrorKind::kUsage, fmt::format("the probability {} is not in [0, 1]", p));
    }
  }
}

template <typename Each>
std::vector<Each> both(std::vector<Each> these, const std::vector<Each>& those) {
  these.insert(these.end(), those.begin(), those.end());
  return these;
}

/// Moves those of which `is_such` is true to a list of their own.
template <typename Each, typename Test>
std::vector<Each> take(std::vector<Each>& all, const Test& is_such) {
  const auto such = std::stable_partition(all.begin(), all.end(),
                                          [&](const Each& each) { return !is_such(each); });
  std::vector<Each> taken(std::make_move_iterator(such), std::make_move_iterator(all.end()));
  all.erase(such, all.end());
  return taken;
}

/// The chains of three kinds of creases: at edges, on rounded surfaces, at boundaries. None is of
/// two.
std::vector<Chain> make_chains(std::span<const Crease> creases, std::span<const Crease> boundaries,
                               const Limits& limits, double noise, const Progress* progress) {
  Stage smoothing(progress, "smooth creases", creases.size() + boundaries.size());
  std::vector<Crease> smooth = smoothed(creases, limits.smooth_within, smoothing);
  const std::vector<Crease> rounded = take(smooth, [](const Crease& c) { return c.rounded; });
  const std::vector<Crease> smooth_boundaries =
      smoothed(boundaries, limits.smooth_within, smoothing);
  Stage tracing(progress, "chains", creases.size() + boundaries.size());
  const auto traced = [&](std::span<const Crease> of_a_kind) {
    return trace(of_a_kind, limits.gap, noise, tracing);
  };
  return both(both(traced(smooth), traced(rounded)), traced(smooth_boundaries));
}

std::vector<Piece> split_chains(const std::vector<Chain>& chains, double tolerance,
                                const Progress* progress) {
  std::vector<std::vector<Piece>> of_chains(chains.size());
  Stage stage(progress, "segments and arcs", chains.size());
  parallel_blocks(chains.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Chain& chain = chains[i];
      const double within = tolerance_at(chain.nodes[chain.nodes.size() / 2], tolerance);
      of_chains[i] = pieces_of(chain, split(chain, within, progress), kLeastNodes);
    }
    stage.advance(end - begin);
  });
  std::vector<Piece> pieces;
  for (std::vector<Piece>& of_chain : of_chains) {
    for (Piece& piece : of_chain) pieces.push_back(std::move(piece));
  }
  return pieces;
}

/// Makes one piece of those that are of one edge.
void join(std::vector<Piece>& pieces, const OrderedPoints& cloud, const Limits& limits,
          double noise, const Progress* progress) {
  Stage stage(progress, "joins", 5);
  join_pieces(pieces, limits.gap, limits.tolerance, progress);
  stage.advance();
  complete_circles(pieces, cloud, limits.tolerance);
  complete_coaxial(pieces, cloud, limits.tolerance);
  drop_beside_exact(pieces);
  stage.advance();
  bridge_gaps(pieces, cloud, limits.tolerance, noise);
  stage.advance();
  string_together(pieces, limits.gap, limits.angle);
  divide_strings(pieces, limits.tolerance, noise > kMuchNoise ? 1 : kManyParts, progress);
  stage.advance();
  complete_coaxial(pieces, cloud, limits.tolerance);
  stage.advance();
}

std::vector<Curve> drawn(const std::vector<Crease>& creases) {
  std::vector<Curve> curves;
  for (const Crease& crease : creases) {
    const Vec3 half = 0.5 * crease.spacing * crease.along;
    curves.push_back({.kind = CurveKind::kSegment,
                      .edge_class = crease.edge_class == kNonEdge ? kSmoothEdge : crease.edge_class,
                      .points = {crease.at - half, crease.at + half},
                      .confidence = crease.probability,
                      .dihedral_angle = dihedral_angle(crease.side_a, crease.side_b),
                      .support = 1});
  }
  return curves;
}

std::vector<Curve> drawn(std::span<const Piece> pieces, const FinishOptions& options) {
  std::vector<Curve> curves;
  for (const Piece& piece : pieces) curves.push_back(curve_of(piece, options));
  return curves;
}

/// The chains and exact edges as polylines.
std::vector<Piece> unsplit(const std::vector<Chain>& chains, const ExactEdges& exact) {
  constexpr CurveKind kAsItIs = CurveKind::kPolyline;
  std::vector<Piece> pieces = both(exact.pieces, exact.rounded);
  for (Piece& piece : pieces) piece.fit.kind = kAsItIs;
  for (const Chain& chain : chains) {
    if (chain.nodes.size() < kLeastNodes) continue;
    pieces.push_back({.fit = {.kind = kAsItIs},
                      .nodes = chain.nodes,
                      .ends = {chain.nodes.front().at, chain.nodes.back().at},
                      .closed = chain.closed});
  }
  return pieces;
}

std::vector<Curve> long_ones(std::vector<Curve> curves, const Limits& limits, LineScale* scale) {
  const std::size_t too_short = std::erase_if(curves, [&](const Curve& curve) {
    return !(length_of(curve) >= (curve.exact ? limits.min_exact : limits.min_length));
  });
  if (scale) scale->too_short = too_short;
  return curves;
}

/// Makes one piece of those that are of one edge, and moves each to where the points say.
void place_pieces(std::vector<Piece>& pieces, const OrderedPoints& cloud, const Sampling& sampling,
                  const Limits& limits, const Progress* progress) {
  join(pieces, cloud, limits, sampling.noise, progress);
  refine(pieces, cloud, sampling, progress);
  drop_virtual_edges(pieces);
  round_corners(pieces, cloud, limits.tolerance);
  extend_free_ends(pieces, cloud, sampling.noise);
  if (sampling.noise > kMuchNoise) {
    string_free_ends(pieces, limits.gap, limits.angle, sampling.noise);
    divide_strings(pieces, limits.tolerance, 1, progress);
  }
  find_bores(pieces, cloud, sampling, progress);
}

/// The curves of the pieces, which meet in corners, and of fillets.
std::vector<Curve> curves_of(std::vector<Piece> pieces, std::vector<Piece> rounded,
                             const FinishOptions& options, const Limits& limits, double spacing,
                             const Progress* progress) {
  Stage stage(progress, "corners", 3);
  // Smooth edges do not share corners with the others.
  std::vector<Piece> smooth = take(
      pieces, [&](const Piece& piece) { return class_of(piece, options.noise) == kSmoothEdge; });
  append(smooth, std::move(rounded));
  std::vector<Curve> curves = finish(std::move(pieces), options);
  stage.advance();
  curves = both(std::move(curves), finish(std::move(smooth), options));
  stage.advance();
  close_round_loops(curves, spacing, kRoundWithin * limits.tolerance * spacing);
  join_smooth_corners(curves, limits.angle, limits.tolerance, spacing);
  stage.advance();
  return curves;
}

std::vector<Curve> lines_of(const OrderedPoints& cloud, bool is_whole, const LineOptions& options,
                            const Progress* progress, LineScale* scale) {
  const Sampling sampling = measure_sampling(cloud);
  const Limits limits = limits_of(options, sampling);
  if (scale) *scale = scale_of(sampling, limits);
  if (options.boundaries && is_whole) {
    if (auto pieces = find_plane_edges(cloud, sampling, progress)) {
      if (options.regularise) regularise(*pieces);
      const FinishOptions of_planes = {limits.tolerance, 0.0, true};
      if (options.stage != LineStage::kCurves) return drawn(std::span(*pieces), of_planes);
      return long_ones(finish(std::move(*pieces), of_planes), limits, scale);
    }
  }
  std::vector<Crease> creases = find_creases(cloud, sampling, progress), boundaries;
  if (options.boundaries) boundaries = find_boundaries(cloud, progress);
  if (options.stage == LineStage::kCreases) return drawn(both(creases, boundaries));
  ExactEdges exact;
  if (sampling.exact) {
    exact = find_exact_edges(cloud, sampling.spacing, progress);
    keep_labelled(exact, cloud);
    drop_exact_copies(exact.pieces);
    erase_explained(creases, exact);
    erase_on_cones(creases, cloud, sampling.spacing);
  }
  const FinishOptions finish_options = {limits.tolerance, sampling.noise};
  const std::vector<Chain> chains =
      make_chains(creases, boundaries, limits, sampling.noise, progress);
  if (options.stage == LineStage::kChains) return drawn(unsplit(chains, exact), finish_options);
  std::vector<Piece> pieces = split_chains(chains, limits.tolerance, progress);
  append(pieces, std::move(exact.pieces));
  if (!pieces.empty()) place_pieces(pieces, cloud, sampling, limits, progress);
  if (options.regularise) regularise(pieces);
  if (options.stage == LineStage::kPieces) {
    append(pieces, std::move(exact.rounded));
    return drawn(std::span(pieces), finish_options);
  }
  std::vector<Curve> curves = curves_of(std::move(pieces), std::move(exact.rounded), finish_options,
                                        limits, sampling.spacing, progress);
  return long_ones(std::move(curves), limits, scale);
}

}  // namespace

std::vector<Curve> find_lines(const EdgePoints& points, const LineOptions& options,
                              const Progress* progress, LineScale* scale) {
  check(points, options);
  EdgePoints along = points;
  std::vector<std::uint32_t> order;
  if (points.curve.empty()) along.curve = order = spatial::curve_order(points.positions);
  // Seen from a point in its midst, curves do not depend on where the cloud lies.
  const Vec3 origin = along.curve.empty() ? Vec3(Vec3::Zero())
                                          : points.positions[along.curve[along.curve.size() / 2]];
  std::vector<Curve> curves =
      lines_of(OrderedPoints(along, origin), points.partial.empty(), options, progress, scale);
  for (Curve& curve : curves) {
    for (Vec3& point : curve.points) point += origin;
    if (curve.radius > 0.0) curve.centre += origin;
  }
  return curves;
}

}  // namespace pcednet::lines
