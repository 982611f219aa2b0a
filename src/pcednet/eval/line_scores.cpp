#include "pcednet/eval/line_scores.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <unordered_set>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/core/median.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::eval {
namespace {

constexpr double kStep = 0.01;  // between samples, at most
constexpr double kFine = 0.01, kNear = 0.02, kCorner = 0.03;
constexpr double kFoundShare = 0.8, kPieceShare = 0.2;
constexpr double kBend = 30.0 / 180.0 * std::numbers::pi;
constexpr double kSamePlace = 1e-6;

/// Curves in the frame: vertices, and the middles of equal steps along each.
struct Samples {
  std::vector<std::vector<Vec3>> vertices;  ///< the first again at the end of a closed curve
  std::vector<Vec3> positions;
  std::vector<double> lengths;       ///< of the steps
  std::vector<std::uint32_t> curve;  ///< of each sample
  std::vector<std::size_t> first;    ///< sample of each curve, and their number
};

double length_of(const std::vector<Vec3>& vertices) {
  double length = 0.0;
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    length += (vertices[i] - vertices[i - 1]).norm();
  }
  return length;
}

/// The middles of `steps` steps from the first vertex to the last.
std::vector<Vec3> middles_along(const std::vector<Vec3>& vertices, double step, std::size_t steps) {
  std::vector<Vec3> middles;
  std::size_t piece = 1;
  double begin = 0.0;  // of the piece
  for (std::size_t i = 0; i < steps; ++i) {
    const double place = (static_cast<double>(i) + 0.5) * step;
    const auto length = [&] { return (vertices[piece] - vertices[piece - 1]).norm(); };
    for (; piece + 1 < vertices.size() && begin + length() < place; ++piece) begin += length();
    const double t = length() > 0.0 ? std::clamp((place - begin) / length(), 0.0, 1.0) : 0.0;
    middles.push_back(vertices[piece - 1] + t * (vertices[piece] - vertices[piece - 1]));
  }
  return middles;
}

/// Throws for curves so large that their samples would fill the memory.
void check_size(std::span<const lines::Curve> curves, const LineFrame& frame) {
  constexpr double kMost = 1e4;
  for (const lines::Curve& curve : curves) {
    double size = curve.closed ? curve.radius : 0.0;
    for (const Vec3& p : curve.points) {
      size = std::max(size, (p - frame.centre).cwiseAbs().maxCoeff());
    }
    if (size <= kMost * frame.scale) continue;
    throw Error(ErrorKind::kInsufficient,
                fmt::format("a curve reaches {:.3g}, the cloud {:.3g}: they are not of one place "
                            "and unit",
                            size, frame.scale));
  }
}

Samples sample(std::span<const lines::Curve> curves, const LineFrame& frame) {
  constexpr double kTolerance = 1e-5;
  check_size(curves, frame);
  Samples samples;
  samples.first.push_back(0);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    auto& vertices = samples.vertices.emplace_back();
    for (const Vec3& p : lines::sampled(curves[i], kTolerance * frame.scale)) {
      vertices.push_back((p - frame.centre) / frame.scale);
    }
    const double length = length_of(vertices);
    const auto steps =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(length / kStep)));
    const double step = length / static_cast<double>(steps);
    const std::vector<Vec3> middles = middles_along(vertices, step, steps);
    samples.positions.insert(samples.positions.end(), middles.begin(), middles.end());
    samples.lengths.insert(samples.lengths.end(), steps, step);
    samples.curve.insert(samples.curve.end(), steps, static_cast<std::uint32_t>(i));
    samples.first.push_back(samples.positions.size());
  }
  return samples;
}

/// The distances of samples to the others.
struct Distances {
  double mean_square = 0.0, largest = 0.0;
  double fine_share = 0.0, near_share = 0.0;  ///< of the length
};

Distances measure(const Samples& from, const spatial::KdTree& to) {
  Distances result;
  double length = 0.0;
  std::vector<spatial::Neighbour> nearest;
  for (std::size_t i = 0; i < from.positions.size(); ++i) {
    to.nearest(from.positions[i], 1, nearest);
    const double sq = nearest.front().sq_distance;
    length += from.lengths[i];
    result.mean_square += from.lengths[i] * sq;
    result.largest = std::max(result.largest, std::sqrt(sq));
    if (sq < kFine * kFine) result.fine_share += from.lengths[i];
    if (sq < kNear * kNear) result.near_share += from.lengths[i];
  }
  for (double* sum : {&result.mean_square, &result.fine_share, &result.near_share}) *sum /= length;
  return result;
}

using Counts = std::map<std::uint32_t, std::size_t>;  // of samples, by line

/// The samples of one true curve that are near a line, and those to which none is nearer. A line
/// along a neighbouring edge is not a piece of this one; a line and its copy are two.
struct Coverage {
  Counts near, nearest;
};

Coverage coverage_of(const Samples& truth, std::size_t curve, const Samples& found,
                     const spatial::KdTree& tree) {
  Coverage coverage;
  std::vector<spatial::Neighbour> near;
  for (std::size_t i = truth.first[curve]; i < truth.first[curve + 1]; ++i) {
    tree.within(truth.positions[i], kNear, near);  // the nearest first
    std::unordered_set<std::uint32_t> seen;
    for (const auto& neighbour : near) {
      const std::uint32_t line = found.curve[neighbour.index];
      if (!seen.insert(line).second) continue;
      ++coverage.near[line];
      const double least = std::sqrt(near.front().sq_distance);
      if (std::sqrt(neighbour.sq_distance) < least + kSamePlace) ++coverage.nearest[line];
    }
  }
  return coverage;
}

/// Counts the true curves that one line covers, and the lines that form each.
void count_pieces(const Samples& found, const spatial::KdTree& tree, const Samples& truth,
                  LineScores& scores) {
  std::size_t whole = 0, touched = 0, pieces = 0;
  for (std::size_t curve = 0; curve < truth.vertices.size(); ++curve) {
    const Coverage coverage = coverage_of(truth, curve, found, tree);
    const auto samples = static_cast<double>(truth.first[curve + 1] - truth.first[curve]);
    const auto lines_above = [&](const Counts& counts, double share) {
      return std::count_if(counts.begin(), counts.end(), [&](const auto& entry) {
        return static_cast<double>(entry.second) >= share * samples;
      });
    };
    const auto count = lines_above(coverage.nearest, kPieceShare);
    whole += lines_above(coverage.near, kFoundShare) > 0;
    touched += count > 0;
    pieces += static_cast<std::size_t>(count);
  }
  scores.found = static_cast<double>(whole) / static_cast<double>(truth.vertices.size());
  scores.pieces = touched > 0 ? static_cast<double>(pieces) / static_cast<double>(touched)
                              : std::numeric_limits<double>::quiet_NaN();
}

double turn(const Vec3& before, const Vec3& after) {
  return std::atan2(before.cross(after).norm(), before.dot(after));
}

/// Ends and bends; those at one place count once.
std::vector<Vec3> corners_of(const Samples& samples) {
  std::vector<Vec3> all;
  for (const std::vector<Vec3>& line : samples.vertices) {
    std::vector<Vec3> vertices = {line.front()};
    for (const Vec3& p : line) {
      if ((p - vertices.back()).norm() > 1e-12) vertices.push_back(p);
    }
    const bool closed = (vertices.front() - vertices.back()).norm() < 1e-9;
    if (!closed) all.insert(all.end(), {vertices.front(), vertices.back()});
    const std::size_t n = vertices.size();
    for (std::size_t i = 1; i + 1 < n; ++i) {
      if (turn(vertices[i] - vertices[i - 1], vertices[i + 1] - vertices[i]) > kBend) {
        all.push_back(vertices[i]);
      }
    }
    if (closed && n > 2 &&
        turn(vertices[n - 1] - vertices[n - 2], vertices[1] - vertices[0]) > kBend)
      all.push_back(vertices[0]);
  }
  const spatial::KdTree tree(all);
  std::vector<bool> dropped(all.size());
  std::vector<spatial::Neighbour> same;
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (dropped[i]) continue;
    corners.push_back(all[i]);
    tree.within_unsorted(all[i], kSamePlace, same);
    for (const auto& other : same) dropped[other.index] = true;
  }
  return corners;
}

double share_near(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  const spatial::KdTree tree(to);
  std::vector<spatial::Neighbour> nearest;
  std::size_t near = 0;
  for (const Vec3& p : from) {
    tree.nearest(p, 1, nearest);
    near += !nearest.empty() && nearest.front().sq_distance < kCorner * kCorner;
  }
  return static_cast<double>(near) / static_cast<double>(from.size());
}

/// 1 if neither has corners, as with circles.
double corner_f1(const std::vector<Vec3>& found, const std::vector<Vec3>& truth) {
  if (found.empty() && truth.empty()) return 1.0;
  if (found.empty() || truth.empty()) return 0.0;
  const double precision = share_near(found, truth), recall = share_near(truth, found);
  return precision + recall > 0.0 ? 2.0 * precision * recall / (precision + recall) : 0.0;
}

struct Column {
  const char* heading;
  const char* key;
  double LineScores::*score;
  int digits;
};

constexpr std::array<Column, 9> kColumns = {
    {{"CD", "cd", &LineScores::chamfer, 4},
     {"HD", "hd", &LineScores::hausdorff, 3},
     {"P .01", "precision_01", &LineScores::fine_precision, 3},
     {"R .01", "recall_01", &LineScores::fine_recall, 3},
     {"P .02", "precision_02", &LineScores::precision, 3},
     {"R .02", "recall_02", &LineScores::recall, 3},
     {"found", "found", &LineScores::found, 3},
     {"pieces", "pieces", &LineScores::pieces, 2},
     {"corners", "corners", &LineScores::corners, 3}}};

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// A score over all clouds, NaN if none has it.
LineScores over(const std::vector<NamedLineScores>& clouds,
                double (*summary)(const std::vector<double>&)) {
  LineScores result;
  for (const Column& column : kColumns) {
    std::vector<double> values;
    for (const NamedLineScores& cloud : clouds) {
      const double value = cloud.scores.*column.score;
      if (!std::isnan(value)) values.push_back(value);
    }
    result.*column.score = values.empty() ? std::nan("") : summary(values);
  }
  return result;
}

double middle(const std::vector<double>& values) {
  return median(values);
}

void put(OrderedJson& row, const LineScores& scores) {
  for (const Column& column : kColumns) {
    const double value = scores.*column.score;
    row[column.key] = std::isnan(value) ? OrderedJson(nullptr) : OrderedJson(value);
  }
}

std::string table_row(const std::string& name, const std::string& lines, const std::string& curves,
                      const LineScores& scores) {
  std::string row = fmt::format("{:<24} {:>6} {:>6}", name, lines, curves);
  for (const Column& column : kColumns) {
    const double value = scores.*column.score;
    row += std::isnan(value) ? fmt::format(" {:>7}", "-")
                             : fmt::format(" {:>7.{}f}", value, column.digits);
  }
  return row + "\n";
}

}  // namespace

LineFrame frame_of_cloud(std::span<const Vec3> positions) {
  Vec3 sum = Vec3::Zero();
  std::size_t count = 0;
  for (const Vec3& p : positions) {
    if (!p.allFinite()) continue;
    sum += p;
    ++count;
  }
  if (count == 0) throw Error(ErrorKind::kInsufficient, "the cloud has no points");
  LineFrame frame = {sum / static_cast<double>(count), 0.0};
  for (const Vec3& p : positions) {
    if (p.allFinite()) {
      frame.scale = std::max(frame.scale, (p - frame.centre).cwiseAbs().maxCoeff());
    }
  }
  if (!(frame.scale > 0.0)) {
    throw Error(ErrorKind::kInsufficient, "all points of the cloud are at one place");
  }
  return frame;
}

LineFrame frame_of_curves(std::span<const lines::Curve> curves) {
  if (curves.empty()) throw Error(ErrorKind::kInsufficient, "there are no true curves");
  BoundingBox box;
  for (const lines::Curve& curve : curves) {
    const double tolerance = curve.radius > 0.0 ? 1e-4 * curve.radius : 1.0;
    for (const Vec3& p : lines::sampled(curve, tolerance)) box.add(p);
  }
  return {0.5 * (box.min + box.max), 0.5 * (box.max - box.min).maxCoeff()};
}

LineScores score_lines(std::span<const lines::Curve> found, std::span<const lines::Curve> truth,
                       const LineFrame& frame) {
  if (truth.empty()) throw Error(ErrorKind::kInsufficient, "there are no true curves");
  LineScores scores;
  scores.lines = found.size();
  scores.true_curves = truth.size();
  if (found.empty()) {
    scores.chamfer = scores.hausdorff = scores.pieces = std::numeric_limits<double>::quiet_NaN();
    return scores;
  }
  const Samples lines = sample(found, frame), curves = sample(truth, frame);
  const spatial::KdTree line_tree(lines.positions), curve_tree(curves.positions);
  const Distances out = measure(lines, curve_tree), back = measure(curves, line_tree);
  scores.chamfer = out.mean_square + back.mean_square;
  scores.hausdorff = 0.5 * (out.largest + back.largest);
  scores.fine_precision = out.fine_share;
  scores.fine_recall = back.fine_share;
  scores.precision = out.near_share;
  scores.recall = back.near_share;
  count_pieces(lines, line_tree, curves, scores);
  scores.corners = corner_f1(corners_of(lines), corners_of(curves));
  return scores;
}

std::string to_json(const std::vector<NamedLineScores>& clouds) {
  OrderedJson report;
  report["clouds"] = OrderedJson::array();
  for (const auto& [name, scores] : clouds) {
    OrderedJson row;
    row["name"] = name;
    row["lines"] = scores.lines;
    row["true_curves"] = scores.true_curves;
    put(row, scores);
    report["clouds"].push_back(row);
  }
  put(report["median"] = OrderedJson::object(), over(clouds, middle));
  put(report["mean"] = OrderedJson::object(), over(clouds, mean));
  return to_text(report, 2, NotUtf8::kReplace) + "\n";
}

std::string to_table(const std::vector<NamedLineScores>& clouds) {
  std::string table = fmt::format("{:<24} {:>6} {:>6}", "cloud", "lines", "true");
  for (const Column& column : kColumns) table += fmt::format(" {:>7}", column.heading);
  table += "\n";
  for (const auto& [name, scores] : clouds) {
    table +=
        table_row(name, std::to_string(scores.lines), std::to_string(scores.true_curves), scores);
  }
  table += table_row("median", "", "", over(clouds, middle));
  return table + table_row("mean", "", "", over(clouds, mean));
}

}  // namespace pcednet::eval
