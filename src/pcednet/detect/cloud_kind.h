#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "pcednet/detect/model.h"
#include "pcednet/detect/points/prepare.h"

namespace pcednet::detect {

/// Copies of a point do not count: they carry no information on the surface. A part of a cloud has
/// the point count of the whole; a cloud for which `descriptor` gives s_min and s_max, or whose
/// points have several octaves, is treated as a piece of a larger one.
CloudTraits traits_of(const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor);

/// "below=4000,estimated": `given` or `estimated` normals, `exact`, `noisy`, in any order.
std::string text_of(const CloudKind& kind);
std::optional<CloudKind> cloud_kind_of(std::string_view text);

}  // namespace pcednet::detect
