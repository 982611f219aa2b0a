#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "pcednet/cloud/class_table.h"
#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/output_file.h"
#include "pcednet/core/vec3.h"
#include "pcednet/lines/curves/curve.h"

namespace pcednet::render {

struct PreviewOptions {
  int width = 1280;  ///< pixels, 1 to 8192
  int height = 960;  ///< pixels, 1 to 8192
  /// The viewing direction, from the eye into the scene, of any length; z is up. Absent: see
  /// best_direction().
  std::optional<Vec3> view_direction = std::nullopt;
  Overwrite overwrite = Overwrite::kNo;
  ClassTable table = edge_classes();  ///< the classes and their colours
};

/// The viewing direction of an eye at these degrees from the x axis towards the y axis, and above
/// the horizon.
Vec3 direction_from(double azimuth, double elevation);

/// Writes a shaded picture of the cloud as a PNG.
///
/// `classes` holds one class per point, drawn in its colour (other values grey); an EdgeClass
/// white, yellow, dark red or blue. If it is empty, points have the colours of the cloud, or white
/// if it has none. Points that are not finite, far outliers, and strays (see make_surfels()) are
/// skipped. If there are more than four million points, every n-th is drawn. `curves`, in the
/// cloud's coordinates, are drawn over it: see draw_curves(). The picture does not depend on the
/// position of the cloud nor on the number of threads.
///
/// Throws Error(kInsufficient) if no point is finite, Error(kUsage) on a size out of range, a
/// direction that is zero or not finite, or an existing file that may not be overwritten, and
/// Error(kFailure) if `classes` differs in size from the cloud or the file cannot be written.
void write_preview(const std::filesystem::path& png, const PointCloud& cloud,
                   std::span<const std::uint8_t> classes, const PreviewOptions& options = {},
                   std::span<const lines::Curve> curves = {});

}  // namespace pcednet::render
