#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "pcednet/detect/prepare.h"
#include "pcednet/gls/scale_space_options.h"

namespace pcednet::detect {

/// What is known of a cloud before its points are classified.
struct CloudFacts {
  std::size_t points = std::numeric_limits<std::size_t>::max();  ///< distinct; or that many
  bool estimated = false;  ///< normals were missing and are made, or (of fewer than 20,000 points)
                           ///< the given ones are such as would be made
  bool exact = false;      ///< normals were missing, and is_exact() is true of its points
  bool noisy = false;      ///< normals were missing, and noise asks for more neighbours than usual,
                           ///< see normals::choose_neighbours()
};

/// Copies of a point do not count: they say nothing of the surface. A part of a cloud has the
/// points of the whole; a cloud of which `descriptor` gives s_min and s_max is a piece of something
/// with many.
CloudFacts facts_of(const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor);

/// The clouds that networks are for: those of which all holds that is said here.
struct CloudKind {
  std::size_t below = 0;  ///< distinct points; 0: of any number
  std::optional<bool> estimated = {};
  bool exact = false;
  bool noisy = false;

  bool has(const CloudFacts& facts) const;
  bool operator==(const CloudKind&) const = default;
};

/// "below=4000,estimated": `given` or `estimated` normals, `exact`, `noisy`, in any order.
std::string text_of(const CloudKind& kind);
std::optional<CloudKind> cloud_kind_of(std::string_view text);

/// Whether points lie on the plane faces of a model as nothing that was measured does: among those
/// of 2,000 points, evenly spread along the curve, that have 12 others near them there, one in ten
/// forms a plane with these whose thickness (see normals::PlaneFit) is below 1e-6. On parts drawn
/// without noise it is 1e-12, on the cleanest scans 1e-4.
bool is_exact(std::span<const Vec3> positions, std::span<const std::uint32_t> curve);

}  // namespace pcednet::detect
