#include "pcednet/detect/context.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/blocks.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/vector_clones.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/principal_axes.h"
#include "pcednet/gls/features.h"
#include "pcednet/nn/predict.h"

namespace pcednet::detect {
namespace {

constexpr double kReach = 1.2;          // the weight is zero at r^2 times this
constexpr double kLittle = 1e-3;        // added to sums of probabilities before dividing by them
constexpr double kSurest = 1e-6;        // probabilities nearer to 0 or 1 are clamped
constexpr std::size_t kPart = 1 << 15;  // points of a task

/// Sums over the nearest points, extended from each size of neighbourhood to the next. y is a
/// position relative to the point, d its squared length.
struct Sums {
  double count = 0, d = 0, most = 0;
  /// Sums of p, p y and the lower half of p y y^T.
  struct Moments {
    double p = 0, x = 0, y = 0, z = 0, xx = 0, yx = 0, zx = 0, yy = 0, zy = 0, zz = 0;
  };
  Moments plain, by_d;  ///< plain, and times d
};

/// Adds `near`, relative to the point at `place`.
PCEDNET_VECTOR_CLONES
void add_nearest(std::span<const spatial::Neighbour> near, const Vec3* positions,
                 const std::array<float, 2>* probabilities, std::size_t kind, std::size_t place,
                 Sums& sums) {
  const double* const from = positions[place].data();
  const double from_x = from[0], from_y = from[1], from_z = from[2];
  Sums s = sums;
  const auto add = [](double value, double d, double& plain, double& by_d) {
    plain += value;
    by_d += d * value;
  };
  for (const spatial::Neighbour& neighbour : near) {
    const double* const at = positions[neighbour.index].data();
    const double x = at[0] - from_x, y = at[1] - from_y, z = at[2] - from_z;
    const double p = static_cast<double>(probabilities[neighbour.index].data()[kind]);
    const double d = neighbour.sq_distance, px = p * x, py = p * y, pz = p * z;
    s.count += 1, s.d += d, s.most = s.most < p ? p : s.most;
    add(p, d, s.plain.p, s.by_d.p);
    add(px, d, s.plain.x, s.by_d.x);
    add(py, d, s.plain.y, s.by_d.y);
    add(pz, d, s.plain.z, s.by_d.z);
    add(px * x, d, s.plain.xx, s.by_d.xx);
    add(py * x, d, s.plain.yx, s.by_d.yx);
    add(pz * x, d, s.plain.zx, s.by_d.zx);
    add(py * y, d, s.plain.yy, s.by_d.yy);
    add(pz * y, d, s.plain.zy, s.by_d.zy);
    add(pz * z, d, s.plain.zz, s.by_d.zz);
  }
  sums = s;
}

Vec3 vector_of(const Sums::Moments& m) {
  return {m.x, m.y, m.z};
}

Mat3 matrix_of(const Sums::Moments& m) {
  Mat3 matrix;
  matrix << m.xx, m.yx, m.zx, m.yx, m.yy, m.zy, m.zx, m.zy, m.zz;
  return matrix;
}

/// The quantities behind the features of one size and kind, weighted, in units of r.
struct Surroundings {
  double share = 0, most = 0;  ///< S w p / S w, max p
  Vec3 centre = Vec3::Zero();
  Mat3 covariance = Mat3::Zero();
};

Surroundings weigh(const Sums& sums, double sq_r) {
  // Weights and lengths in units of r; a neighbourhood of copies of the point has none.
  const double falloff = sq_r > 0 ? 1.0 / (kReach * sq_r) : 0.0;
  const double scale = sq_r > 0 ? 1.0 / std::sqrt(sq_r) : 0.0;
  const double weight = sums.count - falloff * sums.d;
  const double p = sums.plain.p - falloff * sums.by_d.p;
  const double total = 1.0 / (p + kLittle);
  const Vec3 centre = scale * total * (vector_of(sums.plain) - falloff * vector_of(sums.by_d));
  return {p / weight, sums.most, centre,
          scale * scale * total * (matrix_of(sums.plain) - falloff * matrix_of(sums.by_d)) -
              centre * centre.transpose()};
}

void write_features(const Surroundings& around, const PrincipalAxes& axes, std::size_t lane,
                    double own, float* out) {
  const double l1 = std::max(0.0, axes.largest[lane]);
  const double l2 = std::max(0.0, axes.middle[lane]);
  const Vec3 along(axes.axis[0][lane], axes.axis[1][lane], axes.axis[2][lane]);
  const double clamped = std::clamp(own, kSurest, 1.0 - kSurest);
  const std::array<double, kContextFeatures> features = {
      std::log(clamped / (1.0 - clamped)),
      around.share,
      around.most,
      around.centre.norm(),
      std::sqrt(std::max(0.0, around.covariance.trace())),
      (around.centre - along * along.dot(around.centre)).norm(),
      std::sqrt(l1),
      std::sqrt(l2 / (l1 + kSurest))};
  std::transform(features.begin(), features.end(), out,
                 [](double feature) { return static_cast<float>(feature); });
}

std::vector<std::uint32_t> labelled_points(std::span<const std::uint32_t> curve,
                                           const Classification& found) {
  std::vector<std::uint32_t> points(curve.begin(), curve.end());
  std::erase_if(points, [&](std::uint32_t i) { return found.classes[i] == kUnlabelled; });
  return points;
}

}  // namespace

nn::Architecture context_architecture(int classes) {
  return {.scales = static_cast<int>(kContextSizes.size()),
          .features = kContextFeatures * (classes - 1),
          .classes = classes};
}

ContextPlaces::ContextPlaces(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
                             const Classification& found)
    : places_(spatial::places_of(positions, labelled_points(curve, found))),
      search_(places_.positions) {}

ContextMatrix::ContextMatrix(const ContextPlaces& around, const Classification& found, int classes,
                             float least_edge)
    : around_(&around), kinds_(classes - 1) {
  const spatial::Places& places = around.places();
  const auto probabilities_of = [&](std::uint32_t point) -> std::array<float, 2> {
    return {found.p_sharp[point], found.p_sharp[point] + found.p_smooth[point]};
  };
  const auto is_less_sure = [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(found.p_sharp[a], found.p_smooth[a]) <
           std::tie(found.p_sharp[b], found.p_smooth[b]);
  };
  probabilities_.resize(places.size());
  parallel_blocks(places.size(), kPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place) {
      const auto points = places.points(place);
      probabilities_[place] =
          probabilities_of(*std::max_element(points.begin(), points.end(), is_less_sure));
    }
  });
  for (std::size_t place = 0; place < places.size(); ++place) {
    for (const std::uint32_t point : places.points(place)) {
      const std::array<float, 2> own = probabilities_of(point);
      if (own[1] < least_edge || found.classes[point] > kSharpEdge) continue;
      points_.push_back(point);
      places_.push_back(static_cast<std::uint32_t>(place));
      own_.push_back(own);
    }
  }
}

void ContextMatrix::describe(std::size_t begin, std::size_t end, std::span<float> rows) const {
  const std::size_t count = around_->search().available(kContextSizes.back());
  parallel_blocks(end - begin, 1024, [&](std::size_t first, std::size_t last) {
    const auto places = std::span(places_).subspan(begin + first, last - first);
    std::vector<std::uint32_t> distinct(places.begin(), places.end());
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    std::vector<spatial::Neighbour> near(distinct.size() * count);
    around_->search().nearest_others(distinct, count, near);
    for (std::size_t i = 0, k = 0; i < places.size(); ++i) {
      if (places[i] != distinct[k]) ++k;
      describe_point(places[i], own_[begin + first + i], std::span(near).subspan(k * count, count),
                     rows.data() + (first + i) * width());
    }
  });
}

void ContextMatrix::describe_point(std::size_t place, const std::array<float, 2>& own,
                                   std::span<const spatial::Neighbour> near, float* row) const {
  const auto kinds = static_cast<std::size_t>(kinds_);
  constexpr std::size_t kSizes = kContextSizes.size();
  static_assert(2 * kSizes <= SymmetricMatrices::kLanes);
  std::array<Surroundings, SymmetricMatrices::kLanes> around;
  SymmetricMatrices covariances = {};
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    Sums sums;
    double sq_r = 0.0;
    std::size_t taken = 0;
    for (std::size_t size = 0; size < kSizes; ++size) {
      const std::size_t end = std::min(near.size(), static_cast<std::size_t>(kContextSizes[size]));
      add_nearest(near.subspan(taken, end - taken), around_->places().positions.data(),
                  probabilities_.data(), kind, place, sums);
      if (end > 0) sq_r = near[end - 1].sq_distance;
      taken = end;
      const std::size_t lane = kind * kSizes + size;
      if (sums.count > 0) around[lane] = weigh(sums, sq_r);
      covariances.set(lane, around[lane].covariance);
    }
  }
  PrincipalAxes axes;
  find_principal_axes(covariances, axes);
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    for (std::size_t size = 0; size < kSizes; ++size) {
      const std::size_t lane = kind * kSizes + size;
      float* const out = row + size * features() + kind * std::size_t{kContextFeatures};
      if (near.empty()) {
        std::fill_n(out, kContextFeatures, 0.0f);
      } else {
        write_features(around[lane], axes, lane, static_cast<double>(own[kind]), out);
      }
    }
  }
}

void apply_context(const nn::Model& network, const std::vector<std::uint8_t>& classes,
                   const ContextMatrix& matrix, Classification& result, const Progress* progress) {
  const auto points = matrix.points();
  std::vector<float> rows(std::min(kBlock, points.size()) * matrix.width());
  Stage stage(progress, "context", points.size());
  for_each_block(points.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    const auto some = std::span(rows).first((end - begin) * matrix.width());
    matrix.describe(begin, end, some);
    decide(points.subspan(begin, end - begin), nn::predict(network, some), classes, result);
    stage.advance(end - begin);
  });
}

void apply_context(const EdgeModel& model, std::span<const Vec3> positions,
                   std::span<const std::uint32_t> curve, Classification& result,
                   const Progress* progress) {
  const std::vector<std::uint8_t> classes = edge_outputs(model);
  const ContextPlaces places(positions, curve, result);
  const ContextMatrix matrix(places, result, static_cast<int>(classes.size()), model.least_edge);
  apply_context(*model.context, classes, matrix, result, progress);
}

}  // namespace pcednet::detect
