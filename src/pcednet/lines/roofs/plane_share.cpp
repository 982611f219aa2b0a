#include "pcednet/lines/roofs/plane_share.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace pcednet::lines {
namespace {

constexpr double kLeastToTell = 8.0;       ///< points inside, to tell
constexpr double kFlat = 0.01;             ///< spacings: such faces are plane
constexpr double kMostBend = 0.1;          ///< share of their heights that a parabola explains,
constexpr double kByChance = 6.0;          ///< and more of few points, where chance does
constexpr double kFaceTurn = 0.35;         ///< radians from side to side of a plane face,
constexpr double kFaceTurnOfAngle = 0.33;  ///< and in the angle to the face it goes on in
constexpr double kLeastBeside = 3.0;       ///< pairs of points of faces that go on in each other
constexpr double kMostUndecided = 0.2;     ///< of all points
constexpr double kOwnAngle = 0.5;          ///< radians: of a plane face of few points

/// Heights of points over a plane, and the squares of their coordinates in it.
struct Bend {
  double count = 0.0, height = 0.0, sq_height = 0.0;
  Vec3 squares = Vec3::Zero(), both = Vec3::Zero();
  Mat3 products = Mat3::Zero();

  void add(double x, double y, double h) {
    const Vec3 square(x * x, x * y, y * y);
    count += 1.0;
    height += h;
    sq_height += h * h;
    squares += square;
    both += h * square;
    products += square * square.transpose();
  }
  double variance() const { return sq_height / count - (height / count) * (height / count); }
  Vec3 mean() const { return squares / count; }
  Vec3 with_height() const { return both / count - height / count * mean(); }
  /// The factors of x^2, xy, y^2 in the parabola of least squares.
  Vec3 parabola() const {
    const Mat3 covariance = products / count - mean() * mean().transpose();
    return covariance.ldlt().solve(with_height());
  }
  /// The share of the variance of heights that the parabola explains.
  double explained() const { return with_height().dot(parabola()) / variance(); }
  /// The largest angle by which the parabola turns from one side of the points to the other.
  double turn() const {
    const Vec3 factors = parabola();
    Eigen::Matrix2d bend, spread;
    bend << 2.0 * factors[0], factors[1], factors[1], 2.0 * factors[2];
    spread << mean()[0], mean()[1], mean()[1], mean()[2];
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
    solver.computeDirect(bend);
    double largest = 0.0;
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d along = solver.eigenvectors().col(i);
      const double width = std::sqrt(12.0 * along.dot(spread * along));  // of uniform points
      largest = std::max(largest, std::abs(solver.eigenvalues()[i]) * width);
    }
    return largest;
  }
};

/// The smallest angle of each face to one that it goes on in, without a step.
std::vector<double> smallest_angles(const OrderedPoints& cloud, const Faces& faces) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> contacts;
  faces.for_each_contact([&](std::uint32_t point, std::uint32_t other) {
    const std::uint32_t own = faces.of_points[point], face = faces.of_points[other];
    const double step = faces.faces[own].height(cloud.position(other));
    if (std::abs(step) < 2.0 * faces.within) contacts[std::minmax(own, face)] += 1.0;
  });
  std::vector<double> angles(faces.faces.size(), std::numbers::pi);
  for (const auto& [pair, count] : contacts) {
    if (count < kLeastBeside) continue;
    const double sine =
        faces.faces[pair.first].normal.cross(faces.faces[pair.second].normal).norm();
    const double angle = std::asin(std::min(1.0, sine));
    for (const std::uint32_t face : {pair.first, pair.second}) {
      angles[face] = std::min(angles[face], angle);
    }
  }
  return angles;
}

}  // namespace

double plane_share(const OrderedPoints& cloud, const Faces& faces, double spacing) {
  std::vector<Bend> bends(faces.faces.size());
  std::vector<std::pair<Vec3, Vec3>> axes;
  for (const Face& face : faces.faces) {
    const Vec3 x = face.normal.unitOrthogonal();
    axes.emplace_back(x, face.normal.cross(x));
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!faces.is_inside(i)) continue;  // it may be of the face beside
    const std::uint32_t f = faces.of_points[i];
    const Vec3 offset = (cloud.position(i) - faces.faces[f].point) / spacing;
    bends[f].add(axes[f].first.dot(offset), axes[f].second.dot(offset),
                 faces.faces[f].normal.dot(offset));
  }
  const std::vector<double> angles = smallest_angles(cloud, faces);
  double plane = 0.0, undecided = 0.0;
  for (std::size_t f = 0; f < bends.size(); ++f) {
    const Bend& bend = bends[f];
    const auto count = static_cast<double>(faces.faces[f].count);
    const bool is_curved = faces.faces[f].is_curved;
    if (is_curved && bend.count < kLeastToTell) {
      const bool is_own = angles[f] > kOwnAngle && angles[f] < std::numbers::pi;
      (is_own ? plane : undecided) += count;
    } else if (!is_curved || bend.variance() < kFlat * kFlat ||
               bend.explained() < kMostBend + kByChance / bend.count ||
               bend.turn() < std::min(kFaceTurn, kFaceTurnOfAngle * angles[f])) {
      plane += count;
    }
  }
  const auto all = static_cast<double>(cloud.size());
  return undecided < kMostUndecided * all ? plane / (all - undecided) : plane / all;
}

}  // namespace pcednet::lines
