#include "pcednet/gls/lane_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "gls/test_clouds.h"
#include "pcednet/gls/block_frame.h"
#include "pcednet/gls/moments.h"

namespace pcednet::gls {
namespace {

struct Scene {
  std::vector<Source> sources;
  std::vector<std::uint32_t> indices;
  LaneTargets targets;

  explicit Scene(std::size_t count) {
    test::Stream stream(11);
    const auto number = [&](double size) {
      return static_cast<float>(size * (stream.uniform() - 0.5));
    };
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 n = stream.direction();
      sources.push_back({number(2.4), number(2.4), number(0.5), float(n.x()), float(n.y()),
                         float(n.z()), float(1 + i % 3), i % 2 ? 0.003f : 0.0f, number(0.01)});
      indices.push_back(static_cast<std::uint32_t>((i * 7) % count));
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      targets.x[lane] = number(0.4), targets.y[lane] = number(0.4), targets.z[lane] = number(0.1);
      const Vec3 n = lane == 5 ? Vec3::Zero() : stream.direction();
      targets.nx[lane] = float(n.x()), targets.ny[lane] = float(n.y());
      targets.nz[lane] = float(n.z());
    }
  }
};

const LaneGate kGates[] = {{}, {.enabled = true, .threshold = -0.2f}};

/// S of one lane in double, straight from the definitions in LaneSums, in its order.
std::vector<double> expected_sums(const Scene& scene, std::size_t lane, const LaneGate& gate) {
  std::vector<double> sums(35, 0.0);
  const Vec3 x(scene.targets.x[lane], scene.targets.y[lane], scene.targets.z[lane]);
  const Vec3 own(scene.targets.nx[lane], scene.targets.ny[lane], scene.targets.nz[lane]);
  for (const std::uint32_t i : scene.indices) {
    const Source& s = scene.sources[i];
    const Vec3 y = Vec3(s.x, s.y, s.z) - x, n(s.nx, s.ny, s.nz);
    const double rr = y.squaredNorm() + s.qq;
    if (rr >= 1.0) continue;
    const double g = gate.enabled && !own.isZero(0.0) ? side_gate(n, own, gate.threshold) : 1.0;
    const double u = (1.0 - rr) * g * s.count, w = u * (1.0 - rr), yn = y.dot(n) + s.qn;
    std::size_t next = 0;
    const auto put = [&](double value) { sums[next++] += value; };
    const auto put3 = [&](const Vec3& v) { put(v.x()), put(v.y()), put(v.z()); };
    put(u), put3(u * y), put3(u * n), put(u * yn), put(u * rr);
    put3(w * n), put(w * yn), put(w * rr);
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) put(u * y[a] * y[b]);
    }
    for (int a = 0; a < 3; ++a) put3(u * n[a] * y);
    put3(u * yn * y), put3(u * rr * y);
  }
  return sums;
}

TEST(LaneKernels, IncludeABaselineAndEndWithTheOneInUse) {
  const auto kernels = all_lane_kernels();
  ASSERT_FALSE(kernels.empty());
  EXPECT_STREQ(kernels.front().name, "baseline");
  EXPECT_STREQ(kernels.back().name, lane_kernels().name);
}

TEST(LaneKernels, SumAsTheDefinitionsSay) {
  for (const std::size_t count : {0, 1, 31, 32, 33, 300}) {
    const Scene scene(count);
    for (const LaneGate& gate : kGates) {
      for (const LaneKernels& kernels : all_lane_kernels()) {
        LaneSums sums;
        kernels.sum(scene.sources.data(), scene.indices.data(), count, scene.targets, gate, sums);
        float rows[35][kLanes];
        static_assert(sizeof rows == sizeof sums);
        std::memcpy(rows, &sums, sizeof sums);
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          const auto expected = expected_sums(scene, lane, gate);
          for (std::size_t k = 0; k < 35; ++k) {
            // Hundreds of numbers, rounded to 6e-8 of the sum of weights each.
            EXPECT_NEAR(rows[k][lane], expected[k], 1e-6 * (1.0 + expected[0]))
                << kernels.name << " sum " << k << " lane " << lane;
          }
        }
      }
    }
  }
}

TEST(LaneKernels, CountWithAMarginForRounding) {
  const Scene scene(300);
  for (const LaneGate& gate : kGates) {
    for (const LaneKernels& kernels : all_lane_kernels()) {
      LaneCounts counts;
      kernels.count(scene.sources.data(), scene.indices.data(), 300, scene.targets, gate, counts);
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        double expected = 0.0;
        for (const Source& s : scene.sources) {
          const Vec3 y = Vec3(s.x - scene.targets.x[lane], s.y - scene.targets.y[lane],
                              s.z - scene.targets.z[lane]);
          const Vec3 own(scene.targets.nx[lane], scene.targets.ny[lane], scene.targets.nz[lane]);
          const bool open = !gate.enabled || own.isZero(0.0) ||
                            side_gate(Vec3(s.nx, s.ny, s.nz), own, gate.threshold) > 0.0;
          if (y.squaredNorm() + s.qq < 1.0 && open) expected += s.count;
        }
        EXPECT_LE(counts.surely[lane], expected);
        EXPECT_GE(counts.maybe[lane], expected);
        EXPECT_LE(counts.maybe[lane] - counts.surely[lane], 3.0f);
      }
    }
  }
}

TEST(LaneKernels, SelectWhatIsNearTheBox) {
  const Scene scene(301);
  const SourceBox box = {{-0.1f, -0.2f, -0.05f}, {0.1f, 0.3f, 0.05f}};
  for (const float reach : {0.5f, 1.0f}) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < 301; ++i) {
      const Source& s = scene.sources[i];
      const float at[3] = {s.x, s.y, s.z};
      double sq = 0.0;
      for (int a = 0; a < 3; ++a) {
        const double gap = std::max({0.0f, box.min[a] - at[a], at[a] - box.max[a]});
        sq += gap * gap;
      }
      if (sq < double(reach) * reach) expected.push_back(i);
    }
    for (const LaneKernels& kernels : all_lane_kernels()) {
      CandidateList in, out;
      in.reserve(301), out.reserve(301);
      for (std::size_t i = 0; i < 301; ++i) in.set(i, scene.sources[i]);
      in.view.count = 301;
      kernels.select(in.view, box, reach, out.view);
      ASSERT_EQ(out.view.count, expected.size()) << kernels.name;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(out.view.index[i], expected[i]);
        EXPECT_EQ(out.view.y[i], scene.sources[expected[i]].y);
      }
    }
  }
}

TEST(LaneKernels, SolveAlike) {
  const Scene scene(300);
  LaneSums sums;
  const LaneKernels& baseline = all_lane_kernels().front();
  baseline.sum(scene.sources.data(), scene.indices.data(), 300, scene.targets, {}, sums);
  LaneFits expected = {};
  baseline.solve(sums, LaneDetail::kAll, expected);
  for (const LaneKernels& kernels : all_lane_kernels()) {
    LaneFits fits = {};
    kernels.solve(sums, LaneDetail::kAll, fits);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      EXPECT_EQ(fits.sound[lane], expected.sound[lane]);
      if (expected.sound[lane] == 0.0f) continue;
      for (std::size_t k = 0; k < 28; ++k) {
        const float size = std::max(1.0f, std::abs(expected.features[k][lane]));
        // Random normals: gradients of 0.1 lose a digit or two.
        EXPECT_NEAR(fits.features[k][lane], expected.features[k][lane], 1e-4f * size)
            << kernels.name << " feature " << k;
      }
    }
  }
}

}  // namespace
}  // namespace pcednet::gls
