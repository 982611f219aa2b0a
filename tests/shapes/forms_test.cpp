#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <vector>

#include "detect/labelled_cube.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/detect/boundary.h"
#include "pcednet/detect/classify.h"

// The default model finds the edges of a block in the forms in which clouds come: rounded, as
// voxels, from a scanner. bench/cloud_forms.py measures more forms of a larger scene.

namespace pcednet::shapes {
namespace {

/// Points with their distances to the nearest edge, in spacings.
struct Form {
  std::vector<Vec3> positions;
  std::vector<double> away;
};

struct Score {
  double found = 0.0;  ///< of the points within .7 spacings of an edge: edge or boundary
  double wrong = 0.0;  ///< share of edges among the points beyond 4 spacings
};

Score score(const Form& form) {
  static const auto model = detect::load_model(PCEDNET_SOURCE_DIR "/models/general.safetensors");
  PointCloud cloud;
  cloud.positions = form.positions;
  const auto prepared = detect::prepare(cloud);
  detect::Classification found = detect::classify(prepared, model);
  detect::mark_boundary(prepared, found);
  std::size_t near = 0, far = 0, right = 0, wrong = 0;
  for (std::size_t i = 0; i < form.away.size(); ++i) {
    const std::uint8_t its = found.classes[i];
    near += form.away[i] < 0.7, right += form.away[i] < 0.7 && its != kNonEdge;
    far += form.away[i] > 4.0;
    wrong += form.away[i] > 4.0 && (its == kSmoothEdge || its == kSharpEdge);
  }
  EXPECT_GT(near, 50u);
  EXPECT_GT(far, 1000u);
  return {static_cast<double>(right) / static_cast<double>(near),
          static_cast<double>(wrong) / static_cast<double>(far)};
}

constexpr double kSpacing = 0.02;

/// Of the box [-size, size].
double distance_to_edges(const Vec3& p, const Vec3& size) {
  const Vec3 outwards = p.cwiseAbs() - size;
  double least = std::numeric_limits<double>::infinity();
  for (int along = 0; along < 3; ++along) {
    Vec3 offset = outwards;
    offset[along] = std::max(offset[along], 0.0);
    least = std::min(least, offset.norm());
  }
  return least;
}

/// A noisy cube, oblique to the axes, with coordinates rounded to `step`.
Form rounded_cube(double spacing, double step) {
  const auto turned = Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized());
  Random random(1);
  Form form;
  for (const Vec3& p :
       pcednet::cube(static_cast<std::size_t>(6.0 / (spacing * spacing)), 1).positions) {
    Vec3 moved = turned * p;
    for (double& x : moved) {
      x = std::round((x + 0.15 * kSpacing * random.normal()) / step) * step;
    }
    form.positions.push_back(moved);
    form.away.push_back(distance_to_edges(p, Vec3::Constant(0.5)) / kSpacing);
  }
  return form;
}

TEST(CloudForms, RoundedCoordinatesMakeNoEdges) {
  for (const double step : {0.2, 0.5, 1.0}) {
    const Score found = score(rounded_cube(kSpacing, step * kSpacing));
    EXPECT_GT(found.found, 0.97) << step;
    EXPECT_LT(found.wrong, 0.002) << step;
  }
}

TEST(CloudForms, CentresOfVoxelsMakeNoEdges) {
  const Form all = rounded_cube(0.4 * kSpacing, kSpacing);
  std::vector<std::size_t> order(all.positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto coordinates = [&](std::size_t i) {
    const Vec3& p = all.positions[i];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return coordinates(a) < coordinates(b); });
  Form centres;
  for (const std::size_t i : order) {
    if (!centres.positions.empty() && centres.positions.back() == all.positions[i]) continue;
    centres.positions.push_back(all.positions[i]);
    centres.away.push_back(all.away[i]);
  }
  EXPECT_LT(centres.positions.size(), all.positions.size() / 2);
  const Score found = score(centres);
  EXPECT_GT(found.found, 0.97);
  EXPECT_LT(found.wrong, 0.002);
}

/// A ridge of 90 degrees along y, with points further apart as y grows, as seen from its end. Only
/// the sparse half counts.
Form uneven_ridge() {
  Random random(2);
  Form form;
  for (double y = 1.0; y < 16.0;) {
    const double spacing = 0.01 * y;
    for (double across = -2.0; across < 2.0; across += spacing) {
      const double x = across + spacing * random.uniform(-0.3, 0.3);
      const Vec3 p(x, y + spacing * random.uniform(-0.3, 0.3), -std::abs(x));
      const Vec3 noise = normal_vector(random);
      form.positions.push_back(p + 0.002 * noise);
      form.away.push_back(y < 8.0 ? 2.0 : std::sqrt(2.0) * std::abs(x) / spacing);
    }
    y += spacing;
  }
  return form;
}

TEST(CloudForms, EdgesAreFoundWherePointsAreSparser) {
  const Form form = uneven_ridge();
  const Score found = score(form);
  EXPECT_GT(found.found, 0.97);
  EXPECT_LT(found.wrong, 0.002);
}

/// A ridge of 110 degrees along x, in profiles across it `apart` times as far from each other as
/// their points.
Form profiled_ridge(double apart) {
  Random random(4);
  Form form;
  const double spacing = std::sqrt(apart), half = 55.0 * std::numbers::pi / 180.0;  // as an area
  for (double x = 0.0; x < 300.0; x += apart) {
    const double first = random.uniform();
    for (double y = first - 120.0; y < 120.0; y += 1.0) {
      const double across = y + 0.1 * random.normal();
      const Vec3 p(x, across * std::sin(half), -std::abs(across) * std::cos(half));
      form.positions.push_back(p + 0.08 * normal_vector(random));
      const bool is_inner = std::min(x, 300.0 - x) > 20.0 && std::abs(across) < 100.0;
      form.away.push_back(is_inner ? std::abs(across) / spacing : 2.0);
    }
  }
  return form;
}

TEST(CloudForms, EdgesAcrossProfilesAreFound) {
  for (const double apart : {6.0, 10.0}) {
    const Score found = score(profiled_ridge(apart));
    EXPECT_GT(found.found, 0.97) << apart;
    EXPECT_LT(found.wrong, 0.002) << apart;
  }
}

}  // namespace
}  // namespace pcednet::shapes
