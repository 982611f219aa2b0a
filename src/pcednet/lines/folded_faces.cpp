#include "pcednet/lines/folded_faces.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace pcednet::lines {
namespace {

constexpr std::size_t kLeastInside = 30;  ///< points inside a face, to tell
constexpr double kLeastBetween = 10.0;    ///< points inside before, between and after folds
constexpr double kLeastStrip = 2.2;       ///< spacings that they cover across
constexpr double kOffCentre = 0.45;  ///< of the neighbours of a point inside, in their distances
constexpr double kLowSine = 0.35;    ///< of folds whose place the growth of faces hardly sees
constexpr std::size_t kLeastFoldContacts = 10;
constexpr double kAsGood = 1.05;  ///< sums of squares, of a fold
constexpr std::size_t kSamples = 500;
constexpr int kFoldDirections = 24, kFoldOffsets = 24;  ///< of folds that are tried
constexpr double kLeastFoldSine = 0.115;
// Folds must leave less than these by so many variances of the noise.
constexpr double kThanPlane = 40.0, kThanParabola = 4.0, kThanOneFold = 12.0;

/// Of a point: 1, its place across the folds and along them, its height.
using PointRow = Eigen::Vector4d;
using Products = Eigen::Matrix4d;
using Terms = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 5, 1>;
using TermProducts = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 5, 5>;

/// Parallel lines across a face, and what planes between them, which meet there, leave.
struct ParallelFolds {
  double direction = 0.0;  ///< across them, radians
  int count = 0;
  std::array<double, 2> offsets = {};  ///< ascending
  double least_sine = 0.0;             ///< of their angles
  double left = 0.0;                   ///< sum of squares

  int strip_of(const PlacedPoint& point) const {
    const double across = std::cos(direction) * point.x + std::sin(direction) * point.y;
    int strip = 0;
    for (int k = 0; k < count; ++k) strip += across > offsets[static_cast<std::size_t>(k)] ? 1 : 0;
    return strip;
  }
};

/// Fits folds in one direction, at any of some offsets. The hinge at an offset is the distance of a
/// point beyond it, or 0.
class FoldFits {
 public:
  FoldFits(std::span<const PlacedPoint> points, double direction) : direction_(direction) {
    const double x = std::cos(direction), y = std::sin(direction);
    const auto row_of = [&](const PlacedPoint& p) -> PointRow {
      return {1.0, x * p.x + y * p.y, x * p.y - y * p.x, p.height};
    };
    for (const PlacedPoint& p : points) {
      first_ = std::min(first_, row_of(p)[1]), last_ = std::max(last_, row_of(p)[1]);
    }
    beyond_.fill(Products::Zero());
    const double per_length = last_ > first_ ? kFoldOffsets / (last_ - first_) : 0.0;
    for (const PlacedPoint& p : points) {
      const PointRow row = row_of(p);
      const auto bin = static_cast<int>((row[1] - first_) * per_length);
      beyond_[static_cast<std::size_t>(std::clamp(bin, 0, kFoldOffsets - 1))] +=
          row * row.transpose();
    }
    for (std::size_t k = kFoldOffsets - 1; k-- > 0;) beyond_[k] += beyond_[k + 1];
  }

  double offset(int k) const { return first_ + k * (last_ - first_) / kFoldOffsets; }

  /// With folds at the offsets of these numbers, ascending.
  std::optional<ParallelFolds> fit(std::span<const int> folds) const {
    if (!has_strips(folds)) return std::nullopt;
    const auto terms = static_cast<Eigen::Index>(3 + folds.size());
    TermProducts products(terms, terms);
    Terms with_height(terms);
    products.topLeftCorner<3, 3>() = beyond_[0].topLeftCorner<3, 3>();
    with_height.head<3>() = beyond_[0].col(3).head<3>();
    for (std::size_t i = 0; i < folds.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(3 + i);
      const PointRow hinge = with_hinge(folds[i]);
      products.col(at).head<3>() = hinge.head<3>();
      products.row(at).head<3>() = hinge.head<3>().transpose();
      with_height[at] = hinge[3];
      for (std::size_t j = 0; j <= i; ++j) {
        const auto other = static_cast<Eigen::Index>(3 + j);
        products(at, other) = products(other, at) = hinge[1] - offset(folds[j]) * hinge[0];
      }
    }
    const Terms factors = products.ldlt().solve(with_height);
    ParallelFolds result = {.direction = direction_, .count = static_cast<int>(folds.size())};
    result.left = std::max(0.0, beyond_[0](3, 3) - with_height.dot(factors));
    result.least_sine = 1.0;
    double slope = factors[1];
    for (std::size_t i = 0; i < folds.size(); ++i) {
      const Vec3 before(-slope, -factors[2], 1.0);
      slope += factors[static_cast<Eigen::Index>(3 + i)];
      const Vec3 after(-slope, -factors[2], 1.0);
      result.offsets[i] = offset(folds[i]);
      result.least_sine =
          std::min(result.least_sine, before.normalized().cross(after.normalized()).norm());
    }
    return result;
  }

 private:
  const Products& beyond(int k) const { return beyond_[static_cast<std::size_t>(k)]; }
  /// The products of the hinge at an offset with a row.
  PointRow with_hinge(int k) const { return beyond(k).col(1) - offset(k) * beyond(k).col(0); }
  bool has_strips(std::span<const int> folds) const {
    double points = beyond_[0](0, 0), from = first_;
    for (const int k : folds) {
      const double rest = beyond(k)(0, 0);
      if (points - rest < kLeastBetween || offset(k) - from < kLeastStrip) return false;
      points = rest, from = offset(k);
    }
    return points >= kLeastBetween && last_ - from >= kLeastStrip;
  }

  double direction_, first_ = 0.0, last_ = 0.0;
  std::array<Products, kFoldOffsets> beyond_;  ///< sums over the points beyond each offset
};

/// One fold and two parallel ones that leave least.
std::array<std::optional<ParallelFolds>, 2> best_folds(std::span<const PlacedPoint> points) {
  std::array<std::optional<ParallelFolds>, 2> best;
  for (int d = 0; d < kFoldDirections; ++d) {
    const FoldFits fits(points, d * std::numbers::pi / kFoldDirections);
    const auto consider = [&](std::span<const int> folds) {
      const auto found = fits.fit(folds);
      auto& so_far = best[folds.size() - 1];
      if (found && (!so_far || found->left < so_far->left)) so_far = found;
    };
    for (int k = 1; k < kFoldOffsets; ++k) {
      consider(std::array{k});
      for (int next = k + 1; next < kFoldOffsets; ++next) consider(std::array{k, next});
    }
  }
  return best;
}

/// The sums of squares that a plane and a parabola leave.
std::array<double, 2> left_by_plane_and_parabola(std::span<const PlacedPoint> points) {
  using Powers = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> products = Eigen::Matrix<double, 6, 6>::Zero();
  Powers with_height = Powers::Zero();
  double sq_height = 0.0;
  for (const PlacedPoint& p : points) {
    Powers row;
    row << 1.0, p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y;
    products += row * row.transpose();
    with_height += p.height * row;
    sq_height += p.height * p.height;
  }
  const Vec3 plane = products.topLeftCorner<3, 3>().ldlt().solve(with_height.head<3>());
  const Powers parabola = products.ldlt().solve(with_height);
  return {sq_height - with_height.head<3>().dot(plane), sq_height - with_height.dot(parabola)};
}

struct Explanation {
  std::optional<ParallelFolds> folds = {};  ///< if they explain the face best
  bool is_curved = true;                    ///< unless folds leave less than a parabola
};

Explanation explain(std::span<const PlacedPoint> points) {
  const auto count = static_cast<double>(points.size());
  const auto [plane, parabola] = left_by_plane_and_parabola(points);
  const auto [one, two] = best_folds(points);
  if (!one) return {};
  const ParallelFolds& folds =
      two && one->left - two->left > kThanOneFold * two->left / count ? *two : *one;
  const double noise = folds.left / count;
  const bool is_folded = folds.least_sine > kLeastFoldSine &&
                         plane - folds.left > kThanPlane * noise &&
                         parabola - folds.left > kThanParabola * noise;
  return {is_folded ? std::optional(folds) : std::nullopt, parabola < folds.left};
}

/// Coordinates in the plane of a face, in spacings.
class FaceFrame {
 public:
  FaceFrame(const Face& face, double spacing)
      : face_(face),
        x_(face.normal.unitOrthogonal()),
        y_(face.normal.cross(x_)),
        spacing_(spacing) {}
  PlacedPoint operator()(const Vec3& place) const {
    const Vec3 offset = (place - face_.point) / spacing_;
    return {x_.dot(offset), y_.dot(offset), face_.normal.dot(offset)};
  }

 private:
  Face face_;
  Vec3 x_, y_;
  double spacing_;
};

/// Whether a point has others on every side. At an eave, beams that meet it half return heights
/// that are too low.
bool is_surrounded(const OrderedPoints& cloud, const Faces& faces, std::uint32_t point) {
  Vec3 sum = Vec3::Zero();
  double distances = 0.0;
  for (const std::uint32_t other : faces.near(point)) {
    const Vec3 offset = cloud.position(other) - cloud.position(point);
    sum += offset;
    distances += offset.norm();
  }
  return sum.norm() < kOffCentre * distances;
}

/// The points of some faces.
struct FacePoints {
  std::vector<std::uint32_t> all, inside;  ///< inside: the nearest others are of these faces, too
};

FacePoints points_of(const OrderedPoints& cloud, const Faces& faces,
                     std::span<const std::uint32_t> some) {
  const auto is_theirs = [&](std::uint32_t point) {
    return std::find(some.begin(), some.end(), faces.of_points[point]) != some.end();
  };
  FacePoints points;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (!is_theirs(i)) continue;
    points.all.push_back(i);
    const auto nearest = faces.nearest(i);
    if (std::all_of(nearest.begin(), nearest.end(), is_theirs) && is_surrounded(cloud, faces, i)) {
      points.inside.push_back(i);
    }
  }
  return points;
}

std::vector<PlacedPoint> samples_of(const OrderedPoints& cloud,
                                    const std::vector<std::uint32_t>& points,
                                    const FaceFrame& frame) {
  std::vector<PlacedPoint> samples;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSamples);
  for (std::size_t k = 0; k < points.size(); k += step) {
    samples.push_back(frame(cloud.position(points[k])));
  }
  return samples;
}

bool divide(const OrderedPoints& cloud, double spacing, std::uint32_t face,
            const FacePoints& points, Faces& faces) {
  const FaceFrame frame(faces.faces[face], spacing);
  const std::vector<PlacedPoint> samples = samples_of(cloud, points.inside, frame);
  if (samples.size() < kLeastInside) return false;
  const Explanation explanation = explain(samples);
  faces.faces[face].is_curved = explanation.is_curved;
  if (!explanation.folds) return false;
  const auto first = static_cast<std::uint32_t>(faces.faces.size());
  faces.faces[face].is_curved = false;
  for (int k = 0; k < explanation.folds->count; ++k) faces.faces.push_back(faces.faces[face]);
  for (const std::uint32_t i : points.all) {
    const int strip = explanation.folds->strip_of(frame(cloud.position(i)));
    if (strip > 0) faces.of_points[i] = first + static_cast<std::uint32_t>(strip) - 1;
  }
  return true;
}

/// Divides the points of two faces anew, at one fold.
bool straighten(const OrderedPoints& cloud, double spacing, std::uint32_t a, std::uint32_t b,
                Faces& faces) {
  const FacePoints points = points_of(cloud, faces, std::array{a, b});
  const FaceFrame frame(faces.faces[a], spacing);
  const std::vector<PlacedPoint> samples = samples_of(cloud, points.inside, frame);
  if (samples.size() < kLeastInside) return false;
  double sq_heights = 0.0;
  const std::size_t step = std::max<std::size_t>(1, points.inside.size() / kSamples);
  for (std::size_t k = 0; k < points.inside.size(); k += step) {
    const std::uint32_t i = points.inside[k];
    const double height = faces.faces[faces.of_points[i]].height(cloud.position(i)) / spacing;
    sq_heights += height * height;
  }
  const auto folds = explain(samples).folds;
  if (!folds || folds->count != 1 || folds->left > kAsGood * sq_heights) return false;
  double beyond[2] = {};  // the places of both faces, summed, across the fold
  for (const std::uint32_t i : points.all) {
    const PlacedPoint place = frame(cloud.position(i));
    beyond[faces.of_points[i] == b] += folds->strip_of(place) > 0 ? 1.0 : -1.0;
  }
  const std::uint32_t before = beyond[0] <= beyond[1] ? a : b, after = before == a ? b : a;
  bool moves = false;
  for (const std::uint32_t i : points.all) {
    const std::uint32_t face = folds->strip_of(frame(cloud.position(i))) > 0 ? after : before;
    moves = moves || faces.of_points[i] != face;
    faces.of_points[i] = face;
  }
  return moves;
}

}  // namespace

bool divide_folded(const OrderedPoints& cloud, double spacing, Faces& faces) {
  const auto count = static_cast<std::uint32_t>(faces.faces.size());
  std::vector<FacePoints> points;  // before any is divided
  for (std::uint32_t f = 0; f < count; ++f) {
    points.push_back(points_of(cloud, faces, std::array{f}));
  }
  bool any = false;
  for (std::uint32_t f = 0; f < count; ++f) {
    any = divide(cloud, spacing, f, points[f], faces) || any;
  }
  return any;
}

bool straighten_folds(const OrderedPoints& cloud, double spacing, Faces& faces) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> contacts;
  faces.for_each_contact([&](std::uint32_t point, std::uint32_t other) {
    ++contacts[std::minmax(faces.of_points[point], faces.of_points[other])];
  });
  bool any = false;
  for (const auto& [pair, count] : contacts) {
    const auto [a, b] = pair;
    const double sine = faces.faces[a].normal.cross(faces.faces[b].normal).norm();
    if (count < kLeastFoldContacts || sine > kLowSine) continue;
    any = straighten(cloud, spacing, a, b, faces) || any;
  }
  return any;
}

}  // namespace pcednet::lines
