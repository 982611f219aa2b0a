#pragma once

#include "arrays.h"
#include "job.h"
#include "pcednet/detect/points/prepare.h"

namespace pcednet::python {

/// A cloud in Python's arrays: positions, normals of any length or none, and the scanner position
/// of each point or none. Refers to the arrays, which must outlive it; normals are copied only if
/// they are not of unit length.
class InputCloud {
 public:
  InputCloud(const Array<double>& xyz, const OptionalArray<double>& normals,
             const OptionalArray<double>& scanners);

  std::span<const Vec3> positions() const { return positions_; }
  std::span<const Vec3> normals() const { return made_.empty() ? normals_ : made_; }
  std::span<const Vec3> scanners() const { return scanners_; }

  /// detect::prepare() of the cloud, which must outlive the result.
  detect::PreparedCloud prepare(const detect::PrepareOptions& options,
                                const Progress* progress) const;

 private:
  std::span<const Vec3> positions_, normals_, scanners_;
  std::vector<Vec3> made_;
};

}  // namespace pcednet::python
