#include "pcednet/normals/estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "normals/shapes.h"
#include "pcednet/core/parallel.h"
#include "pcednet/normals/neighbour_count.h"
#include "pcednet/spatial/kd_tree.h"
#include "support/expect_error.h"

namespace pcednet::normals {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The largest distance of a point to its 12th neighbour.
double widest_neighbourhood(const std::vector<Vec3>& positions) {
  const spatial::KdTree tree(positions);
  std::vector<spatial::Neighbour> found;
  double widest = 0.0;
  for (const Vec3& p : positions) {
    tree.nearest(p, 13, found);
    widest = std::max(widest, std::sqrt(found.back().sq_distance));
  }
  return widest;
}

TEST(Estimate, FindsTheNormalOfATiltedPlane) {
  const Vec3 normal = Vec3(1, -2, 3).normalized();
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  for (const double offset : {0.0, 1e7}) {
    Random random(1);
    std::vector<Vec3> positions;
    for (int i = 0; i < 500; ++i) {
      positions.push_back(random.uniform(0, 10) * u + random.uniform(0, 10) * v +
                          Vec3::Constant(offset));
    }
    // The closed-form eigenvectors are good to about the root of the machine's precision; at 1e7
    // the positions are themselves rounded to 1e-9, about 1e-8 of a neighbourhood's width.
    for (const Vec3& n : estimate_normals(positions)) {
      EXPECT_LT(angle_between_lines(n, normal), 2e-7);
      EXPECT_NEAR(n.norm(), 1.0, 1e-14);
    }
  }
}

TEST(Estimate, TiltsOnASphereByLessThanItsNeighbourhoodIsWide) {
  const Shape shape = sphere(5000, 3.0);
  // Within h of a point the sphere leaves its tangent plane by h^2/2R, so a plane through
  // neighbours on one side only still tilts by less than h/R.
  const double bound = widest_neighbourhood(shape.positions) / 3.0;
  EXPECT_LT(bound, 0.2);
  const auto normals = estimate_normals(shape.positions);
  double sum = 0.0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double angle = angle_between_lines(normals[i], shape.normals[i]);
    EXPECT_LT(angle, bound);
    sum += angle;
  }
  EXPECT_LT(sum / 5000, bound / 10);
}

TEST(Estimate, TiltsOnACylinderByLessThanItsNeighbourhoodIsWide) {
  const Shape shape = open_cylinder(5000, 1.0, 5.0);
  const double bound = widest_neighbourhood(shape.positions);
  EXPECT_LT(bound, 0.3);
  const auto normals = estimate_normals(shape.positions);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_LT(angle_between_lines(normals[i], shape.normals[i]), bound);
  }
}

TEST(Estimate, IsExactOnABoxAwayFromItsEdges) {
  const Shape shape = box(Vec3::Ones(), 20);
  const auto normals = estimate_normals(shape.positions);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3 from_centre = (shape.positions[i] - Vec3::Constant(0.5)).cwiseAbs();
    Vec3 sorted = from_centre;
    std::sort(sorted.data(), sorted.data() + 3);
    // The 12 nearest on a grid of 0.05 lie within 0.1.
    const bool inner = sorted[1] < 0.5 - 0.101;
    EXPECT_LT(angle_between_lines(normals[i], shape.normals[i]), inner ? 1e-7 : 0.8);
  }
}

TEST(Estimate, TakesMoreNeighboursWhereThereIsNoise) {
  Shape shape = sphere(4000, 1.0);
  EXPECT_EQ(make_neighbour_graph(shape.positions).degree, 12u);
  Random random(8);
  // The spacing is about 0.05.
  for (Vec3& p : shape.positions) p += 0.015 * p * random.normal();
  EXPECT_EQ(make_neighbour_graph(shape.positions).degree, 48u);
  const auto mean_angle = [&](int neighbours) {
    const auto normals = estimate_normals(shape.positions, given_neighbours(neighbours));
    double sum = 0.0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      sum += angle_between_lines(normals[i], shape.normals[i]);
    }
    return sum / static_cast<double>(normals.size());
  };
  // Four times the points halve the error of a mean, and twice the radius halves what it tilts.
  EXPECT_LT(mean_angle(0), 0.3 * mean_angle(12));
  EXPECT_EQ(mean_angle(0), mean_angle(48));
}

TEST(Estimate, SeesASurfaceThroughNoiseOfItsSpacing) {
  Random random(9);
  std::vector<Vec3> positions;  // spacing 1, within which 12 neighbours are a ball
  for (int i = 0; i < 4000; ++i) {
    const double z = 1.5 * random.normal(), y = random.uniform(), x = random.uniform();
    positions.emplace_back(63 * x, 63 * y, z);
  }
  const auto share_beyond_a_radian = [&](int neighbours) {
    const auto normals = estimate_normals(positions, given_neighbours(neighbours));
    const auto beyond = std::count_if(normals.begin(), normals.end(), [](const Vec3& n) {
      return angle_between_lines(n, Vec3::UnitZ()) > 1.0;
    });
    return static_cast<double>(beyond) / static_cast<double>(normals.size());
  };
  EXPECT_GT(share_beyond_a_radian(12), 0.4);
  EXPECT_LT(share_beyond_a_radian(0), 0.1);
}

TEST(Estimate, TakesFewNeighboursWhereTheSurfaceBends) {
  const Shape coarse = sphere(300, 1.0);  // thickness above 0.01 at 12 neighbours
  EXPECT_EQ(make_neighbour_graph(coarse.positions).degree, 12u);
}

/// Lines ten times as far from each other as their points, over ground that is rough in height.
std::vector<Vec3> rough_scan_lines(double aside) {
  Random random(3);
  std::vector<Vec3> positions;
  for (int line = 0; line < 30; ++line) {
    for (int i = 0; i < 300; ++i) {
      const double x = i + random.uniform(-0.3, 0.3), y = 10.0 * line + aside * random.normal();
      positions.emplace_back(x, y, 1.2 * random.normal());
    }
  }
  return positions;
}

TEST(Estimate, DoesNotTakeThePlaneOfAScanLineForTheSurface) {
  for (const double aside : {0.0, 0.2, 0.5}) {
    const std::vector<Vec3> positions = rough_scan_lines(aside);
    for (const auto& choice : {std::optional<NeighbourChoice>(), {choose_one_count(positions)}}) {
      const std::vector<Vec3> normals = estimate_normals(positions, choice);
      const auto up = std::count_if(normals.begin(), normals.end(), [](const Vec3& n) {
        return angle_between_lines(n, Vec3::UnitZ()) < 0.5;
      });
      EXPECT_GT(static_cast<double>(up) / static_cast<double>(normals.size()), 0.95) << aside;
    }
  }
}

TEST(Estimate, GivesTheSameBytesForAnyOrderAndNumberOfThreads) {
  Shape shape = box(Vec3(1, 2, 3), 15, 0.4);
  append(shape, box(Vec3::Ones(), 9), Vec3(4, 0, 0));  // with a grid's many ties
  const auto normals = estimate_normals(shape.positions);
  set_thread_count(1);
  EXPECT_EQ(estimate_normals(shape.positions), normals);
  set_thread_count(0);

  std::vector<std::size_t> order(shape.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  Random(7).shuffle(std::span(order));
  std::vector<Vec3> shuffled;
  for (const std::size_t i : order) shuffled.push_back(shape.positions[i]);
  const auto of_shuffled = estimate_normals(shuffled);
  for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(of_shuffled[k], normals[order[k]]);
}

TEST(Estimate, DoesNotCountDuplicates) {
  const Shape shape = box(Vec3::Ones(), 10, 0.3);
  const auto expected = estimate_normals(shape.positions);
  auto repeated = shape.positions;
  for (int copy = 0; copy < 30; ++copy) {
    repeated.insert(repeated.end(), shape.positions.begin(), shape.positions.begin() + 50);
  }
  const auto normals = estimate_normals(repeated);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const std::size_t k = i < expected.size() ? i : (i - expected.size()) % 50;
    EXPECT_EQ(normals[i], expected[k]);
  }
}

TEST(Estimate, LeavesPointsWithoutAPlaneZero) {
  EXPECT_TRUE(estimate_normals(std::vector<Vec3>{}).empty());
  EXPECT_EQ(estimate_normals(std::vector<Vec3>{{1, 2, 3}}), std::vector<Vec3>(1, Vec3::Zero()));
  EXPECT_EQ(estimate_normals(std::vector<Vec3>{{1, 2, 3}, {4, 5, 7}}),
            std::vector<Vec3>(2, Vec3::Zero()));
  EXPECT_EQ(estimate_normals(std::vector<Vec3>(40, Vec3(1, 2, 3))),
            std::vector<Vec3>(40, Vec3::Zero()));
  std::vector<Vec3> line;
  for (int i = 0; i < 50; ++i) line.push_back(Vec3(1, 2, -1) * (0.37 * i) + Vec3(5, 5, 5));
  EXPECT_EQ(estimate_normals(line), std::vector<Vec3>(50, Vec3::Zero()));
}

TEST(Estimate, NeedsThreeDistinctPoints) {
  const auto normals = estimate_normals(std::vector<Vec3>{{0, 0, 5}, {1, 0, 5}, {0, 1, 5}});
  for (const Vec3& n : normals) EXPECT_LT(angle_between_lines(n, Vec3::UnitZ()), 1e-7);
}

TEST(Estimate, TakesFewPointsOfAnExactPlane) {
  for (const int points : {4, 10, 16, 17}) {
    Random random(7);
    std::vector<Vec3> positions;
    for (int i = 0; i < points; ++i) {
      const double y = random.uniform(), x = random.uniform();
      positions.emplace_back(x, y, 1e-12 * i);
    }
    for (const Vec3& n : estimate_normals(positions)) {
      EXPECT_LT(angle_between_lines(n, Vec3::UnitZ()), 1e-6) << points << " points";
    }
  }
}

TEST(Estimate, LooksPastPointsThatAreNotFinite) {
  auto positions = box(Vec3::Ones(), 10).positions;
  const auto expected = estimate_normals(positions);
  positions.insert(positions.begin(), Vec3(kNan, 0, 0));
  positions.push_back(Vec3(0, std::numeric_limits<double>::infinity(), 0));
  const auto normals = estimate_normals(positions);
  EXPECT_EQ(normals.front(), Vec3::Zero());
  EXPECT_EQ(normals.back(), Vec3::Zero());
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), normals.begin() + 1));
}

TEST(Estimate, RefusesTooFewNeighbours) {
  for (const int count : {1, -1}) {
    EXPECT_ERROR(ErrorKind::kUsage, given_neighbours(count));
  }
}

TEST(Estimate, TakesMoreNeighboursWhereTheSurfaceIsThickerThanAHundredth) {
  const auto degree = [](double noise) {
    Random random(4);
    std::vector<Vec3> positions;
    for (int i = 0; i < 3000; ++i) {
      const double z = noise * random.normal(), y = random.uniform(), x = random.uniform();
      positions.emplace_back(x, y, z);
    }
    return make_neighbour_graph(positions).degree;
  };
  const double spacing = 1 / std::sqrt(3000.0);
  EXPECT_EQ(degree(0.01 * spacing), 12u);
  EXPECT_GT(degree(0.1 * spacing), 12u);
}

}  // namespace
}  // namespace pcednet::normals
