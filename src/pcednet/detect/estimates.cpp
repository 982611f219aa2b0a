#include "pcednet/detect/estimates.h"

#include <cmath>
#include <numbers>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/averages.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/detect/result_truth.h"

namespace pcednet::detect {

bool has_lost_comments(const PointCloud& outline) {
  return has_result_columns(outline) && !names_model(outline);
}

bool are_estimates(const PointCloud& cloud, const Progress* progress) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  constexpr double kShare = 0.9;
  double within = 3.0 * kDegree;
  // Signs do not matter, and those towards one place are found soonest: one far aside, which is
  // below or above no point.
  const BoundingBox box = bounding_box(cloud.positions);
  const Vec3 aside = box.max + Vec3(10.0 * box.diagonal(), 0.0, 0.0);
  const std::vector<Vec3> scanners(cloud.size(), aside);
  std::vector<Vec3> made;
  try {
    PreparedCloud prepared =
        prepare(PointArrays{.positions = cloud.positions, .scanners = scanners},
                {.average_noise = true}, progress);
    if (prepared.decision.exact) return false;
    if (prepared.decision.averaging.deviation > 0.0) within = 20.0 * kDegree;
    made = of_all_points(prepared, std::move(prepared.made));
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInsufficient) throw;
    return false;  // none can be estimated
  }
  std::size_t usable = 0, same = 0;
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (!is_usable(cloud.normals[i])) continue;
    ++usable;
    same += std::abs(cloud.normals[i].dot(made[i])) > std::cos(within) ? 1 : 0;
  }
  return static_cast<double>(same) > kShare * static_cast<double>(usable);
}

void mark_estimates(PointCloud& cloud, const Progress* progress) {
  if (!cloud.has_normals() || !has_lost_comments(cloud)) return;
  if (are_estimates(cloud, progress)) set_estimated_normals(cloud, true);
}

}  // namespace pcednet::detect
