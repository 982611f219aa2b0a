#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "pcednet/detect/prepare.h"
#include "pcednet/gls/scale_space_options.h"

namespace pcednet::detect {

/// Facts about a cloud before its points are classified.
struct CloudFacts {
  std::size_t points =
      std::numeric_limits<std::size_t>::max();  ///< distinct; the maximum unless counted
  bool estimated = false;  ///< normals were missing and are estimated, or (below 20,000 points) the
                           ///< given ones agree with estimated ones
  bool exact = false;      ///< normals were missing, and is_exact() is true of the points, see
                           ///< exact_points.h
  bool noisy = false;  ///< normals were missing, and noise requires more neighbours than usual, see
                       ///< normals::choose_neighbours()
};

/// Copies of a point do not count: they carry no information on the surface. A part of a cloud has
/// the point count of the whole; a cloud for which `descriptor` gives s_min and s_max is taken for
/// a piece of a large one.
CloudFacts facts_of(const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor);

/// The kind of clouds that an expert is for: all conditions must hold.
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

}  // namespace pcednet::detect
