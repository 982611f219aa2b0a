#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"

namespace pcednet::detect {

/// What all points of a cloud together decide of their normals.
struct NormalsDecision {
  bool made = false;  ///< those missing are estimated and all oriented; otherwise used as they are
  std::size_t neighbours = 0;  ///< of each point, where they are made
  bool exact_planes = false;   ///< see normals::NeighbourChoice
  bool exact = false;          ///< normals were missing, and is_exact() is true of the points
};

struct PrepareOptions {
  bool keep_orientation = false;  ///< use the cloud's normals even if their signs are mixed
  std::optional<NormalsDecision> decided = {};  ///< by the cloud that this one is part of
};

struct PartOfCloud;

/// What the descriptors need of a cloud, and what had to be done to get it.
struct PreparedCloud {
  std::span<const Vec3> positions;    ///< the cloud's own
  std::span<const Vec3> normals;      ///< the cloud's own, or `made`; unit or (0,0,0)
  std::vector<std::uint32_t> curve;   ///< spatial::curve_order() of the positions
  std::vector<Vec3> made;             ///< empty when the cloud's normals are used as they are
  std::vector<std::string> notes;     ///< what the user should be told, one sentence each
  bool reoriented = false;            ///< the signs of the cloud's normals were mixed
  NormalsDecision decision = {};      ///< what was decided, or given
  const PartOfCloud* part = nullptr;  ///< for classify() and find_boundary(); must outlive both
};

/// Makes `cloud` ready for description; it must outlive the result. Where one point in a hundred or
/// more has no usable normal, those missing are estimated from the positions, and all are oriented:
/// by the scanners' places if the cloud has them.
///
/// Normals of mixed signs are oriented likewise: where more flat pairs of neighbours oppose than
/// the border of a patch makes, not as the two sides of thin walls do, orientation leaves less than
/// a quarter of them, and it turns one normal in fifty or more against the rest of its surface. A
/// cloud whose normals all point inwards is not mixed. What is decided already is only done.
///
/// Throws Error(kInsufficient) for a cloud without a finite point, or without any normal that could
/// be used or found, unless that is decided.
PreparedCloud prepare(const PointCloud& cloud, const PrepareOptions& options = {},
                      const Progress* progress = nullptr);
PreparedCloud prepare(PointCloud&& cloud, const PrepareOptions& options = {},
                      const Progress* progress = nullptr) = delete;

/// The points of a cloud in arrays that belong to someone else: a vector per point, or none.
struct PointArrays {
  std::span<const Vec3> positions;
  std::span<const Vec3> normals = {};   ///< unit or (0,0,0)
  std::span<const Vec3> scanners = {};  ///< the place that saw the point, NaN where unknown
};

/// The same for arrays, which must outlive the result. Throws Error(kUsage) if their sizes differ.
PreparedCloud prepare(const PointArrays& cloud, const PrepareOptions& options = {},
                      const Progress* progress = nullptr);

}  // namespace pcednet::detect
