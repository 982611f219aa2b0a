#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"

namespace pcednet::detect {

/// Coordinates rounded to multiples of a step: by a scale of LAS, by decimals of a text, or to the
/// centres of voxels.
struct Rounding {
  double step = 0.0;           ///< 0: not rounded, or too finely to matter
  Vec3 origin = Vec3::Zero();  ///< a corner of the lattice
  double spacing = 0.0;        ///< of neighbouring points, about
};

/// That averages take the place of points in thick noise, see averages.h.
struct Averaging {
  double deviation = 0.0;      ///< of the noise; 0: the points are described as they are
  Vec3 middle = Vec3::Zero();  ///< a corner of the voxels
};

/// In deviations of the noise, along each axis: an average is not farther from its points, nor from
/// those that affect it.
inline constexpr double kAveragingReach = 7.5;

/// In PreparedCloud::average_of: the point has no finite position.
inline constexpr std::uint32_t kNoAverage = std::numeric_limits<std::uint32_t>::max();

/// The decisions on normals that depend on all points of a cloud.
struct NormalsDecision {
  bool made =
      false;  ///< missing normals are estimated and all are oriented; otherwise used as they are
  std::size_t neighbours = 0;  ///< of each point, where normals are estimated
  std::size_t fewest = 0;      ///< unless 0, those of points without noise around them
  bool noisy = false;          ///< noise required more of them
  bool exact_planes = false;   ///< points on plane faces get the normal of the face
  bool exact = false;          ///< normals were missing, and the points are without noise
  Rounding rounding = {};      ///< of the positions, where normals were missing
  Averaging averaging = {};    ///< the same, before all else
  bool poles = false;          ///< crowds at the poles of scanners are left out, see averages.h
};

/// The comment of a cloud whose normals are all estimated from its positions, by this program.
inline constexpr std::string_view kEstimatedNormals = "pcednet normals estimated";
bool has_estimated_normals(const PointCloud& cloud);
/// The same for the comments of a cloud whose points are held elsewhere.
bool declares_estimated_normals(const PointCloud& outline);
/// Gives the cloud the comment, or takes it away.
void set_estimated_normals(PointCloud& cloud, bool estimated);

struct PrepareOptions {
  bool keep_orientation = false;  ///< use the cloud's normals, also mixed signs and estimates
  bool average_noise = false;     ///< of points without normals, see averages.h
  std::optional<NormalsDecision> decided = {};  ///< for the cloud that this one is part of
};

struct PartOfCloud;

/// The input of the descriptors, and the record of its preparation. The spans may be of its own
/// vectors: it can be moved, not copied. prepare() makes it; what uses it throws Error(kUsage) if
/// the spans differ in length.
struct PreparedCloud {
  std::span<const Vec3> positions;   ///< the cloud's own, or `moved`; fewer if averaged
  std::span<const Vec3> normals;     ///< the cloud's own, or `made`; unit or (0,0,0)
  std::vector<std::uint32_t> curve;  ///< the positions' order along a space-filling curve
  std::vector<Vec3> moved;           ///< empty unless positions are rounded, far out or averaged
  std::vector<Vec3> made;            ///< empty when the cloud's normals are used as they are
  std::vector<std::uint32_t> average_of;  ///< of each point of the cloud, see averages.h; or empty
  std::vector<Vec3> scanners;             ///< of the positions, if crowds at poles are left out
  std::vector<std::string> notes;         ///< for the user, one sentence each
  bool reoriented = false;                ///< the signs of the cloud's normals were mixed
  bool misfits = false;                   ///< they are used, but are not those of its points
  NormalsDecision decision = {};          ///< made here, or given
  const PartOfCloud* part = nullptr;      ///< for classify() and find_boundary(); must outlive both

  bool is_averaged() const { return !average_of.empty(); }

  PreparedCloud() = default;
  PreparedCloud(PreparedCloud&&) noexcept = default;
  PreparedCloud& operator=(PreparedCloud&&) noexcept = default;
};

/// Makes `cloud` ready for description; it must outlive the result. Where one point in a hundred or
/// more has no usable normal, missing normals are estimated from the positions and all are
/// oriented: by the scanner positions if the cloud has them. If the positions are rounded to a step
/// near the spacing, they are spread within it before.
///
/// Points so far out that they can only mean "no data" are treated as having no position. Normals
/// that are estimates, see has_estimated_normals(), are estimated again and get the signs that they
/// have unless these are mixed: the result is that of the cloud without them.
///
/// Normals with mixed signs are oriented in the same way. Signs are mixed where more flat pairs of
/// neighbours oppose than at the border of a patch, not as on the two sides of thin walls, where
/// orientation leaves less than a quarter of these pairs, and where it turns one normal in fifty or
/// more against the rest of its surface. A cloud whose normals all point inwards is not mixed.
/// Given decisions are carried out, not made again.
///
/// Throws Error(kUsage) as check_consistent() does and for a cloud without normals of which they
/// are to be used as they are, by the decision given; Error(kInsufficient) for a cloud without a
/// finite point, with a coordinate above 1e150 and, unless the decision is given, without any
/// usable or estimable normal, and Error(kCancelled) when `progress` asks to cancel.
PreparedCloud prepare(const PointCloud& cloud, const PrepareOptions& options = {},
                      const Progress* progress = nullptr);
PreparedCloud prepare(PointCloud&& cloud, const PrepareOptions& options = {},
                      const Progress* progress = nullptr) = delete;

/// Throws Error(kUsage) unless it has a normal for every position.
void check_consistent(const PreparedCloud& cloud);

/// The points of a cloud in arrays of the caller: a vector per point, or none.
struct PointArrays {
  std::span<const Vec3> positions;
  std::span<const Vec3> normals = {};  ///< unit or (0,0,0)
  std::span<const Vec3> scanners =
      {};  ///< the position of the scanner that saw the point, NaN where unknown
};

/// The same for arrays, which must outlive the result. Throws Error(kUsage) if their sizes differ.
PreparedCloud prepare(const PointArrays& cloud, const PrepareOptions& options = {},
                      const Progress* progress = nullptr);

}  // namespace pcednet::detect
