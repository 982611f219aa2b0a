#include "pcednet/detect/prepare.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/normals/prepare.h"

namespace pcednet::detect {
namespace {

/// One missing normal in so many is estimated; fewer are hardly missed.
constexpr std::size_t kShareToEstimate = 100;

bool is_usable(const Vec3& normal) {
  return normal.allFinite() && !normal.isZero(0.0);
}

std::string describe(const normals::Orientation& orientation) {
  const std::string open = orientation.undecided == 0
                               ? ", outwards"
                               : fmt::format(", {} of them open: upwards", orientation.undecided);
  return fmt::format("oriented ({} connected part{}{})", orientation.components,
                     orientation.components == 1 ? "" : "s", open);
}

/// Estimates the normals that are missing and orients all.
void estimate(PreparedCloud& prepared, const PointCloud& cloud, const std::string& why,
              const Progress* progress) {
  const std::vector<Vec3> scanners = scanner_of_points(cloud);
  const auto is_known = [](const Vec3& place) { return place.allFinite(); };
  normals::PrepareOptions options;
  // Where every point has a scanner the costly search for consistent signs is not needed.
  if (!scanners.empty() && std::all_of(scanners.begin(), scanners.end(), is_known)) {
    options.viewpoint = scanners.front();
  }
  const std::vector<Vec3> given =
      cloud.has_normals() ? cloud.normals : std::vector<Vec3>(cloud.size(), Vec3::Zero());
  auto found = normals::complete_and_orient_normals(prepared.positions, given, options, progress);
  std::size_t faced = 0;
  if (!scanners.empty()) {
    faced = normals::face_viewpoints(prepared.positions, found.normals, scanners);
  }
  std::string note = fmt::format("{}: estimated from the 12 nearest points and ", why);
  if (faced == cloud.size()) {
    note += "turned towards the scanner";
  } else {
    note += describe(found.orientation);
    if (faced > 0) note += fmt::format("; {} of them turned towards their scanner", faced);
  }
  prepared.notes.push_back(note);
  prepared.estimated = std::move(found.normals);
  prepared.normals = prepared.estimated;
}

}  // namespace

PreparedCloud prepare(const PointCloud& cloud, const Progress* progress) {
  check_consistent(cloud);
  if (cloud.empty()) throw Error(ErrorKind::kInsufficient, "the cloud has no points");
  const auto finite = static_cast<std::size_t>(std::count_if(
      cloud.positions.begin(), cloud.positions.end(), [](const Vec3& p) { return p.allFinite(); }));
  if (finite == 0) throw Error(ErrorKind::kInsufficient, "no point has a finite position");
  check_extent(cloud.positions);

  PreparedCloud prepared;
  prepared.positions = cloud.positions;
  prepared.normals = cloud.normals;
  if (finite < cloud.size()) {
    prepared.notes.push_back(
        fmt::format("{} of {} points have no finite position: kept, unlabelled",
                    cloud.size() - finite, cloud.size()));
  }
  const auto count_usable = [&] {
    return static_cast<std::size_t>(
        std::count_if(prepared.normals.begin(), prepared.normals.end(), is_usable));
  };
  std::size_t usable = count_usable();
  if (usable < finite && finite - usable >= finite / kShareToEstimate) {
    estimate(prepared, cloud,
             !cloud.has_normals() ? "no normals in the file"
             : usable == 0        ? "no normal is usable"
                           : fmt::format("{} of {} points have no usable normal", finite - usable,
                                         cloud.size()),
             progress);
    usable = count_usable();
    if (usable == 0) {
      throw Error(ErrorKind::kInsufficient,
                  "no normals, and none can be estimated: the points form no surface");
    }
  }
  if (usable < finite) {
    prepared.notes.push_back(
        fmt::format("{} of {} points have no usable normal: left out of every neighbourhood, "
                    "labelled all the same",
                    finite - usable, cloud.size()));
  }
  return prepared;
}

}  // namespace pcednet::detect
