#include "pcednet/normals/orient.h"
#include "pcednet/core/random_vectors.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <mutex>
#include <numeric>
#include <string>

#include "normals/shapes.h"
#include "pcednet/core/parallel.h"
#include "pcednet/normals/prepare.h"
#include "support/expect_error.h"

namespace pcednet::normals {
namespace {

/// The true normals of the shape with signs by chance.
std::vector<Vec3> with_random_signs(const Shape& shape, std::uint64_t seed = 11) {
  Random random(seed);
  auto normals = shape.normals;
  for (Vec3& n : normals) n *= random.index(2) == 0 ? 1.0 : -1.0;
  return normals;
}

bool same_bytes(const Vec3& a, const Vec3& b) {
  return std::memcmp(a.data(), b.data(), sizeof(double[3])) == 0;
}

void expect_outwards(const Shape& shape, std::size_t components) {
  auto normals = with_random_signs(shape);
  const Orientation orientation = orient_normals(shape.positions, normals);
  EXPECT_EQ(normals, shape.normals);
  EXPECT_EQ(orientation.components, components);
  EXPECT_EQ(orientation.undecided, 0u);

  const PreparedNormals prepared = estimate_oriented_normals(shape.positions);
  EXPECT_EQ(agreement(shape, prepared.normals), 1.0);
  EXPECT_EQ(prepared.unusable, 0u);
  EXPECT_EQ(prepared.orientation.components, components);
  EXPECT_EQ(prepared.orientation.undecided, 0u);
}

TEST(Orient, TurnsASphereOutwards) {
  expect_outwards(sphere(4000, 2.0), 1);
}

TEST(Orient, TurnsABoxOutwards) {
  expect_outwards(box(Vec3(1, 2, 0.5), 20, 0.3), 1);
}

TEST(Orient, TurnsATorusOutwards) {
  expect_outwards(torus(6000, 3.0, 1.0), 1);
}

TEST(Orient, TurnsAnOpenCylinderOutwards) {
  expect_outwards(open_cylinder(4000, 1.0, 4.0), 1);
}

TEST(Orient, TurnsEachOfSeveralSurfacesOutwards) {
  Shape shape = sphere(3000, 1.0);
  append(shape, sphere(3000, 3.0, 5), Vec3::Zero());  // around the first
  append(shape, box(Vec3::Ones(), 15, 0.3), Vec3(10, 0, 0));
  expect_outwards(shape, 3);
}

TEST(Orient, KeepsTheSidesOfAThinPlateApart) {
  // 1.5 spacings thick: four or five of the 12 neighbours are on the other side.
  Shape shape = box(Vec3::Ones(), 40, 0.2);
  for (Vec3& p : shape.positions) p.z() *= 1.5 / 40;
  auto normals = with_random_signs(shape);
  orient_normals(shape.positions, normals);
  EXPECT_EQ(agreement(shape, normals), 1.0);
}

TEST(Orient, StandsNoise) {
  Shape shape = sphere(8000, 1.0);
  Random random(9);
  // The spacing is about 0.04.
  for (Vec3& p : shape.positions) {
    p += 0.01 * normal_vector(random);
  }
  EXPECT_GT(agreement(shape, estimate_oriented_normals(shape.positions).normals), 0.995);
}

TEST(Orient, TurnsAnOpenSheetUpwardsAndSaysSo) {
  Random random(6);
  Shape terrain;
  for (int i = 0; i < 3000; ++i) {
    const double x = random.uniform(0, 10), y = random.uniform(0, 10);
    terrain.positions.emplace_back(x, y, std::sin(x) * std::cos(y));
    terrain.normals.push_back(
        Vec3(-std::cos(x) * std::cos(y), std::sin(x) * std::sin(y), 1).normalized());
  }
  auto normals = with_random_signs(terrain);
  const Orientation orientation = orient_normals(terrain.positions, normals);
  EXPECT_EQ(normals, terrain.normals);
  EXPECT_EQ(orientation.components, 1u);
  EXPECT_EQ(orientation.undecided, 1u);
}

TEST(Orient, GivesTheSameBytesForAnySignsOrderAndNumberOfThreads) {
  Shape shape = box(Vec3(1, 2, 0.1), 15, 0.4);
  append(shape, box(Vec3::Ones(), 9), Vec3(4, 0, 0));  // with a grid's many ties
  append(shape, torus(500, 1.0, 0.4), Vec3(0, 9, 0));  // too sparse to be easy
  const auto expected = estimate_oriented_normals(shape.positions).normals;
  set_thread_count(1);
  EXPECT_EQ(estimate_oriented_normals(shape.positions).normals, expected);
  set_thread_count(0);

  Shape estimated{shape.positions, expected};
  for (const std::uint64_t seed : {1, 2, 3}) {
    std::vector<std::size_t> order(shape.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    Random(seed).shuffle(std::span(order));
    const auto signs = with_random_signs(estimated, seed);
    std::vector<Vec3> positions, normals;
    for (const std::size_t i : order) positions.push_back(shape.positions[i]);
    for (const std::size_t i : order) normals.push_back(signs[i]);
    orient_normals(positions, normals);
    const auto prepared = estimate_oriented_normals(positions).normals;
    for (std::size_t k = 0; k < order.size(); ++k) {
      EXPECT_TRUE(same_bytes(normals[k], expected[order[k]]));
      EXPECT_TRUE(same_bytes(prepared[k], expected[order[k]]));
    }
  }
}

TEST(Orient, DoesNotDependOnThePlaceOfTheOrigin) {
  const Shape shape = box(Vec3(1, 2, 0.5), 20, 0.3);
  Shape moved;
  append(moved, shape, Vec3(4.5e6, 1e7, -1e7));
  EXPECT_EQ(agreement(moved, estimate_oriented_normals(moved.positions).normals), 1.0);
}

TEST(Orient, TurnsNormalsToTheViewpoint) {
  const Shape shape = sphere(500, 1.0);
  auto normals = with_random_signs(shape);
  const Vec3 inside(0.1, 0.2, 0.3);
  const Orientation orientation = orient_normals(shape.positions, normals, {.viewpoint = inside});
  EXPECT_EQ(orientation.components, 0u);
  for (std::size_t i = 0; i < normals.size(); ++i) EXPECT_EQ(normals[i], -shape.normals[i]);

  const auto prepared = estimate_oriented_normals(shape.positions, {.viewpoint = inside});
  EXPECT_EQ(agreement(shape, prepared.normals), 0.0);
}

TEST(Viewpoints, AreFacedByBothFacesOfACornerUpToItsEdge) {
  Random random(31);
  std::vector<Vec3> positions, viewpoints;
  for (int i = 0; i < 4000; ++i) {
    const double along = 3.0 * random.uniform(), z = 3.0 * random.uniform();
    positions.emplace_back(-along, 0.0, z);
    viewpoints.emplace_back(-6.0, -1.5, 1.0);  // sees its face at a slant
    positions.emplace_back(0.0, along, z);
    viewpoints.emplace_back(6.0, 3.0, 1.0);
  }
  std::vector<Vec3> normals = estimate_oriented_normals(positions).normals;
  const std::size_t faced = face_scanners(positions, normals, viewpoints);
  EXPECT_EQ(faced, positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    EXPECT_GT(normals[i].dot(Vec3(1.0, -1.0, 0.0)), 0.0) << positions[i].transpose();
  }
}

TEST(Viewpoints, KeepTheSidesOfAThinWallApart) {
  Random random(32);
  std::vector<Vec3> positions, viewpoints, normals;
  for (int i = 0; i < 8000; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0, x = 8.0 * random.uniform();
    positions.emplace_back(x, 0.01 * side, 3.0 * random.uniform());  // .3 spacings thick
    viewpoints.emplace_back(-6.0, 5.0 * side, 1.0);
    normals.emplace_back(0.0, random.index(2) == 0 ? 1.0 : -1.0, 0.0);
  }
  face_scanners(positions, normals, viewpoints);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    EXPECT_GT(normals[i].y() * positions[i].y(), 0.0);
  }
}

TEST(Orient, LeavesZeroNormalsAndCountsThem) {
  Shape shape = sphere(1000, 1.0);
  shape.positions[7].x() = std::nan("");
  shape.positions.push_back(shape.positions[3]);
  shape.normals.push_back(shape.normals[3]);
  const PreparedNormals prepared = estimate_oriented_normals(shape.positions);
  EXPECT_EQ(prepared.unusable, 1u);
  EXPECT_EQ(prepared.normals[7], Vec3::Zero());
  EXPECT_EQ(prepared.normals[1000], prepared.normals[3]);

  auto normals = with_random_signs(shape);
  normals[20] = Vec3::Zero();
  EXPECT_EQ(orient_normals(shape.positions, normals).components, 1u);
  EXPECT_EQ(normals[20], Vec3::Zero());
  EXPECT_EQ(normals[1000], normals[3]);
}

TEST(Orient, CompletesGivenNormals) {
  const Shape shape = sphere(1000, 1.0);
  auto given = with_random_signs(shape);
  for (std::size_t i = 0; i < 1000; i += 3) given[i].setZero();
  const PreparedNormals prepared = complete_and_orient_normals(shape.positions, given);
  EXPECT_EQ(prepared.estimated, 334u);
  EXPECT_EQ(prepared.unusable, 0u);
  EXPECT_EQ(prepared.choice.neighbours, 12u);
  EXPECT_EQ(agreement(shape, prepared.normals), 1.0);
  for (std::size_t i = 0; i < 1000; ++i) {
    if (i % 3 != 0) {
      EXPECT_EQ(prepared.normals[i], shape.normals[i]);
    }
  }
}

TEST(Orient, TakesTinyClouds) {
  std::vector<Vec3> none;
  EXPECT_EQ(orient_normals(none, none).components, 0u);
  const std::vector<Vec3> one = {{1, 2, 3}};
  std::vector<Vec3> normals = {{0, 0, -1}};
  const Orientation orientation = orient_normals(one, normals);
  EXPECT_EQ(orientation.components, 1u);
  EXPECT_EQ(orientation.undecided, 1u);
  EXPECT_EQ(normals[0], Vec3(0, 0, 1));
  const PreparedNormals duplicates = estimate_oriented_normals(std::vector<Vec3>(9, one[0]));
  EXPECT_EQ(duplicates.unusable, 9u);
  EXPECT_EQ(duplicates.orientation.components, 0u);
}

TEST(Orient, RefusesWhatMakesNoSense) {
  const Shape shape = sphere(10, 1.0);
  std::vector<Vec3> normals(9);
  EXPECT_ERROR(ErrorKind::kUsage, orient_normals(shape.positions, normals));
  normals.resize(10);
  EXPECT_ERROR(ErrorKind::kUsage, orient_normals(shape.positions, normals, {.neighbours = 0}));
  const OrientOptions nowhere = {.viewpoint = Vec3::Constant(std::nan(""))};
  EXPECT_ERROR(ErrorKind::kUsage, orient_normals(shape.positions, normals, nowhere));
}

TEST(Orient, TurnsNormalsAcrossTheViewUpwards) {
  const std::vector<Vec3> positions(2, Vec3::Zero());
  std::vector<Vec3> normals = {{0, 0, 1}, {0, 0, -1}};
  orient_normals(positions, normals, {.viewpoint = Vec3(5, 0, 0)});
  EXPECT_EQ(normals, std::vector<Vec3>(2, Vec3::UnitZ()));
}

TEST(Orient, TakesTheFirstNormalThatACopyOfThePointHas) {
  const Shape shape = sphere(500, 1.0);
  std::vector<Vec3> positions, normals;
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    positions.insert(positions.end(), 2, shape.positions[i]);
    normals.push_back(Vec3::Zero());
    normals.push_back(i % 3 == 0 ? Vec3(-shape.normals[i]) : shape.normals[i]);
  }
  orient_normals(positions, normals);
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    EXPECT_EQ(normals[2 * i], Vec3::Zero());
    EXPECT_EQ(normals[2 * i + 1], shape.normals[i] + Vec3::Zero()) << i;
  }
}

TEST(Orient, CountsTurnedNormalsButNotThoseThatPointAnywhere) {
  const Shape shape = sphere(2000, 1.0);
  for (const bool flipped : {true, false}) {
    std::vector<Vec3> normals = shape.normals;
    for (std::size_t i = 0; i < normals.size(); i += 10) {
      normals[i] = flipped ? Vec3(-normals[i]) : normals[i].unitOrthogonal();
    }
    const Orientation found = orient_normals(shape.positions, normals, {.count_turned = true});
    EXPECT_EQ(found.turned, flipped ? 200u : 0u);
  }
}

TEST(Orient, AsksOftenWhetherToStop) {
  constexpr std::size_t kAtOnce = 1024;  // points between two questions
  const Shape shape = sphere(20000, 1.0);
  auto normals = with_random_signs(shape);
  std::mutex mutex;
  std::string at;
  std::map<std::string, std::size_t> questions;
  Progress progress;
  progress.report = [&](const std::string& stage, double fraction) {
    const std::lock_guard lock(mutex);
    at = fmt::format("{} {}", stage, fraction);
  };
  progress.cancelled = [&] {
    const std::lock_guard lock(mutex);
    ++questions[at];
    return false;
  };
  orient_normals(shape.positions, normals, {}, &progress);
  for (const char* step : {"orientation 0", "orientation 0.25"}) {
    EXPECT_GT(questions[step], shape.positions.size() / kAtOnce) << step;
  }
}

}  // namespace
}  // namespace pcednet::normals
