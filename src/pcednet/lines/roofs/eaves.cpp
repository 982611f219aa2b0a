#include "pcednet/lines/roofs/eaves.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "pcednet/core/parallel.h"
#include "pcednet/lines/curves/support_line.h"
#include "pcednet/lines/points/chart.h"
#include "pcednet/lines/roofs/outline.h"
#include "pcednet/lines/roofs/outline_parts.h"
#include "pcednet/lines/roofs/rectangle.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kEavesAtOnce = 16;

// In spacings.
constexpr double kDisc = 2.5;    ///< radius that rolls around a face
constexpr double kByFold = 1.3;  ///< of outline points from a fold: it ends the face there
constexpr double kLeastLength = 2.0;
constexpr double kHalfMet = 0.5;    ///< of a point of no face from the plane beside it
constexpr double kLongFold = 5.0;   ///< that gives its direction to outlines
constexpr double kLongEave = 16.0;  ///< that gives its direction to openings
constexpr double kCoverAhead = 1.2, kCoverReach = 1.0, kCoverHeight = 0.7;

constexpr double kWall = 0.2;         ///< sine of the angle of a normal to the ground
constexpr double kAlongPlane = 0.05;  ///< sine of a direction to a plane that it is taken to be in
constexpr double kTowards = 0.6;      ///< cosine between the ways out of a face and to a fold
constexpr double kSameLine = 0.8;     ///< cosine of directions that are tried
constexpr double kSameDirection = 1e-3;  ///< sine times cosine between those that are noted once
constexpr double kEmptyArea = 0.8;  ///< beyond the last points along a line, in squared spacings

constexpr double kRowDepth = 2.0;    ///< behind an eave, spacings, where rows are looked for
constexpr double kBeyondRow = 0.25;  ///< of an eave from its last row, in gaps between rows

using Vec2 = Eigen::Vector2d;

Chart chart_of(const Face& face) {
  return {face.point, face.normal};
}

/// A straight part of the outline of a face.
struct Eave {
  std::uint32_t face;
  std::vector<Vec2> points;
  SupportLine line;
  bool settled;  ///< its direction is known

  double length() const {
    return line.to_corner[0] + (points.back() - points.front()).norm() + line.to_corner[1];
  }
};

/// The place of the face straight above or below: a beam that meets an eave half knows where it is
/// in plan, not how high. Of walls, the nearest one.
Vec3 dropped(const Face& face, const Vec3& place) {
  const double up = face.normal.z();
  if (std::abs(up) < kWall) return place;
  return place - face.height(place) / up * Vec3::UnitZ();
}

/// The only face beside a point of none, if it is near: a beam that meets an eave half is above it.
std::uint32_t face_beside(const OrderedPoints& cloud, const Faces& faces, std::uint32_t point,
                          double spacing) {
  std::uint32_t beside = kNoFace;
  for (const std::uint32_t other : faces.near(point)) {
    const std::uint32_t face = faces.of_points[other];
    if (face == kNoFace || face == beside) continue;
    if (beside != kNoFace) return kNoFace;
    beside = face;
  }
  if (beside == kNoFace) return kNoFace;
  const double off = std::abs(faces.faces[beside].height(cloud.position(point)));
  return off < kHalfMet * spacing ? beside : kNoFace;
}

/// The points of each face, and those beside it that its eaves have.
std::vector<std::vector<std::uint32_t>> points_of(const OrderedPoints& cloud, const Faces& faces,
                                                  double spacing) {
  std::vector<std::vector<std::uint32_t>> points(faces.faces.size());
  for (std::uint32_t i = 0; i < faces.of_points.size(); ++i) {
    const std::uint32_t own = faces.of_points[i];
    const std::uint32_t face = own != kNoFace ? own : face_beside(cloud, faces, i, spacing);
    if (face != kNoFace) points[face].push_back(i);
  }
  return points;
}

/// The last points along so long an edge are this far from it.
double beyond_last(double length, double spacing) {
  return kEmptyArea * spacing * spacing / std::max(length, spacing);
}

ChainNode edge_node(const Vec3& at, const Vec3& along, const Vec3& inward, double spacing) {
  return {.at = at,
          .along = along,
          .side_a = inward,
          .side_b = inward,
          .spacing = spacing,
          .edge_points = 1.0,
          .probability = 1.0,
          .boundary = 1.0};
}

Piece edge_of(const SupportArc& arc, const Face& face, double spacing) {
  const Chart chart = chart_of(face);
  const double sense = arc.hollow ? -1.0 : 1.0;
  const double radius = arc.radius + sense * beyond_last(arc.length(), spacing);
  Piece piece;
  for (const Vec2& point : arc.points) {
    const Vec2 outward = (point - arc.centre).stableNormalized();
    piece.nodes.push_back(edge_node(chart.place(arc.centre + radius * outward),
                                    chart.direction(sense * Vec2(-outward.y(), outward.x())),
                                    chart.direction(-sense * outward), spacing));
  }
  piece.fit = {CurveKind::kArc, chart.place(arc.centre), sense * face.normal, radius, 0.0};
  piece.ends = {piece.nodes.front().at, piece.nodes.back().at};
  piece.closed = arc.closed;
  return piece;
}

/// As straight_parts() counts it.
double cost_of(const std::vector<SupportLine>& lines, const std::vector<SupportArc>& arcs) {
  double cost = 0.0;
  for (const SupportLine& line : lines) cost += kLinePrice + line.empty;
  for (const SupportArc& arc : arcs) cost += kArcPrice + arc.empty;
  return cost;
}

class Outlines {
 public:
  Outlines(const OrderedPoints& cloud, const Faces& faces, const Sampling& sampling,
           const std::vector<Fold>& folds, const spatial::KdTree& plan);

  void add(std::uint32_t face, const std::vector<std::uint32_t>& points, const Progress* progress);
  std::vector<Eave> found;
  std::vector<Piece> arcs;
  std::vector<std::vector<Vec2>> charted;  ///< the points of each face

 private:
  bool is_at_fold(std::uint32_t face, const Vec3& place, const Vec3& outward) const;
  bool is_foot(std::uint32_t face, const Vec3& place, const Vec3& outward) const;
  void add_chain(std::uint32_t face, const std::vector<Vec2>& chain,
                 const std::vector<bool>& taken);
  void add_run(std::uint32_t face, std::vector<Vec2> run);
  void note_direction(const Eave& eave);

  const OrderedPoints& cloud_;
  const Faces& faces_;
  double spacing_, noise_;
  struct FoldSide {
    const Piece* fold;
    Vec3 inward;  ///< into the face
  };
  std::vector<std::vector<FoldSide>> folds_of_;  ///< of each face
  std::vector<Vec2>
      directions_;  ///< of the long eaves of a face, less those along and across others
  const spatial::KdTree& plan_;
};

Outlines::Outlines(const OrderedPoints& cloud, const Faces& faces, const Sampling& sampling,
                   const std::vector<Fold>& folds, const spatial::KdTree& plan)
    : charted(faces.faces.size()),
      cloud_(cloud),
      faces_(faces),
      spacing_(sampling.spacing),
      noise_(sampling.noise),
      folds_of_(faces.faces.size()),
      plan_(plan) {
  for (const Fold& fold : folds) {
    folds_of_[fold.face].push_back({&fold.piece, fold.piece.middle().side_a});
    folds_of_[fold.other].push_back({&fold.piece, fold.piece.middle().side_b});
  }
}

/// Whether the face ends at a fold in this direction.
bool Outlines::is_at_fold(std::uint32_t face, const Vec3& place, const Vec3& outward) const {
  return std::any_of(folds_of_[face].begin(), folds_of_[face].end(), [&](const FoldSide& side) {
    if (outward.dot(side.inward) > -kTowards) return false;
    const Piece* fold = side.fold;
    const Vec3 offset = place - fold->ends[0];
    const Vec3 along = fold->ends[1] - fold->ends[0];
    const double part = std::clamp(offset.dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (offset - part * along).norm() < kByFold * spacing_;
  });
}

/// Whether another face begins above the place: it is at the foot of a step.
bool Outlines::is_foot(std::uint32_t face, const Vec3& place, const Vec3& outward) const {
  const Vec3 ahead = in_plan(outward);
  if (ahead.norm() < kWall) return false;
  std::vector<spatial::Neighbour> near;
  plan_.within_unsorted(in_plan(place) + kCoverAhead * spacing_ * ahead.normalized(),
                        kCoverReach * spacing_, near);
  return std::any_of(near.begin(), near.end(), [&](const spatial::Neighbour& other) {
    return faces_.of_points[other.index] != face &&
           cloud_.position(other.index).z() > place.z() + kCoverHeight * spacing_;
  });
}

/// The parts of a chain that are not taken. It is a loop; without taken points it begins at a
/// corner: at its point farthest from the middle.
void Outlines::add_chain(std::uint32_t face, const std::vector<Vec2>& chain,
                         const std::vector<bool>& taken) {
  const std::size_t count = chain.size();
  if (count == 0) return;
  Vec2 middle = Vec2::Zero();
  for (const Vec2& at : chain) middle += at / static_cast<double>(count);
  std::size_t start = 0;
  double farthest = -1.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double away =
        taken[i] ? std::numeric_limits<double>::max() : (chain[i] - middle).squaredNorm();
    if (away > farthest) farthest = away, start = i;
  }
  std::vector<Vec2> run;
  for (std::size_t k = 0; k <= count; ++k) {
    const std::size_t i = (start + k) % count;
    if (!taken[i]) run.push_back(chain[i]);
    if ((taken[i] || k == count) && !run.empty()) add_run(face, std::exchange(run, {}));
  }
}

void Outlines::note_direction(const Eave& eave) {
  if (eave.length() <= kLongEave * spacing_) return;
  const Vec2 along = eave.line.along();
  const bool is_known = std::any_of(directions_.begin(), directions_.end(), [&](const Vec2& known) {
    const double cosine = known.dot(along), sine = known.x() * along.y() - known.y() * along.x();
    return std::abs(cosine * sine) < kSameDirection;
  });
  if (!is_known) directions_.push_back(along);
}

void Outlines::add_run(std::uint32_t face, std::vector<Vec2> run) {
  std::vector<SupportLine> lines = straight_parts(run, spacing_, noise_);
  drop_cut_corners(lines, run, charted[face], kDisc * spacing_, spacing_);
  std::vector<SupportArc> round_parts = take_round_parts(lines, run, spacing_);
  bool settled = false;
  if (run.front() == run.back()) {
    const double cost = cost_of(lines, round_parts);
    if (auto sides = rectangular_opening(run, cost, directions_, spacing_)) {
      lines = *std::move(sides);
      round_parts.clear();
      settled = true;
    }
  }
  for (const SupportArc& arc : round_parts) {
    arcs.push_back(edge_of(arc, faces_.faces[face], spacing_));
  }
  for (const SupportLine& line : lines) {
    const auto begin = run.begin();
    Eave eave{face,
              {begin + static_cast<std::ptrdiff_t>(line.first),
               begin + static_cast<std::ptrdiff_t>(line.last) + 1},
              line,
              settled};
    eave.line.last -= eave.line.first;
    eave.line.first = 0;
    if (eave.length() <= kLeastLength * spacing_) continue;
    note_direction(eave);
    found.push_back(std::move(eave));
  }
}

void Outlines::add(std::uint32_t face, const std::vector<std::uint32_t>& points,
                   const Progress* progress) {
  const Chart chart = chart_of(faces_.faces[face]);
  std::vector<Vec2>& flat = charted[face];
  directions_.clear();
  for (const std::uint32_t point : points) {
    flat.push_back(chart.flat(dropped(faces_.faces[face], cloud_.position(point))));
  }
  std::vector<std::vector<OutlinePoint>> loops = outlines(flat, kDisc * spacing_);
  // The longest first: its directions are those of openings.
  std::stable_sort(loops.begin(), loops.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  for (const auto& outline : loops) {
    throw_if_cancelled(progress);
    std::vector<Vec2> chain;
    std::vector<bool> taken;
    for (const OutlinePoint& point : outline) {
      const Vec3 place = chart.place(flat[point.index]);
      chain.push_back(flat[point.index]);
      const Vec3 outward = chart.direction(point.outward);
      taken.push_back(is_at_fold(face, place, outward) || is_foot(face, place, outward));
    }
    add_chain(face, chain, taken);
  }
}

/// The best line of a direction parallel or orthogonal to one of `directions`, if there is one.
SupportLine aligned(const Eave& eave, const Face& face, const std::vector<Vec3>& directions,
                    double spacing) {
  const Chart chart = chart_of(face);
  std::optional<SupportLine> best;
  double least = kSameLine;
  for (const Vec3& direction : directions) {
    for (const bool crosswise : {false, true}) {
      if (!crosswise && std::abs(direction.dot(face.normal)) > kAlongPlane) continue;
      const Vec3 own = crosswise ? Vec3(face.normal.cross(direction)) : direction;
      if (own.norm() < 0.2) continue;
      const Vec2 along = chart.turned(own).normalized();
      const double cosine = along.dot(eave.line.along());
      if (std::abs(cosine) < least) continue;
      const Vec2 normal = std::copysign(1.0, cosine) * Vec2(along.y(), -along.x());
      const auto line = turned(eave.line, normal, eave.points, spacing);
      if (line) best = line, least = std::abs(cosine);
    }
  }
  return best.value_or(eave.line);
}

/// Turns outlines in the directions of folds, and of longer outlines, where points allow it.
void align(std::vector<Eave>& eaves, const Faces& faces, double spacing,
           const std::vector<Fold>& folds) {
  std::vector<Vec3> directions;
  for (const Fold& fold : folds) {
    if (length_of(fold.piece) > kLongFold * spacing) directions.push_back(fold.piece.fit.direction);
  }
  std::stable_sort(eaves.begin(), eaves.end(),
                   [](const Eave& a, const Eave& b) { return a.length() > b.length(); });
  for (Eave& eave : eaves) {
    const Face& face = faces.faces[eave.face];
    if (!eave.settled) eave.line = aligned(eave, face, directions, spacing);
    directions.push_back(chart_of(face).direction(eave.line.along()));
  }
}

/// The widest gap between the depths of points from the eave on: rows along it are so far apart.
/// Points beyond it are of the other side of an opening, or of a wing.
double row_gap(const Eave& eave, const std::vector<Vec2>& points, double spacing) {
  const Vec2 along = eave.line.along();
  const double from = std::min(along.dot(eave.points.front()), along.dot(eave.points.back()));
  const double to = std::max(along.dot(eave.points.front()), along.dot(eave.points.back()));
  std::vector<double> depths = {0.0};  // of the point on its line
  for (const Vec2& point : points) {
    const double depth = eave.line.offset - eave.line.normal.dot(point), at = along.dot(point);
    const bool behind = depth > 0.0 && depth < kRowDepth * spacing;
    if (behind && at >= from && at <= to) depths.push_back(depth);
  }
  std::sort(depths.begin(), depths.end());
  double widest = 0.0;
  for (std::size_t i = 1; i < depths.size(); ++i) {
    widest = std::max(widest, depths[i] - depths[i - 1]);
  }
  return widest;
}

Piece edge_of(const Eave& eave, const Faces& faces, const std::vector<Vec2>& points,
              double spacing) {
  const Chart chart = chart_of(faces.faces[eave.face]);
  const double beyond =
      std::max(beyond_last(eave.length(), spacing), kBeyondRow * row_gap(eave, points, spacing));
  const double offset = eave.line.offset + beyond;
  const Vec3 along = chart.direction(eave.line.along());
  const Vec3 inward = -chart.direction(eave.line.normal);
  Piece piece;
  for (const Vec2& point : eave.points) {
    const Vec2 on = point + (offset - eave.line.normal.dot(point)) * eave.line.normal;
    piece.nodes.push_back(edge_node(chart.place(on), along, inward, spacing));
  }
  piece.fit = {CurveKind::kSegment, piece.nodes.front().at, along, 0.0, 0.0};
  piece.ends = {piece.nodes.front().at - eave.line.to_corner[0] * along,
                piece.nodes.back().at + eave.line.to_corner[1] * along};
  return piece;
}

}  // namespace

std::vector<Piece> find_eaves(const OrderedPoints& cloud, const Faces& faces,
                              const Sampling& sampling, const std::vector<Fold>& folds,
                              const spatial::KdTree& plan, const Progress* progress) {
  const double spacing = sampling.spacing;
  Outlines outlines(cloud, faces, sampling, folds, plan);
  const auto points = points_of(cloud, faces, spacing);
  for (std::uint32_t f = 0; f < points.size(); ++f) outlines.add(f, points[f], progress);
  const std::vector<Eave>& eaves = outlines.found;
  align(outlines.found, faces, spacing, folds);
  std::vector<Piece> straight(eaves.size());
  Stage stage(progress, "eaves", eaves.size());
  parallel_blocks(eaves.size(), kEavesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      straight[i] = edge_of(eaves[i], faces, outlines.charted[eaves[i].face], spacing);
    }
    stage.advance(end - begin);
  });
  std::vector<Piece> edges = std::move(outlines.arcs);
  append(edges, std::move(straight));
  return edges;
}

}  // namespace pcednet::lines
