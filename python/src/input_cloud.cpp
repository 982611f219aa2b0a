#include "input_cloud.h"

#include <algorithm>
#include <cmath>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::python {
namespace {

/// The deviation that normalising leaves: normals from this library are not changed again.
constexpr double kRounding = 1e-15;

bool is_unit_or_zero(const Vec3& normal) {
  return normal.isZero(0.0) || std::abs(normal.norm() - 1.0) <= kRounding;
}

}  // namespace

InputCloud::InputCloud(const Array<double>& xyz, const OptionalArray<double>& normals,
                       const OptionalArray<double>& scanners)
    : positions_(vectors(xyz)), normals_(vectors(normals)), scanners_(vectors(scanners)) {
  if (std::all_of(normals_.begin(), normals_.end(), is_unit_or_zero)) return;
  PointCloud cloud;
  cloud.normals.assign(normals_.begin(), normals_.end());
  make_normals_unit(cloud);
  made_ = std::move(cloud.normals);
}

detect::PreparedCloud InputCloud::prepare(const detect::PrepareOptions& options,
                                          const Progress* progress) const {
  return detect::prepare(detect::PointArrays{positions_, normals(), scanners_}, options, progress);
}

}  // namespace pcednet::python
