#include "pcednet/lines/roofs/parallel_folds.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcednet/core/vec3.h"

namespace pcednet::lines {
namespace {

constexpr double kLeastBetween = 10.0;                  ///< points before, between and after folds
constexpr double kLeastStrip = 2.2;                     ///< spacings that they cover across
constexpr int kFoldDirections = 24, kFoldOffsets = 24;  ///< of folds that are tried
constexpr double kLeastFoldSine = 0.115;
// Folds must leave less than each of these, by this many variances of the noise.
constexpr double kThanPlane = 40.0, kThanParabola = 4.0, kThanOneFold = 12.0;

/// A point: 1, its place across the folds and along them, its height.
using PointRow = Eigen::Vector4d;
using Products = Eigen::Matrix4d;
using Terms = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 5, 1>;
using TermProducts = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 5, 5>;

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

}  // namespace

int ParallelFolds::strip_of(const PlacedPoint& point) const {
  const double across = std::cos(direction) * point.x + std::sin(direction) * point.y;
  int strip = 0;
  for (int k = 0; k < count; ++k) strip += across > offsets[static_cast<std::size_t>(k)] ? 1 : 0;
  return strip;
}

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

}  // namespace pcednet::lines
