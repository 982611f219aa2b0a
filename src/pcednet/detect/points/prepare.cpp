#include "pcednet/detect/points/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/counted.h"
#include "pcednet/core/error.h"
#include "pcednet/core/half_space.h"
#include "pcednet/core/parallel_loops.h"
#include "pcednet/detect/points/exact_points.h"
#include "pcednet/detect/points/near_on_curve.h"
#include "pcednet/detect/points/normal_fit.h"
#include "pcednet/detect/points/points_used.h"
#include "pcednet/detect/points/rounding.h"
#include "pcednet/normals/flat_pairs.h"
#include "pcednet/normals/neighbour_count.h"
#include "pcednet/normals/prepare.h"

namespace pcednet::detect {
namespace {

/// Missing normals are estimated from one in this many; fewer do no harm.
constexpr std::size_t kShareToEstimate = 100;

// When signs count as mixed, see the header. Two patches of n points oppose in some 0.4 to 1.4 /
// sqrt(n) of the pairs, clean clouds in none to 0.06 / sqrt(n), and noise thicker than the walls in
// 6 / sqrt(n), of which orientation leaves a third.
constexpr double kBorder = 0.2;
constexpr std::size_t kFewPairs = 10;
constexpr double kWalls = 0.3;  // of one_sidedness()
constexpr std::size_t kMended = 4;
constexpr std::size_t kShareToOrient = 50;

constexpr double kMisfits = 0.5;  ///< share of flat places with wrong normals; true ones have none

struct Oriented {
  normals::PreparedNormals found;
  std::size_t faced;  ///< turned towards their scanner
};

/// How the signs of normals are found.
enum class Signs { kConsistent, kAny };

/// Estimates the normals that are missing and orients all.
Oriented complete_and_orient(const Points& cloud, const PreparedCloud& prepared, Signs signs,
                             const Progress* progress) {
  const std::vector<Vec3> scanners = cloud.scanners();
  const auto is_known = [](const Vec3& place) { return place.allFinite(); };
  normals::OrientedNormalsOptions options = {
      .choice = normals::given_neighbours(static_cast<int>(prepared.decision.neighbours)),
      .count_turned = cloud.has_normals(),
      .curve = prepared.curve};
  if (options.choice) {
    options.choice->fewest = prepared.decision.fewest;
    options.choice->noisy = prepared.decision.noisy;
    options.choice->exact_planes = prepared.decision.exact_planes;
  }
  // If every point has a scanner, the costly search for consistent signs is unnecessary.
  if (!scanners.empty() && std::all_of(scanners.begin(), scanners.end(), is_known)) {
    options.viewpoint = scanners.front();
  } else if (signs == Signs::kAny) {
    options.viewpoint = Vec3::Zero();
  }
  Oriented oriented{};
  if (cloud.has_normals()) {
    std::vector<Vec3> given(cloud.size());
    std::replace_copy_if(
        cloud.normals.begin(), cloud.normals.end(), given.begin(),
        [](const Vec3& normal) { return !is_usable(normal); }, Vec3(Vec3::Zero()));
    oriented.found =
        normals::complete_and_orient_normals(prepared.positions, given, options, progress);
  } else {
    oriented.found = normals::estimate_oriented_normals(prepared.positions, options, progress);
  }
  if (!scanners.empty()) {
    oriented.faced = normals::face_scanners(prepared.positions, oriented.found.normals, scanners);
  }
  return oriented;
}

std::string how_oriented(const Oriented& oriented) {
  if (oriented.faced == oriented.found.normals.size()) return "turned towards the scanner";
  const normals::Orientation& orientation = oriented.found.orientation;
  const std::string open = orientation.undecided == 0 ? ", outwards"
                           : orientation.components == 1
                               ? ", open: upwards"
                               : fmt::format(", {} of them open: upwards", orientation.undecided);
  std::string text = fmt::format("oriented consistently ({}{})",
                                 counted(orientation.components, "connected part"), open);
  if (oriented.faced > 0) {
    text += fmt::format("; {} of them turned towards their scanner", oriented.faced);
  }
  return text;
}

void use(Oriented&& oriented, const std::string& note, PreparedCloud& prepared) {
  prepared.notes.push_back(note);
  prepared.decision.made = true;
  prepared.decision.neighbours = oriented.found.choice.neighbours;
  prepared.decision.fewest = oriented.found.choice.fewest;
  prepared.decision.noisy = oriented.found.choice.noisy;
  prepared.decision.exact_planes = oriented.found.choice.exact_planes;
  prepared.made = std::move(oriented.found.normals);
  for (Vec3& normal : prepared.made) normal += Vec3::Zero();  // no zero keeps a minus sign
  prepared.normals = prepared.made;
}

/// Whether more flat pairs of neighbours oppose than at the border of a patch.
bool oppose_often(const normals::FlatPairs& pairs, std::span<const Vec3> normals) {
  const double border = kBorder / std::sqrt(static_cast<double>(normals.size()));
  const std::size_t opposed = pairs.opposed(normals);
  return opposed >= kFewPairs &&
         static_cast<double>(opposed) >= border * static_cast<double>(pairs.size());
}

/// Turns normals to the signs of earlier ones unless these are mixed; false if it does not.
bool take_signs(std::span<const Vec3> earlier, const PreparedCloud& prepared,
                std::vector<Vec3>& made) {
  if (earlier.empty()) return false;
  std::vector<Vec3> turned = made;
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (is_usable(earlier[i])) turned[i] = turned_to(made[i], earlier[i]);
  }
  const normals::FlatPairs pairs(prepared.positions, turned, prepared.curve);
  if (oppose_often(pairs, turned)) return false;
  made = std::move(turned);
  return true;
}

void estimate(PreparedCloud& prepared, const Points& cloud, const std::string& why,
              const Progress* progress) {
  const bool had_signs = !cloud.estimates.empty();
  Oriented oriented =
      complete_and_orient(cloud, prepared, had_signs ? Signs::kAny : Signs::kConsistent, progress);
  const bool signs = take_signs(cloud.estimates, prepared, oriented.found.normals);
  if (had_signs && !signs) {
    oriented = complete_and_orient(cloud, prepared, Signs::kConsistent, progress);
  }
  const std::string note = fmt::format(
      "{}: estimated from the {} nearest points{}", why, normals::number_of(oriented.found.choice),
      signs ? ", with the signs that they have" : " and " + how_oriented(oriented));
  use(std::move(oriented), note, prepared);
}

/// Of the points in order. They are counted as they lie in memory.
std::size_t count_usable(const PreparedCloud& prepared) {
  return count_where(prepared.normals.size(), [&](std::size_t i) {
    return is_usable(prepared.normals[i]) && prepared.positions[i].allFinite();
  });
}

std::string why_estimated(const PreparedCloud& prepared, const Points& cloud) {
  if (!cloud.estimates.empty()) return "the normals in the file are estimates";
  if (!cloud.has_normals()) return "no normals in the file";
  const std::size_t usable = count_usable(prepared);
  if (usable == 0) return "no normal is usable";
  return fmt::format("{} of {} points have no usable normal", prepared.curve.size() - usable,
                     cloud.size());
}

/// Throws where planes cannot be fitted: a double does not hold the products of squares.
void check_planes_fit(const PreparedCloud& prepared) {
  constexpr double kShortest = 1e-70, kLongest = 1e70;
  const double extent = bounding_box(prepared.positions).diagonal();
  if (extent == 0.0 || (kShortest < extent && extent < kLongest)) return;
  throw Error(ErrorKind::kInsufficient,
              fmt::format("no normals, and none can be estimated: the points extend over {:.3g}; "
                          "lengths from 1e-70 to 1e70 are possible; are the coordinates right?",
                          extent));
}

/// Estimates normals if so many are missing that it matters, `why` being the reason.
void estimate_missing(PreparedCloud& prepared, const Points& cloud, const std::string& why,
                      const Progress* progress) {
  const std::size_t finite = prepared.curve.size(), missing = finite - count_usable(prepared);
  if (missing == 0 || missing < finite / kShareToEstimate) return;
  check_planes_fit(prepared);
  prepared.decision.rounding = find_rounding(prepared.positions, prepared.curve);
  spread_positions(prepared.decision.rounding, prepared);
  prepared.decision.exact = is_exact(prepared.positions, prepared.curve);
  estimate(prepared, cloud, why, progress);
  if (count_usable(prepared) > 0) return;
  throw Error(ErrorKind::kInsufficient,
              "no normals, and none can be estimated: the points form no surface");
}

void note_unusable(PreparedCloud& prepared) {
  const std::size_t unusable = prepared.curve.size() - count_usable(prepared);
  if (unusable == 0) return;
  prepared.notes.push_back(
      fmt::format("{} of {} points have no usable normal: excluded from every neighbourhood, "
                  "but still labelled",
                  unusable, prepared.positions.size()));
}

/// Says so if the normals of the cloud are not those of its surface. The 12 nearest may all be of
/// one scan line, on the plane that the beam swept: planes of 48 must show it, too.
void note_misfits(PreparedCloud& prepared) {
  double share = 1.0;
  for (const std::size_t count : {NearOnCurve::kNear, 4 * NearOnCurve::kNear}) {
    share = std::min(share,
                     share_of_misfits(prepared.positions, prepared.normals, prepared.curve, count));
    if (share < kMisfits) return;
  }
  prepared.notes.push_back(fmt::format(
      "the normals do not belong to these points: in {:.0f} % of the flat regions they are not "
      "perpendicular to the surface",
      100.0 * share));
  prepared.misfits = true;
}

/// The number of points with another sign than before, relative to the majority of their part or,
/// if all face a scanner, of the cloud.
std::size_t count_turned(const Points& cloud, const Oriented& oriented) {
  if (oriented.faced < cloud.size()) return oriented.found.orientation.turned;
  std::size_t turned = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    turned += cloud.normals[i].dot(oriented.found.normals[i]) < 0.0;
  }
  return std::min(turned, cloud.size() - turned);
}

/// Orients the cloud's normals if their signs are mixed, see the header.
void orient_mixed(PreparedCloud& prepared, const Points& cloud, const Progress* progress) {
  const normals::FlatPairs pairs(prepared.positions, cloud.normals, prepared.curve);
  if (!oppose_often(pairs, cloud.normals)) return;
  if (pairs.one_sidedness(prepared.positions, cloud.normals) > kWalls) return;
  Oriented oriented = complete_and_orient(cloud, prepared, Signs::kConsistent, progress);
  const std::size_t turned = count_turned(cloud, oriented);
  if (pairs.opposed(oriented.found.normals) * kMended > pairs.opposed(cloud.normals)) return;
  if (turned * kShareToOrient < cloud.size()) return;
  const double percent = 100.0 * static_cast<double>(turned) / static_cast<double>(cloud.size());
  const std::string note =
      fmt::format("{:.0f} % of the normals oppose the rest of their surface: {}", percent,
                  how_oriented(oriented));
  use(std::move(oriented), note, prepared);
  prepared.reoriented = true;
}

/// Decisions for the cloud that this one is part of.
void carry_out(const NormalsDecision& decision, const Points& cloud, PreparedCloud& prepared,
               const Progress* progress) {
  prepared.decision = decision;
  const Points used = points_as_decided(cloud, prepared, progress);
  if (decision.made) estimate(prepared, used, "normals as decided", progress);
  if (prepared.normals.empty()) {
    throw Error(ErrorKind::kUsage,
                "the cloud has no normals, and the decision is to use them as they are");
  }
}

PreparedCloud prepare_points(const Points& cloud, const PrepareOptions& options,
                             const Progress* progress) {
  if (cloud.empty()) throw Error(ErrorKind::kInsufficient, "the cloud has no points");
  check_extent(cloud.positions);
  PreparedCloud prepared;
  prepared.positions = cloud.positions;
  prepared.normals = cloud.normals;
  order_finite_points(prepared);
  if (options.decided) {
    carry_out(*options.decided, cloud, prepared, progress);
    return prepared;
  }
  const Points used = options.average_noise && !cloud.has_normals()
                          ? fewer_points(cloud, prepared, progress)
                          : cloud;
  estimate_missing(prepared, used, why_estimated(prepared, cloud), progress);
  if (prepared.made.empty()) note_misfits(prepared);
  if (prepared.made.empty() && !options.keep_orientation) orient_mixed(prepared, cloud, progress);
  note_unusable(prepared);
  return prepared;
}

}  // namespace

bool declares_estimated_normals(const PointCloud& outline) {
  return std::find(outline.comments.begin(), outline.comments.end(), kEstimatedNormals) !=
         outline.comments.end();
}

bool has_estimated_normals(const PointCloud& cloud) {
  return cloud.has_normals() && declares_estimated_normals(cloud);
}

void set_estimated_normals(PointCloud& cloud, bool estimated) {
  std::erase(cloud.comments, kEstimatedNormals);
  if (estimated) cloud.comments.emplace_back(kEstimatedNormals);
}

PreparedCloud prepare(const PointCloud& cloud, const PrepareOptions& options,
                      const Progress* progress) {
  check_consistent(cloud);
  Points points = {cloud.positions, cloud.normals, [&cloud] { return scanner_of_points(cloud); }};
  const bool as_given = options.decided ? !options.decided->made : options.keep_orientation;
  if (as_given || !has_estimated_normals(cloud)) return prepare_points(points, options, progress);
  std::swap(points.normals, points.estimates);
  return prepare_points(points, options, progress);
}

void check_consistent(const PreparedCloud& cloud) {
  normals::check_size("normals", cloud.normals.size(), cloud.positions.size());
}

PreparedCloud prepare(const PointArrays& cloud, const PrepareOptions& options,
                      const Progress* progress) {
  const std::size_t points = cloud.positions.size();
  if (!cloud.normals.empty()) normals::check_size("normals", cloud.normals.size(), points);
  if (!cloud.scanners.empty()) normals::check_size("scanners", cloud.scanners.size(), points);
  const auto scanners = [&cloud] {
    return std::vector<Vec3>(cloud.scanners.begin(), cloud.scanners.end());
  };
  return prepare_points({cloud.positions, cloud.normals, scanners}, options, progress);
}

}  // namespace pcednet::detect
