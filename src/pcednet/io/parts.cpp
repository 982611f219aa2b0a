#include "pcednet/io/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pcednet::io {

void finish_part(PointCloud& part, PartTally& tally) {
  const auto is_rescaled = [](const Vec3& normal) {
    const double length = normal.norm();
    return std::isfinite(length) && length > 0.0 && std::abs(length - 1.0) > 1e-3;
  };
  const auto not_finite = [](const Vec3& position) { return !position.allFinite(); };
  const auto count = [](const std::vector<Vec3>& vectors, const auto& is) {
    return static_cast<std::size_t>(std::count_if(vectors.begin(), vectors.end(), is));
  };
  tally.points += part.size();
  tally.rescaled_normals += count(part.normals, is_rescaled);
  tally.unusable_normals += make_normals_unit(part);
  tally.not_finite += count(part.positions, not_finite);
}

std::vector<std::string> warnings_of(const PartTally& tally) {
  std::vector<std::string> warnings;
  if (tally.unusable_normals > 0 && tally.unusable_normals == tally.points) {
    warnings.emplace_back("all normals are zero or not finite: treated as missing");
  } else if (tally.unusable_normals > 0) {
    warnings.push_back(fmt::format("{} of {} normals are zero or not finite",
                                   tally.unusable_normals, tally.points));
  }
  if (tally.not_finite > 0) {
    warnings.push_back(
        fmt::format("{} of {} positions are not finite", tally.not_finite, tally.points));
  }
  return warnings;
}

PartOutline outline_of(const PointCloud& cloud) {
  return {.points = cloud.size(), .first = &cloud, .each_part = [&](const auto& visit) {
            visit(cloud);
          }};
}

}  // namespace pcednet::io
