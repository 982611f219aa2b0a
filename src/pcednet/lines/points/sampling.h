#pragma once

namespace pcednet::lines {

class OrderedPoints;

/// Spacing and noise of a cloud, from points off its edges; from all points if all are on edges.
/// Where points at edges are much sparser than others, as in a scan from close by, theirs.
struct Sampling {
  double spacing = 0.0;  ///< sqrt of the area per point, median
  /// Of points about the plane of their neighbours, in spacings; of scans that are not aligned,
  /// about a surface between them.
  double noise = 0.0;
  bool oriented = true;  ///< the normals of neighbours have like signs
  bool exact = false;    ///< drawn, not measured: a few points on a plane or circle are no accident
};

/// Noise, in spacings, above which other rules apply to wedges, pieces and their ends.
constexpr double kMuchNoise = 0.2;

/// Exact points have less noise, in spacings.
constexpr double kExactNoise = 0.005;

/// How far points may be from the segment or arc of their edge by default, in spacings.
constexpr double usual_tolerance(double noise) {
  return 0.2 + 0.4 * noise;
}

Sampling measure_sampling(const OrderedPoints& cloud);

}  // namespace pcednet::lines
