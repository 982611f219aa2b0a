#pragma once

#include <cstdint>
#include <span>

#include "pcednet/core/json.h"
#include "pcednet/core/progress.h"
#include "pcednet/detect/prepare.h"
#include "workbench/report/scene.h"

namespace pcednet::report {

/// The edges of the cloud with these classes, as lines::find_lines() finds them, and how the page
/// draws them: [{"class","length","path"}], the path's vertices as x, y, z, x, y, z, ... in
/// 65535ths of scene.size from scene.min.
OrderedJson find_drawn_lines(const detect::PreparedCloud& cloud,
                             std::span<const std::uint8_t> classes, const Scene& scene,
                             const Progress* progress = nullptr);

}  // namespace pcednet::report
