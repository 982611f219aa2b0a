#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "gls/engine/fast_clouds.h"
#include "pcednet/gls/exact_scale_space.h"

namespace pcednet::gls {
namespace {

/// A cloud, how it is described, and the errors that the fast engine may have against the exact
/// one. The bounds are requirements, above the errors measured; voxels cause those errors, not
/// rounding.
struct Case {
  const char* name;
  std::function<test::Cloud()> cloud = [] { return test::cube(10000, 41, 0.003, 0.1); };  // noisy
  double median = 1e-5, p99 = 1e-2;  ///< of |fast - exact| for each feature but dkappa
  double dkappa_p99 = 5e-2;          ///< of dkappa, whose median may be ten times as large
  std::optional<double> gate = {};
  Reconstruction reconstruction = Reconstruction::kSphere;
  FeatureSet features = FeatureSet::kInvariant7;
  int scales = 16;
  double s_min = 0.0, s_max = 0.0;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

double quantile(std::vector<double>& values, double q) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

class FastAccuracy : public testing::TestWithParam<Case> {};

TEST_P(FastAccuracy, IsBoundedAgainstTheExactEngine) {
  const Case& c = GetParam();
  const test::Cloud cloud = c.cloud();
  ScaleSpaceOptions options;
  options.features = c.features;
  options.side_gate = c.gate;
  options.reconstruction = c.reconstruction;
  options.scales = c.scales;
  options.range.s_min = c.s_min, options.range.s_max = c.s_max;
  const FastScaleSpace fast(cloud.points(), options);
  const ExactScaleSpace exact(cloud.points(), options);
  EXPECT_EQ(fast.scales(), exact.scales());
  std::vector<std::uint32_t> targets;
  const auto count = static_cast<std::uint32_t>(cloud.positions.size());
  for (std::uint32_t i = 0; i < count; i += std::max(1u, count / 300)) targets.push_back(i);
  const auto f = test::describe(fast, targets);
  const auto e = test::describe(exact, targets);

  const auto names = feature_names(c.features);
  std::vector<std::vector<double>> errors(f.width);
  std::size_t statuses = 0;
  for (std::size_t row = 0; row < targets.size(); ++row) {
    for (std::size_t s = 0; s < f.scales; ++s) {
      statuses += f.status_at(row, s) != e.status_at(row, s);
      if (e.status_at(row, s) == FitStatus::kUndefined) continue;
      for (std::size_t k = 0; k < f.width; ++k) {
        errors[k].push_back(std::abs(f(row, s, k) - e(row, s, k)));
      }
    }
  }
  EXPECT_EQ(statuses, 0u);
  for (std::size_t k = 0; k < f.width; ++k) {
    ASSERT_FALSE(errors[k].empty());
    const bool steep = names[k].starts_with("dkappa");
    EXPECT_LE(quantile(errors[k], 0.5), steep ? 10 * c.median : c.median) << names[k];
    EXPECT_LE(quantile(errors[k], 0.99), steep ? c.dkappa_p99 : c.p99) << names[k];
  }
}

INSTANTIATE_TEST_SUITE_P(
    Clouds, FastAccuracy,
    testing::Values(
        Case{.name = "Scene", .cloud = [] { return test::scene(20000, 40); }},
        Case{.name = "Noisy"}, Case{.name = "Curve", .cloud = [] { return test::curve(10000); }},
        Case{.name = "Volume", .cloud = [] { return test::volume(20000); }},
        Case{.name = "Uneven", .cloud = [] { return test::uneven(20000); }},
        Case{.name = "Copies", .cloud = [] { return test::copies(8000); }, .s_min = 0.02},
        Case{.name = "Outliers",
             .cloud = [] { return test::outliers(10000); },
             .s_min = 0.03,
             .s_max = 0.3},
        Case{.name = "Gated", .p99 = 3e-2, .gate = -0.2},
        Case{.name = "TightlyGated", .p99 = 5e-2, .dkappa_p99 = 2e-1, .gate = 0.1},
        Case{.name = "Projected", .reconstruction = Reconstruction::kSphereMls},
        Case{.name = "GatedAndProjected",
             .p99 = 5e-2,
             .dkappa_p99 = 2e-1,
             .gate = 0.1,
             .reconstruction = Reconstruction::kSphereMls},
        Case{.name = "All28", .features = FeatureSet::kAll28},
        Case{.name = "Paper6", .features = FeatureSet::kPaper6},
        Case{.name = "Spatial4", .features = FeatureSet::kSpatial4},
        Case{.name = "Relief3", .features = FeatureSet::kRelief3},
        Case{.name = "FourScales", .scales = 4}, Case{.name = "ManyScales", .scales = 128}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace pcednet::gls
