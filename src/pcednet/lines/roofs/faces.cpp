#include "pcednet/lines/roofs/faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"
#include "pcednet/lines/points/local_planes.h"
#include "pcednet/lines/points/plane_sums.h"
#include "pcednet/lines/roofs/folded_faces.h"
#include "pcednet/lines/roofs/plane_share.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kOthers = 16, kLocal = 8;
constexpr std::size_t kLeastSeed = 6, kLeastPoints = 10;
constexpr std::size_t kMostFaces = 100;
constexpr int kGrowths = 3, kChoices = 4;
constexpr double kQuietShare =
    0.7;  ///< quantile of what is called noise: slopes have more than levels
constexpr double kPlaneReach[] = {0.1, 4.0};  ///< of a plane: spacings at least, times the noise
constexpr double kOwnReach = 5.0;             ///< in the median distance of a face's points
constexpr double kLeastWidth = 0.35;          ///< of a face, standard deviation in spacings
constexpr double kNeighbourly = 0.5;          ///< price of a face that none of the others has
constexpr double kInside = 0.4;               ///< share of points inside that a face is fitted to
constexpr double kOnePlane = 1.25;            ///< residual of two faces as one, in theirs
constexpr double kNoFold = 0.1;  ///< sine of the angle of faces without a fold between,
constexpr double kSag = 0.15;    ///< and their residual as one, in spacings

/// Neighbours, and how flat the nearest of them lie.
std::vector<double> look_around(const OrderedPoints& cloud, Faces& result,
                                const Progress* progress) {
  result.others_of_each = cloud.available(kOthers);
  result.others.resize(cloud.size() * result.others_of_each);
  std::vector<std::uint32_t> points(cloud.size());
  std::iota(points.begin(), points.end(), 0u);
  std::vector<double> residuals(cloud.size());
  Stage stage(progress, "faces", points.size());
  cloud.for_each_neighbourhood(points, kOthers, stage,
                               [&](std::size_t i, std::span<const spatial::Neighbour> others) {
                                 PlaneSums sums{.origin = cloud.position(i)};
                                 sums.add(cloud.position(i));
                                 for (std::size_t k = 0; k < others.size(); ++k) {
                                   result.others[i * result.others_of_each + k] = others[k].index;
                                   if (k < kLocal) sums.add(cloud.position(others[k].index));
                                 }
                                 residuals[i] = fit_plane(sums).residual;
                               });
  return residuals;
}

class Growing {
 public:
  Growing(const OrderedPoints& cloud, double spacing, const Progress* progress, Faces& result)
      : cloud_(cloud),
        spacing_(spacing),
        progress_(progress),
        result_(result),
        seen_(cloud.size(), 0),
        narrow_(cloud.size(), 0) {}

  void try_at(std::uint32_t seed);

 private:
  bool is_free(std::uint32_t i) const { return result_.of_points[i] == kNoFace; }
  void spread(std::uint32_t seed, FittedPlane& plane);

  const OrderedPoints& cloud_;
  double spacing_;
  const Progress* progress_;
  Faces& result_;
  std::vector<std::uint32_t> seen_;   ///< in which spread() a point was last seen
  std::vector<std::uint8_t> narrow_;  ///< the points of growths too narrow for a face
  std::uint32_t spreads_ = 0;
  std::vector<std::uint32_t> members_;
};

/// The free points that hang together with the seed within reach of the plane, which follows them.
void Growing::spread(std::uint32_t seed, FittedPlane& plane) {
  ++spreads_;
  members_ = {seed};
  seen_[seed] = spreads_;
  PlaneSums sums{.origin = cloud_.position(seed)};
  sums.add(cloud_.position(seed));
  double next_fit = 2.0 * kLeastSeed;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    for (const std::uint32_t other : result_.near(members_[k])) {
      if (seen_[other] == spreads_ || !is_free(other)) continue;
      const Vec3& place = cloud_.position(other);
      if (std::abs(plane.normal.dot(place - plane.point)) > result_.within) continue;
      seen_[other] = spreads_;
      members_.push_back(other);
      sums.add(place);
    }
    if (sums.count() >= next_fit) {
      plane = fit_plane(sums);
      next_fit = 1.5 * sums.count();
    }
  }
  if (sums.count() >= kLeastSeed) plane = fit_plane(sums);
}

void Growing::try_at(std::uint32_t seed) {
  // Every point of a cable would grow the whole of it again.
  if (!is_free(seed) || narrow_[seed]) return;
  PlaneSums sums{.origin = cloud_.position(seed)};
  sums.add(cloud_.position(seed));
  for (const std::uint32_t other : result_.near(seed)) {
    if (is_free(other) && sums.count() <= kLocal) sums.add(cloud_.position(other));
  }
  if (sums.count() < kLeastSeed) return;
  FittedPlane plane = fit_plane(sums);
  if (plane.residual > 0.5 * result_.within || plane.width < 0.5 * kLeastWidth * spacing_) return;
  for (int growth = 0; growth < kGrowths; ++growth) {
    throw_if_cancelled(progress_);
    spread(seed, plane);
    if (members_.size() < kLeastPoints) return;
  }
  if (plane.width < kLeastWidth * spacing_) {
    for (const std::uint32_t member : members_) narrow_[member] = 1;
    return;
  }
  for (const std::uint32_t member : members_) {
    result_.of_points[member] = static_cast<std::uint32_t>(result_.faces.size());
  }
  result_.faces.push_back({plane.point, plane.normal, members_.size()});
}

/// The face of least distance and most neighbours among those beside the point.
std::uint32_t choice_of(const OrderedPoints& cloud, const Faces& faces, std::uint32_t point) {
  std::uint32_t best = kNoFace;
  double least = std::numeric_limits<double>::infinity();
  const auto near = faces.near(point);
  const auto consider = [&](std::uint32_t face) {
    if (face == kNoFace) return;
    const double part =
        std::abs(faces.faces[face].height(cloud.position(point))) / faces.faces[face].within;
    if (part > 1.0) return;
    std::size_t same = 0;
    for (const std::uint32_t other : near) same += faces.of_points[other] == face;
    const double price = part * part + kNeighbourly * (1.0 - static_cast<double>(same) /
                                                                 static_cast<double>(near.size()));
    if (price < least || (price == least && face < best)) {
      least = price;
      best = face;
    }
  };
  consider(faces.of_points[point]);
  for (const std::uint32_t other : near) consider(faces.of_points[other]);
  return best;
}

std::vector<PlaneSums> sums_of(const OrderedPoints& cloud, const Faces& faces) {
  std::vector<PlaneSums> sums(faces.faces.size());
  for (PlaneSums& of_face : sums) of_face.origin = cloud.position(0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (faces.of_points[i] != kNoFace) sums[faces.of_points[i]].add(cloud.position(i));
  }
  return sums;
}

/// Planes of least squares; faces with too few points go.
void refit(Faces& faces, const std::vector<PlaneSums>& sums) {
  std::vector<std::uint32_t> number(faces.faces.size(), kNoFace);
  std::vector<Face> kept;
  for (std::size_t f = 0; f < sums.size(); ++f) {
    if (sums[f].count() < kLeastPoints) continue;
    number[f] = static_cast<std::uint32_t>(kept.size());
    const FittedPlane plane = fit_plane(sums[f]);
    kept.push_back({plane.point, plane.normal, static_cast<std::size_t>(sums[f].count())});
    kept.back().is_curved = faces.faces[f].is_curved;
  }
  faces.faces = std::move(kept);
  for (std::uint32_t& face : faces.of_points) face = face == kNoFace ? kNoFace : number[face];
}

/// Slopes may be noisier than levels: every face gets a reach of its own.
void measure_noise(const OrderedPoints& cloud, Faces& faces, double least) {
  std::vector<std::vector<double>> heights(faces.faces.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::uint32_t f = faces.of_points[i];
    if (f != kNoFace) heights[f].push_back(std::abs(faces.faces[f].height(cloud.position(i))));
  }
  for (std::size_t f = 0; f < heights.size(); ++f) {
    const double typical = heights[f].empty() ? 0.0 : upper_median(std::move(heights[f]));
    faces.faces[f].within = std::clamp(kOwnReach * typical, least, faces.within);
  }
}

/// Every point chooses among the faces beside it; each is fitted to its points.
void choose(const OrderedPoints& cloud, double spacing, Faces& faces) {
  measure_noise(cloud, faces, kPlaneReach[0] * spacing);
  std::vector<std::uint32_t> chosen(cloud.size());
  parallel_blocks(cloud.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      chosen[i] = choice_of(cloud, faces, static_cast<std::uint32_t>(i));
    }
  });
  faces.of_points = std::move(chosen);
  refit(faces, sums_of(cloud, faces));
}

/// Unites faces that one plane explains nearly as well, or well enough where no fold is drawn.
void unite(const OrderedPoints& cloud, Faces& faces, double spacing) {
  std::vector<PlaneSums> sums = sums_of(cloud, faces);
  std::vector<std::uint32_t> into(faces.faces.size());
  std::iota(into.begin(), into.end(), 0u);
  const auto root = [&](std::uint32_t face) {
    while (into[face] != face) face = into[face];
    return face;
  };
  const double floor = 0.1 * faces.within;
  for (const auto& [pair, contacts] : count_contacts(faces)) {
    const auto& [one, other] = pair;
    const std::uint32_t a = std::min(root(one), root(other)), b = std::max(root(one), root(other));
    if (a == b) continue;
    const FittedPlane plane_a = fit_plane(sums[a]), plane_b = fit_plane(sums[b]);
    const double of_a = plane_a.residual, of_b = plane_b.residual;
    PlaneSums both = sums[a];
    both.moments += sums[b].moments;
    const double apart =
        std::sqrt((of_a * of_a * sums[a].count() + of_b * of_b * sums[b].count()) / both.count());
    const bool sags = plane_a.normal.cross(plane_b.normal).norm() < kNoFold;
    const double most = std::max(kOnePlane * std::max(apart, floor), sags ? kSag * spacing : 0.0);
    if (fit_plane(both).residual > most) continue;
    sums[a] = both;
    sums[b] = {};
    into[b] = a;
  }
  for (std::uint32_t& face : faces.of_points) face = face == kNoFace ? kNoFace : root(face);
  refit(faces, sums);
}

/// Planes through the points inside of faces only, where they suffice: a beam that meets two faces,
/// or an eave, returns a height between.
void fit_insides(const OrderedPoints& cloud, Faces& faces) {
  std::vector<PlaneSums> sums(faces.faces.size());
  for (PlaneSums& of_face : sums) of_face.origin = cloud.position(0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (faces.is_inside(i)) sums[faces.of_points[i]].add(cloud.position(i));
  }
  for (std::size_t f = 0; f < sums.size(); ++f) {
    const double least = kInside * static_cast<double>(faces.faces[f].count);
    if (sums[f].count() < std::max(2.0 * kLeastPoints, least)) continue;
    const FittedPlane plane = fit_plane(sums[f]);
    faces.faces[f].point = plane.point;
    faces.faces[f].normal = plane.normal;
  }
}

}  // namespace

bool Faces::is_inside(std::size_t point) const {
  const std::uint32_t own = of_points[point];
  return own != kNoFace && is_inside(point, own, own);
}

bool Faces::is_inside(std::size_t point, std::uint32_t a, std::uint32_t b) const {
  const auto nearest = near(point).first(kLocal);
  return std::all_of(nearest.begin(), nearest.end(), [&](std::uint32_t other) {
    return of_points[other] == a || of_points[other] == b;
  });
}

std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> count_contacts(const Faces& faces) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> contacts;
  faces.for_each_contact([&](std::uint32_t point, std::uint32_t other) {
    ++contacts[std::minmax(faces.of_points[point], faces.of_points[other])];
  });
  return contacts;
}

Faces find_faces(const OrderedPoints& cloud, const Sampling& sampling, const Progress* progress) {
  Faces faces;
  faces.of_points.assign(cloud.size(), kNoFace);
  if (cloud.size() <= kLocal) return faces;
  const std::vector<double> residuals = look_around(cloud, faces, progress);
  std::vector<std::uint32_t> seeds(cloud.size());
  std::iota(seeds.begin(), seeds.end(), 0u);
  std::stable_sort(seeds.begin(), seeds.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return residuals[a] < residuals[b]; });
  const auto quiet = static_cast<std::size_t>(kQuietShare * static_cast<double>(seeds.size()));
  faces.within =
      std::max(kPlaneReach[0] * sampling.spacing, kPlaneReach[1] * residuals[seeds[quiet]]);
  Growing growing(cloud, sampling.spacing, progress, faces);
  for (const std::uint32_t seed : seeds) {
    growing.try_at(seed);
    if (faces.faces.size() > kMostFaces) return {};
  }
  for (int round = 0; round < kChoices; ++round) {
    unite(cloud, faces, sampling.spacing);
    choose(cloud, sampling.spacing, faces);
  }
  for (int round = 0; round < kChoices && divide_folded(cloud, sampling.spacing, faces); ++round) {
    refit(faces, sums_of(cloud, faces));
    choose(cloud, sampling.spacing, faces);
  }
  fit_insides(cloud, faces);
  faces.share = plane_share(cloud, faces, sampling.spacing);
  if (straighten_folds(cloud, sampling.spacing, faces)) {
    refit(faces, sums_of(cloud, faces));
    fit_insides(cloud, faces);
  }
  return faces;
}

}  // namespace pcednet::lines
