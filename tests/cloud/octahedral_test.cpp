#include "pcednet/cloud/octahedral.h"

#include <gtest/gtest.h>

#include "pcednet/core/random_vectors.h"

namespace pcednet {
namespace {

/// The direction at a place of the unfolded octahedron, as Cigolle et al. decode it.
Vec3 direction_at(const Eigen::Vector2d& place) {
  const double u = place.x(), v = place.y(), z = 1 - std::abs(u) - std::abs(v);
  if (z >= 0) return Vec3(u, v, z).normalized();
  return Vec3(std::copysign(1 - std::abs(v), u), std::copysign(1 - std::abs(u), v), z).normalized();
}

TEST(Octahedral, GivesEveryDirectionAPlaceThatLeadsBackToIt) {
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    const Vec3 direction = normal_vector(random);
    const Eigen::Vector2d place = octahedral(direction);
    ASSERT_LE(place.cwiseAbs().maxCoeff(), 1.0);
    ASSERT_LT((direction_at(place) - direction.normalized()).norm(), 1e-14) << direction;
    ASSERT_LT((octahedral(direction * 1e-9) - place).norm(), 1e-14) << "length must not count";
  }
}

TEST(Octahedral, PutsTheAxesWhereTheyBelong) {
  EXPECT_EQ(octahedral({0, 0, 3}), Eigen::Vector2d(0, 0));
  EXPECT_EQ(octahedral({2, 0, 0}), Eigen::Vector2d(1, 0));
  EXPECT_EQ(octahedral({0, -1, 0}), Eigen::Vector2d(0, -1));
  EXPECT_EQ(octahedral({0, 0, -1}).cwiseAbs(), Eigen::Vector2d(1, 1));
  EXPECT_EQ(octahedral({-1, 1, -2}), Eigen::Vector2d(-0.75, 0.75));
}

TEST(Octahedral, TakesNoDirectionForThatOfZ) {
  EXPECT_EQ(octahedral(Vec3::Zero()), octahedral(Vec3::UnitZ()));
}

}  // namespace
}  // namespace pcednet
