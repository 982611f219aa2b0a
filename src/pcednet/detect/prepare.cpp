#include "pcednet/detect/prepare.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "pcednet/normals/prepare.h"

namespace pcednet::detect {
namespace {

bool is_usable(const Vec3& normal) {
  return normal.allFinite() && !normal.isZero(0.0);
}

void estimate(PreparedCloud& prepared, const char* why, const Progress* progress) {
  auto found = normals::estimate_oriented_normals(prepared.positions, {}, progress);
  prepared.notes.push_back(
      fmt::format("{}: estimated from the 12 nearest points and oriented ({} connected part{}{})",
                  why, found.orientation.components, found.orientation.components == 1 ? "" : "s",
                  found.orientation.undecided == 0
                      ? std::string(", outwards")
                      : fmt::format(", {} of them open: upwards", found.orientation.undecided)));
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
  if (usable == 0) {
    estimate(prepared, cloud.has_normals() ? "no normal is usable" : "no normals in the file",
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
