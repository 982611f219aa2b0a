#include "pcednet/detect/points/prepare.h"

#include <gtest/gtest.h>

#include <string>

#include "pcednet/core/random_vectors.h"
#include "support/expect_error.h"

namespace pcednet::detect {
namespace {

/// Points of the unit sphere with their normals, of which every `nth` is missing.
PointCloud sphere(std::size_t points, std::size_t nth) {
  Random random(3);
  PointCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const Vec3 normal = normal_vector(random).normalized();
    cloud.positions.push_back(normal);
    cloud.normals.push_back(i % nth == 0 ? Vec3::Zero() : normal);
  }
  return cloud;
}

TEST(Prepare, EstimatesWhatIsMissingOfTheNormals) {
  const PointCloud cloud = sphere(4000, 2);
  const PreparedCloud prepared = prepare(cloud);
  const double sign = prepared.normals[1].dot(cloud.normals[1]) > 0 ? 1 : -1;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_GT(sign * prepared.normals[i].dot(cloud.positions[i]), i % 2 == 0 ? 0.95 : 0.999999);
  }
  ASSERT_EQ(prepared.notes.size(), 1U);
  EXPECT_NE(prepared.notes[0].find("2000 of 4000 points have no usable normal: estimated"),
            std::string::npos);
}

TEST(Prepare, SaysThatCoordinatesAreTooLargeOrSmallForPlanes) {
  for (const double size : {1e-80, 1e80, 1e100}) {
    PointCloud cloud = sphere(400, 1);
    cloud.normals.clear();
    for (Vec3& p : cloud.positions) p *= size;
    const auto error = pcednet::test::error_of([&] { prepare(cloud); });
    ASSERT_TRUE(error) << size;
    EXPECT_EQ(error->kind(), ErrorKind::kInsufficient);
    EXPECT_NE(std::string(error->what()).find("are the coordinates right?"), std::string::npos)
        << error->what();
  }
}

TEST(Prepare, DoesNotCountTheNormalsOfPointsThatAreNowhere) {
  PointCloud cloud = sphere(400, 1);
  const PointCloud nowhere = sphere(401, 500);
  for (std::size_t i = 1; i < nowhere.size(); ++i) {
    cloud.positions.push_back(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    cloud.normals.push_back(nowhere.normals[i]);
  }
  const PreparedCloud prepared = prepare(cloud);
  EXPECT_EQ(prepared.made.size(), cloud.size());
  for (std::size_t i = 0; i < 400; ++i) EXPECT_TRUE(is_usable(prepared.normals[i]));
}

TEST(Prepare, LeavesTheFilesNormalsAloneIfFewAreMissing) {
  const PointCloud cloud = sphere(4000, 200);
  const PreparedCloud prepared = prepare(cloud);
  EXPECT_TRUE(prepared.made.empty());
  EXPECT_EQ(prepared.normals.data(), cloud.normals.data());
  ASSERT_EQ(prepared.notes.size(), 1U);
  EXPECT_NE(prepared.notes[0].find("20 of 4000"), std::string::npos);
}

/// Three solids, the second inside out, whose normals `flip(point)` turns about.
template <typename Flip>
PointCloud solids(const Flip& flip) {
  PointCloud cloud = sphere(30000, 40000);
  cloud.normals[0] = cloud.positions[0];
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.positions[i].x() += static_cast<double>(i % 3) * 3;
    if (i % 3 == 1) cloud.normals[i] = -cloud.normals[i];
    if (flip(i)) cloud.normals[i] = -cloud.normals[i];
  }
  return cloud;
}

TEST(Prepare, OrientsNormalsOfMixedSigns) {
  const PointCloud clean = solids([](std::size_t) { return false; });
  Random random(5);
  const auto tenth = [&](std::size_t) { return random.uniform() < 0.1; };
  const auto half = [&](std::size_t) { return random.uniform() < 0.5; };
  const auto patch = [&](std::size_t i) { return clean.positions[i].z() > 0.4; };
  const auto expect_oriented = [&](const PointCloud& cloud, const std::string& share) {
    const PreparedCloud prepared = prepare(cloud);
    EXPECT_TRUE(prepared.reoriented);
    ASSERT_EQ(prepared.notes.size(), 1U);
    EXPECT_EQ(prepared.notes[0],
              share +
                  " % of the normals oppose the rest of their surface: oriented consistently "
                  "(3 connected parts, outwards)");
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_EQ(prepared.normals[i], i % 3 == 1 ? Vec3(-clean.normals[i]) : clean.normals[i]);
    }
    const PreparedCloud kept = prepare(cloud, {.keep_orientation = true});
    EXPECT_TRUE(kept.notes.empty());
    EXPECT_EQ(kept.normals.data(), cloud.normals.data());
  };
  expect_oriented(solids(tenth), "10");
  expect_oriented(solids(half), "50");
  expect_oriented(solids(patch), "30");
}

TEST(Prepare, LeavesCleanAndInwardNormalsAlone) {
  for (const bool inward : {false, true}) {
    const PointCloud cloud = solids([&](std::size_t) { return inward; });
    const PreparedCloud prepared = prepare(cloud);
    EXPECT_FALSE(prepared.reoriented);
    EXPECT_TRUE(prepared.notes.empty());
    EXPECT_EQ(prepared.normals.data(), cloud.normals.data());
  }
}

TEST(Prepare, LeavesSurfacesAloneWithSomeNormalsThatPointAnywhere) {
  // One in ten, as in the paper's noisy clouds: some of them oppose by chance, none is flipped.
  Random random(9);
  PointCloud cloud = solids([](std::size_t) { return false; });
  for (std::size_t i = 0; i < cloud.size(); i += 10) {
    cloud.normals[i] = normal_vector(random).normalized();
  }
  EXPECT_TRUE(prepare(cloud).notes.empty());
}

TEST(Prepare, LeavesTheSidesOfThinWallsAlone) {
  // A plate as thick as its points are apart: many of the nearest are those of the other side.
  Random random(10);
  for (const double side : {1.0, -1.0}) {
    PointCloud cloud;
    for (int i = 0; i < 20000; ++i) {
      const double up = i % 2 ? 1.0 : -1.0;
      const double y = random.uniform(), x = random.uniform();
      cloud.positions.emplace_back(x, y, 0.0015 * up);
      cloud.normals.emplace_back(0, 0, side * up);
    }
    EXPECT_TRUE(prepare(cloud).notes.empty());
  }
}

TEST(Prepare, LeavesNormalsAloneThatNoOrientationMakesAgree) {
  // Foliage: places in a ball with normals that point anywhere, on the whole upwards.
  Random random(8);
  PointCloud cloud;
  for (int i = 0; i < 20000; ++i) {
    cloud.positions.push_back(uniform_vector(random));
    Vec3 normal = normal_vector(random).normalized();
    cloud.normals.push_back(normal.z() > 0 ? normal : Vec3(-normal));
  }
  EXPECT_TRUE(prepare(cloud).notes.empty());
}

TEST(Prepare, EstimatesAgainWhatItEstimatedBefore) {
  PointCloud cloud = sphere(3000, 1);
  cloud.normals.clear();
  Random random(9);
  for (Vec3& p : cloud.positions) p *= 1.0 + 0.02 * random.normal();
  const PreparedCloud once = prepare(cloud);
  PointCloud written = cloud;
  for (const Vec3& normal : once.normals) {
    written.normals.push_back(-normal.cast<float>().cast<double>());
  }
  EXPECT_TRUE(prepare(written).made.empty());
  set_estimated_normals(written, true);
  const PreparedCloud again = prepare(written);
  EXPECT_EQ(again.decision.neighbours, once.decision.neighbours);
  for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_EQ(again.normals[i], -once.normals[i]);
  EXPECT_NE(again.notes.front().find("with the signs that they have"), std::string::npos);
  EXPECT_TRUE(prepare(written, {.keep_orientation = true}).made.empty());
  set_estimated_normals(written, false);
  EXPECT_TRUE(prepare(written).made.empty());
}

TEST(Prepare, TakesNoMixedSignsOfEstimates) {
  PointCloud cloud = sphere(3000, 1);
  cloud.normals.clear();
  const std::vector<Vec3> once = prepare(cloud).made;
  cloud.normals = once;
  for (std::size_t i = 0; i < cloud.size(); i += 2) cloud.normals[i] = -cloud.normals[i];
  set_estimated_normals(cloud, true);
  EXPECT_EQ(prepare(cloud).made, once);
}

TEST(Prepare, LeavesOutPointsThatAreNowhere) {
  PointCloud cloud = sphere(2000, 1);
  cloud.normals.clear();
  const PreparedCloud alone = prepare(cloud);
  for (const double far : {1e20, 3.4e38, -1e140}) {
    PointCloud with = cloud;
    with.positions.emplace_back(far, 0.0, 0.0);
    const PreparedCloud prepared = prepare(with);
    ASSERT_EQ(prepared.notes.size(), 3U);
    EXPECT_NE(prepared.notes[0].find("1 point is far from all others"), std::string::npos);
    EXPECT_EQ(prepared.curve, alone.curve);
    EXPECT_EQ(prepared.normals[7], alone.normals[7]);
    EXPECT_TRUE(prepared.normals.back().isZero(0.0));
  }
  for (Vec3& p : cloud.positions) p *= 1e20;  // a large cloud has none
  EXPECT_EQ(prepare(cloud).notes.size(), 1U);
}

TEST(Prepare, SaysThatNormalsAreNotThoseOfThePoints) {
  PointCloud cloud = sphere(5000, 6000);
  cloud.normals[0] = cloud.positions[0];
  EXPECT_TRUE(prepare(cloud).notes.empty());
  Random random(2);
  for (Vec3& normal : cloud.normals) {
    normal = normal_vector(random).normalized();
  }
  const auto notes = prepare(cloud, {.keep_orientation = true}).notes;
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("the normals do not belong to these points"), std::string::npos);
}

TEST(Prepare, JudgesNoNormalsByPointsAlongLines) {
  // The nearest to each point are those of its scan line, on the plane that the beam swept.
  Random random(5);
  PointCloud cloud;
  for (int line = 0; line < 30; ++line) {
    for (int i = 0; i < 300; ++i) {
      const double x = i + random.uniform(-0.3, 0.3), y = 10.0 * line + 0.05 * random.normal();
      cloud.positions.emplace_back(x, y, random.normal());
    }
  }
  cloud.normals.assign(cloud.positions.size(), Vec3::UnitZ());
  EXPECT_EQ(prepare(cloud).notes, std::vector<std::string>());
}

TEST(Prepare, SaysFromHowManyPointsItEstimates) {
  PointCloud cloud = sphere(4000, 1);
  cloud.normals.clear();
  EXPECT_NE(prepare(cloud).notes.at(0).find("estimated from the 12 nearest points"),
            std::string::npos);
  Random random(8);
  for (Vec3& p : cloud.positions) p *= 1.0 + 0.015 * random.normal();
  EXPECT_NE(prepare(cloud).notes.at(0).find("estimated from the 12 to 48 nearest points"),
            std::string::npos);
}

TEST(Prepare, TakesArraysAsItTakesClouds) {
  for (const std::size_t nth : {2U, 200U}) {
    const PointCloud cloud = sphere(4000, nth);
    const PreparedCloud of_cloud = prepare(cloud);
    const PreparedCloud of_arrays = prepare(PointArrays{cloud.positions, cloud.normals});
    EXPECT_EQ(of_arrays.positions.data(), cloud.positions.data());
    EXPECT_EQ(of_arrays.made, of_cloud.made);
    EXPECT_EQ(of_arrays.notes, of_cloud.notes);
  }
  const PointCloud cloud = sphere(4000, 2);
  EXPECT_EQ(prepare(PointArrays{cloud.positions}).made.size(), 4000U);
  EXPECT_ERROR(ErrorKind::kUsage,
               prepare(PointArrays{cloud.positions, std::span(cloud.normals).first(3)}));

  const PrepareOptions as_they_are{.decided = NormalsDecision{}};
  EXPECT_ERROR(ErrorKind::kUsage, prepare(PointArrays{cloud.positions}, as_they_are));

  PointCloud scanned = cloud;
  scanned.scanners = {{5, 5, 5}};
  const std::vector<Vec3> scanners(cloud.size(), scanned.scanners.front());
  EXPECT_EQ(prepare(PointArrays{cloud.positions, cloud.normals, scanners}).made,
            prepare(scanned).made);
}

}  // namespace
}  // namespace pcednet::detect
