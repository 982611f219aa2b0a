#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "gls/test_clouds.h"
#include "pcednet/gls/descriptor.h"
#include "pcednet/gls/engine/lane_kernels.h"
#include "pcednet/gls/moments.h"
#include "pcednet/gls/sphere_fit.h"

namespace pcednet::gls {
namespace {

constexpr double kRounding = 1e-6;
constexpr std::size_t kSums = sizeof(LaneSums) / sizeof(float[kLanes]);

struct Sample {
  Vec3 y, n;
};

/// A neighbourhood at t = 1: the sums of LaneSums in its order and the sizes of their terms, and
/// the fit in double.
struct SummedSamples {
  std::array<double, kSums> sums = {}, sizes = {};
  MomentSet moments;

  explicit SummedSamples(const std::vector<Sample>& samples) {
    for (const Sample& s : samples) add(s);
    moments.count = static_cast<std::uint32_t>(samples.size());
  }

  SphereFit fit() const { return fit_sphere(moments.value, moments.count, 1.0); }

 private:
  void add(const Sample& s) {
    const double rr = s.y.squaredNorm(), u = 1.0 - rr, w = u * u, yn = s.y.dot(s.n);
    const double r = std::sqrt(rr);
    std::size_t next = 0;
    const auto put = [&](double value, double size) {
      sums[next] += value;
      sizes[next++] += size;
    };
    const auto put3 = [&](const Vec3& v, double size) {
      for (int a = 0; a < 3; ++a) put(v[a], size);
    };
    put(u, u), put3(u * s.y, u * r), put3(u * s.n, u), put(u * yn, u * r), put(u * rr, u * rr);
    put3(w * s.n, w), put(w * yn, w * r), put(w * rr, w * rr);
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) put(u * s.y[a] * s.y[b], u * rr);
    }
    for (int a = 0; a < 3; ++a) put3(u * s.n[a] * s.y, u * r);
    put3(u * yn * s.y, u * rr), put3(u * rr * s.y, u * rr * r);

    const auto weigh = [&](Moments& m, double weight) {
      m.w += weight, m.p += weight * s.y, m.n += weight * s.n;
      m.pn += weight * yn, m.pp += weight * rr;
    };
    weigh(moments.value, w), weigh(moments.dt, 4.0 * u * rr);
    for (int k = 0; k < 3; ++k) weigh(moments.dx[static_cast<std::size_t>(k)], 4.0 * u * s.y[k]);
  }
};

/// The sums in float, each off by up to kRounding of the sizes of its terms.
LaneSums rounded(const std::array<SummedSamples, kLanes>& all, test::Stream& stream) {
  float rows[kSums][kLanes];
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    for (std::size_t k = 0; k < kSums; ++k) {
      const double error = kRounding * (2 * stream.uniform() - 1) * all[lane].sizes[k];
      rows[k][lane] = static_cast<float>(all[lane].sums[k] + error);
    }
  }
  LaneSums sums;
  static_assert(sizeof rows == sizeof sums);
  std::memcpy(&sums, rows, sizeof sums);
  return sums;
}

/// A family of neighbourhoods that lose digits in one way, more of them as `strength` falls from 1
/// to 0.
struct Family {
  const char* name;
  std::vector<Sample> (*draw)(test::Stream& stream, double strength);
};

Vec3 in_ball(test::Stream& stream) {
  return std::cbrt(stream.uniform()) * stream.direction();
}

/// Half of the normals turned, their mean left over as far as `strength` says.
void cancel(std::vector<Sample>& samples, const Vec3& along, double strength) {
  for (std::size_t i = 0; i < samples.size(); i += 2) {
    samples[i + 1].y = samples[i].y;
    samples[i + 1].n = (strength * along - samples[i].n).normalized();
  }
}

const Family kFamilies[] = {
    {"AtTheRim",
     [](test::Stream& stream, double strength) {
       std::vector<Sample> samples(40);
       for (Sample& s : samples) {
         s.n = (Vec3(0, 0, 2) + stream.direction()).normalized();
         s.y = (1.0 - 0.3 * strength * stream.uniform()) * stream.direction();
       }
       return samples;
     }},
    {"APileFarAway",
     [](test::Stream& stream, double strength) {
       const Vec3 pile = 0.6 * stream.direction();
       std::vector<Sample> samples(40);
       for (Sample& s : samples) {
         s.n = (Vec3(0, 0, 2) + stream.direction()).normalized();
         s.y = pile + 0.3 * strength * in_ball(stream);
       }
       return samples;
     }},
    {"APileAround",
     [](test::Stream& stream, double strength) {
       std::vector<Sample> samples(40);
       for (Sample& s : samples) {
         s.n = (Vec3(0, 0, 2) + stream.direction()).normalized();
         s.y = 0.5 * strength * in_ball(stream);
       }
       return samples;
     }},
    {"APileAroundOnAPlane",
     [](test::Stream& stream, double strength) {
       std::vector<Sample> samples(40);
       for (Sample& s : samples) s = {0.5 * strength * in_ball(stream), Vec3::UnitZ()};
       return samples;
     }},
    {"TheCentreOfASphere",
     [](test::Stream& stream, double strength) {
       const Vec3 centre = 0.3 * strength * stream.direction();
       std::vector<Sample> samples(40);
       for (std::size_t i = 0; i < 40; i += 2) {
         const Vec3 n = stream.direction();
         samples[i] = {centre + 0.5 * n, n}, samples[i + 1] = {centre - 0.5 * n, -n};
       }
       return samples;
     }},
    {"NormalsThatCancel",
     [](test::Stream& stream, double strength) {
       std::vector<Sample> samples(40);
       for (Sample& s : samples) s = {in_ball(stream), stream.direction()};
       cancel(samples, Vec3::UnitZ(), strength);
       return samples;
     }},
    {"NormalsThatCancelInAPile",
     [](test::Stream& stream, double strength) {
       // All but a little curvature cancels: the gradient far away is larger than the Pratt norm.
       const Vec3 pile = 0.7 * stream.direction();
       std::vector<Sample> samples;
       for (int i = 0; i < 10; ++i) {
         const Vec3 q = stream.direction(), n = stream.direction();
         for (const double side : {1.0, -1.0}) {
           for (const double sign : {1.0, -1.0}) {
             samples.push_back({pile + 0.06 * side * q, (sign * n + strength * side * q)});
             samples.back().n.normalize();
           }
         }
       }
       return samples;
     }},
};

class LaneJudgement : public testing::TestWithParam<Family> {};

TEST_P(LaneJudgement, LetsThroughWhatRoundingCannotSpoil) {
  const LaneKernels& kernels = lane_kernels();
  test::Stream stream(71);
  std::size_t sound = 0, refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<SummedSamples> drawn;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      // From unharmed to hopeless: strengths down to 1e-8.
      drawn.emplace_back(GetParam().draw(stream, std::pow(10.0, -8.0 * stream.uniform())));
    }
    const auto all = [&]<std::size_t... i>(std::index_sequence<i...>) {
      return std::array<SummedSamples, kLanes>{drawn[i]...};
    }
    (std::make_index_sequence<kLanes>());
    LaneFits fits = {};
    kernels.solve(rounded(all, stream), LaneDetail::kInvariant, static_cast<float>(kRounding),
                  fits);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const SphereFit fit = all[lane].fit();
      if (fits.verdict[lane] == kVoid) {
        EXPECT_EQ(fit.status, FitStatus::kUndefined);
      }
      if (fits.verdict[lane] != kSound) {
        ++refused;
        continue;
      }
      ++sound;
      ASSERT_EQ(fit.status, FitStatus::kStable);
      const Descriptor exact = describe_sphere(fit, all[lane].moments);
      const double features[] = {exact.tau,     exact.kappa,     std::abs(exact.k1),
                                 exact.dtau_dt, exact.dkappa_dt, exact.phi};
      // Of two curvatures of nearly the same size, one is the larger by chance.
      fits.features[2][lane] = std::abs(fits.features[2][lane]);
      for (std::size_t k = 0; k < 6; ++k) {
        // Two hundredths for the gradient and the Pratt norm, by which the features are divided up
        // to three times, of sums that are weighted four times in derivatives. dkappa is a
        // difference of terms of the size of kappa.
        double size = std::max(1.0, std::abs(features[k]));
        if (k == 4) size = std::max(size, std::abs(features[1]));
        EXPECT_NEAR(fits.features[k][lane], features[k], 0.4 * size) << "feature " << k;
      }
    }
  }
  EXPECT_GT(sound, 100u);  // both are seen
  EXPECT_GT(refused, 100u);
}

/// The verdict of each kernel on a neighbourhood.
std::vector<float> verdicts_on(const std::vector<Sample>& samples) {
  const SummedSamples drawn(samples);
  const auto all = [&]<std::size_t... i>(std::index_sequence<i...>) {
    return std::array<SummedSamples, kLanes>{((void)i, drawn)...};
  }
  (std::make_index_sequence<kLanes>());
  test::Stream stream(73);
  std::vector<float> verdicts;
  for (const LaneKernels& kernels : all_lane_kernels()) {
    LaneFits fits = {};
    kernels.solve(rounded(all, stream), LaneDetail::kInvariant, static_cast<float>(kRounding),
                  fits);
    verdicts.insert(verdicts.end(), fits.verdict, fits.verdict + kLanes);
  }
  return verdicts;
}

TEST(LaneVerdict, IsSoundWhereAllAreCopiesOfThePoint) {
  const std::vector<Sample> samples(20, {Vec3::Zero(), Vec3(0.6, 0, 0.8)});
  for (const float verdict : verdicts_on(samples)) EXPECT_EQ(verdict, kSound);
}

TEST(LaneVerdict, IsVoidWhereBothSidesOfALeafAreSeen) {
  // What is surely undefined need not be repeated in double.
  test::Stream stream(72);
  std::vector<Sample> samples;
  for (int i = 0; i < 200; ++i) {
    const Vec3 y = in_ball(stream), n = (Vec3(0, 0, 5) + stream.direction()).normalized();
    samples.push_back({y, n}), samples.push_back({y, -n});
  }
  ASSERT_EQ(SummedSamples(samples).fit().status, FitStatus::kUndefined);
  for (const float verdict : verdicts_on(samples)) EXPECT_EQ(verdict, kVoid);
}

INSTANTIATE_TEST_SUITE_P(Families, LaneJudgement, testing::ValuesIn(kFamilies),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace pcednet::gls
