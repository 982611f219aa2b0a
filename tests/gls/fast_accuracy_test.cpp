#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "gls/fast_clouds.h"
#include "pcednet/gls/exact_scale_space.h"

namespace pcednet::gls {
namespace {

/// A cloud, how it is described, and the errors that the fast engine may have against the exact
/// one. The bounds are requirements, above the errors measured; voxels cause those errors, not
/// rounding.
struct Case {
  const char* name;
  std::function<test::Cloud()> cloud;
  double median,
      p99;            ///< of |fast - exact| for each feature but dkappa
  double dkappa_p99;  ///< of dkappa, whose median may be ten times as large
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
    const bool steep = names[k].starts_with("dkappa");
    EXPECT_LE(quantile(errors[k], 0.5), steep ? 10 * c.median : c.median) << names[k];
    EXPECT_LE(quantile(errors[k], 0.99), steep ? c.dkappa_p99 : c.p99) << names[k];
  }
}

const auto noisy = [] { return test::cube(10000, 41, 0.003, 0.1); };

INSTANTIATE_TEST_SUITE_P(
    Clouds, FastAccuracy,
    testing::Values(
        Case{"Scene", [] { return test::scene(20000, 40); }, 1e-5, 1e-2, 5e-2},
        Case{"Noisy", noisy, 1e-5, 1e-2, 5e-2},
        Case{"Curve", [] { return test::curve(10000); }, 1e-5, 1e-2, 5e-2},
        Case{"Volume", [] { return test::volume(20000); }, 1e-5, 1e-2, 5e-2},
        Case{"Uneven", [] { return test::uneven(20000); }, 1e-5, 1e-2, 5e-2},
        Case{"Copies",
             [] { return test::copies(8000); },
             1e-5,
             1e-2,
             5e-2,
             {},
             Reconstruction::kSphere,
             FeatureSet::kInvariant7,
             16,
             0.02},
        Case{"Outliers",
             [] { return test::outliers(10000); },
             1e-5,
             1e-2,
             5e-2,
             {},
             Reconstruction::kSphere,
             FeatureSet::kInvariant7,
             16,
             0.03,
             0.3},
        Case{"Gated", noisy, 1e-5, 3e-2, 5e-2, -0.2},
        Case{"TightlyGated", noisy, 1e-5, 5e-2, 2e-1, 0.1},
        Case{"Projected", noisy, 1e-5, 1e-2, 5e-2, {}, Reconstruction::kSphereMls},
        Case{"GatedAndProjected", noisy, 1e-5, 5e-2, 2e-1, 0.1, Reconstruction::kSphereMls},
        Case{"All28", noisy, 1e-5, 1e-2, 5e-2, {}, Reconstruction::kSphere, FeatureSet::kAll28},
        Case{"Paper6", noisy, 1e-5, 1e-2, 5e-2, {}, Reconstruction::kSphere, FeatureSet::kPaper6},
        Case{"Spatial4",
             noisy,
             1e-5,
             1e-2,
             5e-2,
             {},
             Reconstruction::kSphere,
             FeatureSet::kSpatial4},
        Case{"Relief3", noisy, 1e-5, 1e-2, 5e-2, {}, Reconstruction::kSphere, FeatureSet::kRelief3},
        Case{"FourScales",
             noisy,
             1e-5,
             1e-2,
             5e-2,
             {},
             Reconstruction::kSphere,
             FeatureSet::kInvariant7,
             4},
        Case{"ManyScales",
             noisy,
             1e-5,
             1e-2,
             5e-2,
             {},
             Reconstruction::kSphere,
             FeatureSet::kInvariant7,
             128}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace pcednet::gls
