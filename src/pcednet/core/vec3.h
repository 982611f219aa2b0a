#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace pcednet {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Orders vectors by x, then y, then z.
inline bool is_before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

}  // namespace pcednet
