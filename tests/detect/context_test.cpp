#include "pcednet/detect/context.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

/// Points with the answers of a network.
struct Answered {
  std::vector<Vec3> positions;
  Classification found;

  void add(const Vec3& position, float p_sharp, float p_smooth) {
    positions.push_back(position);
    found.p_sharp.push_back(p_sharp);
    found.p_smooth.push_back(p_smooth);
    found.classes.push_back(kNonEdge);
  }
};

Answered random_answers(std::size_t points) {
  Random random(5);
  Answered answered;
  for (std::size_t i = 0; i < points; ++i) {
    const auto p = static_cast<float>(random.uniform());
    answered.add({random.uniform(), random.uniform(), 0.1 * random.uniform()}, 0.6f * p, 0.3f * p);
  }
  return answered;
}

/// A row per point, zeros where there is none.
std::vector<std::vector<float>> rows_of(const Answered& answered, int classes = 3) {
  const ContextPlaces places(answered.positions, spatial::curve_order(answered.positions),
                             answered.found);
  const ContextMatrix matrix(places, answered.found, classes);
  std::vector<float> values(matrix.points().size() * matrix.width());
  matrix.describe(0, matrix.points().size(), values);
  std::vector<std::vector<float>> rows(answered.positions.size());
  for (std::size_t i = 0; i < matrix.points().size(); ++i) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(i * matrix.width());
    rows[matrix.points()[i]].assign(first, first + static_cast<std::ptrdiff_t>(matrix.width()));
  }
  return rows;
}

/// The features of one size and kind as the header defines them, straight from the points.
std::vector<double> reference(const Answered& answered, std::size_t point, std::size_t k,
                              bool any_edge) {
  const auto p_of = [&](std::size_t i) {
    return static_cast<double>(any_edge ? answered.found.p_sharp[i] + answered.found.p_smooth[i]
                                        : answered.found.p_sharp[i]);
  };
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < answered.positions.size(); ++i) {
    if (i == point) continue;
    near.emplace_back((answered.positions[i] - answered.positions[point]).norm(), i);
  }
  std::sort(near.begin(), near.end());
  near.resize(k);
  const double r = near.back().first;
  double weights = 0, sum = 0, most = 0;
  Vec3 centre = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const auto& [distance, i] : near) {
    const double w = 1.0 - distance * distance / (1.2 * r * r), p = p_of(i);
    const Vec3 y = (answered.positions[i] - answered.positions[point]) / r;
    weights += w, sum += w * p, most = std::max(most, p);
    centre += w * p * y;
    second += w * p * y * y.transpose();
  }
  centre /= sum + 1e-3;
  const Mat3 covariance = second / (sum + 1e-3) - centre * centre.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(covariance);
  const Vec3 l = axes.eigenvalues();
  const double own = p_of(point);
  return {std::log(own / (1 - own)),
          sum / weights,
          most,
          centre.norm(),
          std::sqrt(l.sum()),
          centre.cross(axes.eigenvectors().col(2)).norm(),
          std::sqrt(l[2]),
          std::sqrt(l[1] / (l[2] + 1e-6))};
}

TEST(Context, IsWhatTheHeaderSays) {
  const Answered answered = random_answers(200);
  const auto rows = rows_of(answered);
  for (const std::size_t point : {3u, 50u, 120u}) {
    ASSERT_EQ(rows[point].size(), 64u);
    for (std::size_t size = 0; size < kContextSizes.size(); ++size) {
      for (const bool any_edge : {false, true}) {
        const auto wanted =
            reference(answered, point, static_cast<std::size_t>(kContextSizes[size]), any_edge);
        for (std::size_t f = 0; f < wanted.size(); ++f) {
          EXPECT_NEAR(rows[point][size * 16 + (any_edge ? 8 : 0) + f], wanted[f], 1e-5)
              << "size " << size << " feature " << f;
        }
      }
    }
  }
}

TEST(Context, LeavesAloneWhatIsSureToBeNoEdge) {
  Answered answered = random_answers(100);
  answered.found.p_sharp[7] = 0.005f, answered.found.p_smooth[7] = 0.004f;
  answered.found.classes[8] = kUnlabelled;
  const auto rows = rows_of(answered);
  EXPECT_TRUE(rows[7].empty());
  EXPECT_TRUE(rows[8].empty());
  answered.found.p_smooth[7] = 0.006f;
  EXPECT_FALSE(rows_of(answered)[7].empty());
}

TEST(Context, DoesNotDependOnThreadsOrNumbering) {
  Answered answered = random_answers(3000);
  // Copies of a place with other answers compete to be among the nearest.
  for (int i = 0; i < 40; ++i) answered.add({0.5, 0.5, 0.05}, 0.01f * static_cast<float>(i), 0.2f);
  set_thread_count(1);
  const auto wanted = rows_of(answered);
  set_thread_count(8);
  std::vector<std::size_t> numbers(answered.positions.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  Random(3).shuffle(std::span(numbers));
  Answered shuffled;
  for (const std::size_t i : numbers) {
    shuffled.add(answered.positions[i], answered.found.p_sharp[i], answered.found.p_smooth[i]);
  }
  const auto found = rows_of(shuffled);
  set_thread_count(0);
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(found[i], wanted[numbers[i]]);
}

TEST(Context, DoesNotDependOnUnitsPlaceOrOrientation) {
  const Answered answered = random_answers(500);
  const auto wanted = rows_of(answered);
  Answered moved = answered;
  const Eigen::AngleAxisd turn(1.0, Vec3(1, 2, 3).normalized());
  for (Vec3& p : moved.positions) p = 1000.0 * (turn * p) + Vec3(4e5, 5e6, 100);
  const auto found = rows_of(moved);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    ASSERT_EQ(found[i].size(), wanted[i].size());
    for (std::size_t f = 0; f < wanted[i].size(); ++f) {
      // The line through the centre is ill defined where two axes are nearly equal.
      if (f % 8 == 5) continue;
      EXPECT_NEAR(found[i][f], wanted[i][f], 1e-3) << i << " " << f;
    }
  }
}

TEST(Context, IsFiniteForFewPointsAndForCopies) {
  for (const std::size_t points : {1u, 2u, 5u, 33u, 100u}) {
    Answered answered;
    for (std::size_t i = 0; i < points; ++i) answered.add({1, 2, 3}, i % 2 ? 1.0f : 0.02f, 0.0f);
    for (const auto& row : rows_of(answered, 2)) {
      ASSERT_EQ(row.size(), 32u);
      for (const float x : row) EXPECT_TRUE(std::isfinite(x));
    }
  }
}

}  // namespace
}  // namespace pcednet::detect
