#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/lines/curves/curve.h"

namespace pcednet::eval {

/// The frame in which lines are compared: positions become (p - centre) / scale, in [-1, 1]. The
/// scale is positive.
struct LineFrame {
  Vec3 centre = Vec3::Zero();
  double scale = 1.0;
};

/// Centre: the mean of the cloud; scale: the largest absolute coordinate about it. Ignores
/// positions that are not finite. Throws Error(kInsufficient) if all finite ones coincide.
LineFrame frame_of_cloud(std::span<const Vec3> positions);

/// Without a cloud: the centre of the curves' box and half its longest side. Throws
/// Error(kInsufficient) if there are no curves.
LineFrame frame_of_curves(std::span<const lines::Curve> curves);

/// How well lines match true curves; see docs/lines.md. Lengths are those of the frame. Values
/// undefined without lines are NaN.
struct LineScores {
  std::size_t lines = 0, true_curves = 0;
  double chamfer = 0.0;         ///< CD: mean squared distances both ways, added
  double hausdorff = 0.0;       ///< HD: the mean of the largest distances both ways
  double fine_precision = 0.0;  ///< share of the lines' length nearer than .01 to a true curve
  double fine_recall = 0.0;     ///< share of the true length nearer than .01 to a line
  double precision = 0.0;       ///< the same within .02
  double recall = 0.0;
  double found = 0.0;  ///< share of true curves of which one line covers 80 % within .02
  double pieces =
      0.0;  ///< lines nearest to a fifth or more of a true curve, mean over those with any
  double corners = 0.0;  ///< F1 of ends and bends over 30 degrees, within .03
};

/// Throws Error(kInsufficient) if there are no true curves, or if a curve is ten thousand times the
/// frame in size.
LineScores score_lines(std::span<const lines::Curve> found, std::span<const lines::Curve> truth,
                       const LineFrame& frame);

/// The scores of one cloud.
struct NamedLineScores {
  std::string name;
  LineScores scores;
};

/// {"clouds":[{"name","lines","true_curves","cd",...,"corners"}],"median":{...},"mean":{...}},
/// indented, with a final newline; null for NaN, which medians and means leave out. Bytes of names
/// that are not UTF-8 become U+FFFD.
std::string to_json(const std::vector<NamedLineScores>& clouds);

/// A text table: a row per cloud, then median and mean.
std::string to_table(const std::vector<NamedLineScores>& clouds);

}  // namespace pcednet::eval
