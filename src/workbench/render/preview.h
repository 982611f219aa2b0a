#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/output_file.h"
#include "pcednet/core/vec3.h"

namespace pcednet::render {

struct PreviewOptions {
  int width = 1280;  ///< pixels, 1 to 8192
  int height = 960;  ///< pixels, 1 to 8192
  /// Where the viewer looks, from the eye into the scene, any length; z is up. Absent: chosen so
  /// that much of the surface and of its edges is seen.
  std::optional<Vec3> view_direction = std::nullopt;
  Overwrite overwrite = Overwrite::kNo;
};

/// Writes a shaded picture of the cloud as a PNG.
///
/// `classes` holds one EdgeClass per point, drawn white, yellow and dark red (anything else grey);
/// if it is empty the cloud's own colours are drawn, or white if it has none. Points that are not
/// finite are skipped. Left out are points far outside of the rest and, where the density is even
/// but for few points, those few that are much sparser; of more than four million points every n-th
/// is drawn. The picture does not depend on where the cloud lies nor on the number of threads.
///
/// Throws Error(kInsufficient) if no point is finite, Error(kUsage) on a size out of range, a
/// direction that is zero or not finite, or an existing file that may not be overwritten, and
/// Error(kFailure) if `classes` has not the size of the cloud or the file cannot be written.
void write_preview(const std::filesystem::path& png, const PointCloud& cloud,
                   std::span<const std::uint8_t> classes, const PreviewOptions& options = {});

}  // namespace pcednet::render
