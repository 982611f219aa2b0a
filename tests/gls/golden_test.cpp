#include <gtest/gtest.h>

#include <cstring>
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

/// A line of the excerpt: point, scale, status, then tau kappa k1 dtau dkappa phi k2, free of
/// units.
TEST_P(Golden, EqualsTheExcerpt) {
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
      for (std::size_t f = 0; f < 7; ++f) {
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

/// The numbers of a little-endian float64 array file, whose header takes 128 bytes.
std::vector<double> read_doubles(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  EXPECT_GT(bytes.size(), 128u) << path;
  std::vector<double> numbers((bytes.size() - 128) / sizeof(double));
  std::memcpy(numbers.data(), bytes.data() + 128, numbers.size() * sizeof(double));
  return numbers;
}

// Columns of the whole files.
enum Column : std::size_t {
  kStatus = 2,
  kTau = 4,
  kKappa = 5,
  kK1 = 6,
  kK2 = 7,
  kDtau = 8,
  kDkappa = 9,
  kPhi = 10,
  kEta = 11,
  kDeta = 14,
  kTauAtPoint = 27,
  kDtauDx = 30,
  kDkappaDx = 33,
  kColumns = 36,
};

void expect_row(const double* row, const test::Matrix<double>& matrix, std::size_t q, std::size_t s,
                double t, bool projected) {
  const std::string where = "query " + std::to_string(q) + " scale " + std::to_string(s);
  const auto expect = [&](std::size_t feature, double value) {
    expect_close(value, matrix(q, s, feature), where + " feature " + std::to_string(feature));
  };
  ASSERT_EQ(static_cast<int>(row[kStatus]), static_cast<int>(matrix.status_at(q, s))) << where;
  expect(0, row[projected ? kTauAtPoint : kTau] / t);
  expect(1, row[kKappa] * t);
  expect(2, row[kK1] * t);
  expect(3, row[kDtau]);
  expect(4, row[kDkappa] * t * t);
  expect(5, row[kPhi]);
  expect(6, row[kK2] * t);
  for (std::size_t k = 0; k < 3; ++k) {
    expect(7 + k, row[kEta + k]);
    expect(10 + k, row[kDeta + k] * t);
    expect(13 + k, row[kDtauDx + k]);
    expect(16 + k, row[kDkappaDx + k] * t * t);
  }
}

TEST_P(Golden, EqualsTheWholeFilesWhereTheyAre) {
  const std::filesystem::path folder =
      std::filesystem::path(PCEDNET_SOURCE_DIR).parent_path() / "shared/golden";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const std::string name = GetParam();
  const test::Cloud cloud = test::golden_cloud(name);
  const std::vector<double> input = read_doubles(folder / (name + "_input.npy"));
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    ASSERT_EQ(cloud.positions[i], Vec3::Map(&input[6 * i])) << i;
    ASSERT_EQ(cloud.normals[i], Vec3::Map(&input[6 * i + 3])) << i;
  }
  std::vector<std::uint32_t> targets(300);
  for (std::uint32_t q = 0; q < 300; ++q) targets[q] = 33 * q;
  for (const bool projected : {false, true}) {
    const ExactScaleSpace space(cloud.points(), golden_options(projected));
    const auto matrix = test::describe(space, targets);
    const auto rows = read_doubles(folder / (name + (projected ? "_m1.npy" : "_m0.npy")));
    ASSERT_EQ(rows.size(), 300u * 16 * kColumns);
    for (std::size_t q = 0; q < 300; ++q) {
      for (std::size_t s = 0; s < 16; ++s) {
        const double* row = &rows[(q * 16 + s) * kColumns];
        EXPECT_NEAR(space.scales()[s] / row[0], 1.0, 1e-14);
        expect_row(row, matrix, q, s, row[0], projected);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Clouds, Golden, testing::ValuesIn(kClouds),
                         [](const auto& cloud) { return std::string(cloud.param); });

}  // namespace
}  // namespace pcednet::gls
