#include "pcednet/gls/engine/lane_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>
#include <utility>

#include "gls/test_clouds.h"
#include "pcednet/gls/engine/block_frame.h"
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

void expect_sums(const LaneSums& sums, const Scene& scene, const LaneGate& gate,
                 const char* kernels) {
  float rows[35][kLanes];
  static_assert(sizeof rows == sizeof sums);
  std::memcpy(rows, &sums, sizeof sums);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const auto expected = expected_sums(scene, lane, gate);
    for (std::size_t k = 0; k < 35; ++k) {
      // Hundreds of numbers, rounded to 6e-8 of the sum of weights each.
      EXPECT_NEAR(rows[k][lane], expected[k], 1e-6 * (1.0 + expected[0]))
          << kernels << " sum " << k << " lane " << lane;
    }
  }
}

/// The sources of `scene`, all of which may be shut out by a gate.
LaneSources gated(const Scene& scene, bool points) {
  return {.all = scene.sources.data(),
          .open = nullptr,
          .rest = scene.indices.data(),
          .open_count = 0,
          .rest_count = scene.indices.size(),
          .points = points};
}

/// Sums with one gate, or none.
LaneSums sum(const LaneKernels& kernels, const Scene& scene, const LaneGate& gate, bool points) {
  LaneSources sources = gated(scene, points);
  if (!gate.enabled) {
    std::swap(sources.open, sources.rest), std::swap(sources.open_count, sources.rest_count);
  }
  LaneSums sums;
  kernels.sum(sources, scene.targets, &gate, gate.enabled ? 1 : 0, &sums);
  return sums;
}

float total_count(const Scene& scene) {
  float count = 0.0f;
  for (const Source& s : scene.sources) count += s.count;
  return count;
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
        expect_sums(sum(kernels, scene, gate, false), scene, gate, kernels.name);
      }
    }
  }
}

TEST(LaneKernels, SumSinglePointsAlike) {
  Scene scene(300);
  for (Source& s : scene.sources) s.count = 1.0f, s.qq = s.qn = 0.0f;
  for (const LaneGate& gate : kGates) {
    for (const LaneKernels& kernels : all_lane_kernels()) {
      expect_sums(sum(kernels, scene, gate, true), scene, gate, kernels.name);
    }
  }
}

/// Turns of 48 sources: one that both gates leave alone, one that both shut out, one that only the
/// second lets in, and one that lies between them.
Scene scene_between_gates() {
  Scene scene(192);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    scene.targets.nx[lane] = scene.targets.ny[lane] = 0.0f, scene.targets.nz[lane] = 1.0f;
  }
  const float upward[4] = {0.95f, -0.9f, 0.1f, 0.5f};
  for (std::size_t j = 0; j < 192; ++j) {
    Source& s = scene.sources[scene.indices[j]];
    s.nz = upward[j / 48];
    s.nx = std::sqrt(1.0f - s.nz * s.nz), s.ny = 0.0f;
  }
  return scene;
}

TEST(LaneKernels, SumForTwoGatesWhatTheySumForEach) {
  const LaneGate gates[2] = {{.enabled = true, .threshold = 0.4f},
                             {.enabled = true, .threshold = -0.3f}};
  for (const Scene& scene : {scene_between_gates(), Scene(300), Scene(0)}) {
    for (const LaneKernels& kernels : all_lane_kernels()) {
      for (const bool points : {false, true}) {
        LaneSums both[2];
        kernels.sum(gated(scene, points), scene.targets, gates, 2, both);
        for (int g = 0; g < 2; ++g) {
          const LaneSums one = sum(kernels, scene, gates[g], points);
          EXPECT_EQ(std::memcmp(&both[g], &one, sizeof one), 0) << kernels.name << " gate " << g;
        }
      }
    }
  }
}

/// Some unit vectors that are in the box.
std::vector<Vec3> normals_in(const NormalBox& box) {
  test::Stream stream(3);
  std::vector<Vec3> normals;
  while (normals.size() < 200) {
    const Vec3 n = stream.direction();
    bool is_within = true;
    for (int a = 0; a < 3; ++a) {
      is_within = is_within && std::abs(n[a] - double(box.middle[a])) <= double(box.half[a]);
    }
    if (is_within) normals.push_back(n);
  }
  return normals;
}

TEST(LaneKernels, PartSourcesWhoseNormalIsCloseToAllOfABox) {
  const Scene scene(300);
  const NormalBox box = {{0.0f, 0.0f, 0.99f}, {0.1f, 0.1f, 0.01f}};
  const std::vector<Vec3> normals = normals_in(box);
  for (const LaneKernels& kernels : all_lane_kernels()) {
    std::vector<std::uint32_t> open = scene.indices, rest(300);
    const std::size_t count = kernels.part_open(scene.sources.data(), open.data(), 300, box, 0.7f,
                                                open.data(), rest.data());
    open.resize(count), rest.resize(300 - count);
    ASSERT_GT(count, 10u);
    for (const std::uint32_t i : open) {
      const Source& s = scene.sources[i];
      for (const Vec3& n : normals) EXPECT_GE(n.dot(Vec3(s.nx, s.ny, s.nz)), 0.7 - 1e-6);
    }
    for (const std::uint32_t i : rest) EXPECT_LT(scene.sources[i].nz, 0.9f) << kernels.name;
    std::vector<std::uint32_t> all = open, expected = scene.indices;
    all.insert(all.end(), rest.begin(), rest.end());
    std::sort(all.begin(), all.end()), std::sort(expected.begin(), expected.end());
    EXPECT_EQ(all, expected) << kernels.name;
  }
}

TEST(LaneKernels, SumOpenSourcesAsIfTheGatesWereEvaluated) {
  Scene scene(300);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    scene.targets.nx[lane] = scene.targets.ny[lane] = 0.0f, scene.targets.nz[lane] = 1.0f;
  }
  const LaneGate gates[2] = {{.enabled = true, .threshold = 0.4f},
                             {.enabled = true, .threshold = -0.3f}};
  for (const LaneKernels& kernels : all_lane_kernels()) {
    std::vector<std::uint32_t> open(300), rest(300);
    LaneSources sources = gated(scene, false);
    sources.open_count =
        kernels.part_open(sources.all, scene.indices.data(), 300, {{0.0f, 0.0f, 1.0f}, {}}, 0.7001f,
                          open.data(), rest.data());
    sources.rest_count = 300 - sources.open_count;
    sources.open = open.data(), sources.rest = rest.data();
    ASSERT_GT(sources.open_count, 10u);
    LaneSums both[2], one;
    kernels.sum(sources, scene.targets, gates, 2, both);
    for (int g = 0; g < 2; ++g) {
      expect_sums(both[g], scene, gates[g], kernels.name);
      kernels.sum(sources, scene.targets, &gates[g], 1, &one);
      EXPECT_EQ(std::memcmp(&both[g], &one, sizeof one), 0) << kernels.name << " gate " << g;
    }
  }
}

TEST(LaneKernels, SumWhatIsInsideEverySupportOnce) {
  for (const std::size_t count : {1, 15, 64, 65, 300}) {
    Scene scene(count);
    for (Source& s : scene.sources) s.x *= 0.4f, s.y *= 0.4f;  // less than 0.96 from any target
    for (const LaneKernels& kernels : all_lane_kernels()) {
      InsideSums inside = {.centre = {0.05f, -0.03f, 0.01f}, .moments = {}, .higher = {}};
      kernels.sum_inside(scene.sources.data(), scene.indices.data(), count, inside);
      LaneSums sums = {};
      kernels.add_inside(inside, scene.targets, sums);
      expect_sums(sums, scene, {}, kernels.name);
      EXPECT_EQ(inside.moments[0][0], total_count(scene));
    }
  }
}

TEST(LaneKernels, NegateSumsInsideWithTheNormals) {
  Scene scene(100), flipped = scene;
  for (Source& s : flipped.sources) s.nx = -s.nx, s.ny = -s.ny, s.nz = -s.nz, s.qn = -s.qn;
  for (const LaneKernels& kernels : all_lane_kernels()) {
    InsideSums inside = {}, negated = {};
    kernels.sum_inside(scene.sources.data(), scene.indices.data(), 100, inside);
    kernels.sum_inside(flipped.sources.data(), flipped.indices.data(), 100, negated);
    LaneSums sums = {}, opposite = {};
    kernels.add_inside(inside, scene.targets, sums);
    kernels.add_inside(negated, flipped.targets, opposite);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      EXPECT_EQ(sums.u[lane], opposite.u[lane]);
      EXPECT_EQ(sums.wyn[lane], -opposite.wyn[lane]);
      for (int a = 0; a < 3; ++a) EXPECT_EQ(sums.u_yn_y[a][lane], -opposite.u_yn_y[a][lane]);
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

TEST(LaneKernels, SplitOffWhatIsNearAllOfTheBox) {
  const Scene scene(301);
  const SourceBox box = {{-0.1f, -0.2f, -0.05f}, {0.1f, 0.3f, 0.05f}};
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < 301; ++i) {
    const Source& s = scene.sources[i];
    double sq_far = 0.0;
    for (const auto& [at, min, max] :
         {std::tuple(s.x, box.min[0], box.max[0]), std::tuple(s.y, box.min[1], box.max[1]),
          std::tuple(s.z, box.min[2], box.max[2])}) {
      const double far = std::max(std::abs(at - min), std::abs(at - max));
      sq_far += far * far;
    }
    if (sq_far < 0.95 * 0.95) expected.push_back(i);
  }
  ASSERT_GT(expected.size(), 20u);
  for (const LaneKernels& kernels : all_lane_kernels()) {
    CandidateList in, near, all, inside;
    in.reserve(301), near.reserve(301), all.reserve(301), inside.reserve(301);
    for (std::size_t i = 0; i < 301; ++i) in.set(i, scene.sources[i]);
    in.view.count = 301;
    kernels.select(in.view, box, 1.0f, all.view);
    kernels.split(in.view, box, 1.0f, 0.95f, near.view, inside.view);
    EXPECT_EQ(std::vector(inside.view.index, inside.view.index + inside.view.count), expected)
        << kernels.name;
    EXPECT_EQ(near.view.count + inside.view.count, all.view.count) << kernels.name;
  }
}

TEST(LaneKernels, SolveAlike) {
  const Scene scene(300);
  const LaneKernels& baseline = all_lane_kernels().front();
  const LaneSums sums = sum(baseline, scene, {}, false);
  LaneFits expected = {};
  baseline.solve(sums, LaneDetail::kAll, 1e-6f, expected);
  for (const LaneKernels& kernels : all_lane_kernels()) {
    LaneFits fits = {};
    kernels.solve(sums, LaneDetail::kAll, 1e-6f, fits);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      ASSERT_EQ(expected.verdict[lane], kSound);
      EXPECT_EQ(fits.verdict[lane], kSound);
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
