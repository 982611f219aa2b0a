#pragma once

#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"

namespace pcednet::detect {

/// What the descriptors need of a cloud, and what had to be done to get it.
struct PreparedCloud {
  std::span<const Vec3> positions;  ///< the cloud's own
  std::span<const Vec3> normals;    ///< the cloud's own, or `estimated`; unit or (0,0,0)
  std::vector<Vec3> estimated;      ///< empty when the cloud's normals are used
  std::vector<std::string> notes;   ///< what the user should be told, one sentence each
};

/// Makes `cloud` ready for description; it must outlive the result. Where one point in a hundred or
/// more has no usable normal, those missing are estimated from the positions, and all are oriented:
/// by the scanners' places if the cloud has them.
/// Throws Error(kInsufficient) for a cloud without a finite point, or without any normal that could
/// be used or found.
PreparedCloud prepare(const PointCloud& cloud, const Progress* progress = nullptr);

}  // namespace pcednet::detect
