#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "gls/test_clouds.h"

// Values of an independent implementation in double precision. Compared free of units, where they
// are of magnitude 1 (k1 t up to 1e2), so 1e-9 says "the same formula": two orders of summing agree
// to 2e-12, and single precision would miss by 1e-6.

namespace pcednet::gls {
namespace {

constexpr double kTolerance = 1e-9;
const char* const kClouds[] = {"sphere", "cube", "cubeA", "cubeB", "cylinder"};

ScaleSpaceOptions golden_options(bool projected) {
  ScaleSpaceOptions options;
  options.features = FeatureSet::kAll28;
  options.max_projection_steps = 1;
  options.reconstruction = projected ? Reconstruction::kSphereMls : Reconstruction::kSphere;
  return options;
}

void expect_close(double expected, double actual, const std::string& where) {
  EXPECT_NEAR(expected, actual, kTolerance * std::max(1.0, std::abs(expected))) << where;
}

class Golden : public testing::TestWithParam<const char*> {};

/// A line of a file: point, scale, status, then tau kappa k1 dtau dkappa phi k2 and the vectors
/// eta, deta, dtau/dx and dkappa/dx, free of units.
TEST_P(Golden, EqualsTheIndependentValues) {
  const test::Cloud cloud = test::golden_cloud(GetParam());
  for (const bool projected : {false, true}) {
    const ExactScaleSpace space(cloud.points(), golden_options(projected));
    const std::filesystem::path path =
        std::filesystem::path(PCEDNET_SOURCE_DIR) / "tests/gls/golden" /
        (std::string(GetParam()) + (projected ? "_projected.txt" : ".txt"));
    std::ifstream file(path);
    std::string line;
    std::size_t lines = 0;
    while (std::getline(file, line)) {
      if (line.starts_with('#')) continue;
      std::istringstream numbers(line);
      std::uint32_t point = 0;
      std::size_t scale = 0;
      int status = 0;
      numbers >> point >> scale >> status;
      const auto matrix = test::describe(space, {point});
      EXPECT_EQ(static_cast<int>(matrix.status_at(0, scale)), status) << line;
      for (std::size_t f = 0; f < 19; ++f) {
        double expected = 0.0;
        numbers >> expected;
        ASSERT_TRUE(numbers) << path << ": " << line;
        expect_close(expected, matrix(0, scale, f), line);
      }
      ++lines;
    }
    EXPECT_EQ(lines, 64u) << path;
  }
}

INSTANTIATE_TEST_SUITE_P(Clouds, Golden, testing::ValuesIn(kClouds),
                         [](const auto& cloud) { return std::string(cloud.param); });

}  // namespace
}  // namespace pcednet::gls
