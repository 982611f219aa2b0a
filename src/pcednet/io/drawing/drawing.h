#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pcednet/core/output_file.h"
#include "pcednet/io/coordinate_system.h"
#include "pcednet/lines/curves/curve.h"

namespace pcednet::io {

enum class DxfVersion { kR12, k2000 };

/// Which arcs and circles are such in DXF; the others are polylines. Flat ones are horizontal
/// within the tolerance of polylines, and made exactly so: for programs that take the plane of any
/// arc for horizontal (FreeCAD 0.20, LibreCAD 2.2, CloudCompare 2.11).
enum class DxfArcs { kAll, kFlat, kNone };

/// Where an SVG is seen from: above (x to the right, y up), the front (x, z) or the side (y, z).
enum class View { kTop, kFront, kSide };

/// Their names in options.
inline constexpr std::array<std::pair<std::string_view, DxfVersion>, 2> kDxfVersions = {
    {{"2000", DxfVersion::k2000}, {"r12", DxfVersion::kR12}}};
inline constexpr std::array<std::pair<std::string_view, DxfArcs>, 3> kDxfArcs = {
    {{"all", DxfArcs::kAll}, {"flat", DxfArcs::kFlat}, {"none", DxfArcs::kNone}}};
inline constexpr std::array<std::pair<std::string_view, View>, 3> kViews = {
    {{"top", View::kTop}, {"front", View::kFront}, {"side", View::kSide}}};

struct DrawingOptions {
  Overwrite overwrite = Overwrite::kNo;
  /// Formats without arcs get polylines that are nowhere farther from them; 0: a thousandth of the
  /// radius, or `fit_tolerance` if that is less.
  double tolerance = 0.0;
  double fit_tolerance = 0.0;  ///< how far points may be from the curves; 0: unknown
  DxfVersion dxf_version = DxfVersion::k2000;
  DxfArcs dxf_arcs = DxfArcs::kAll;
  /// The unit of the coordinates. DXF takes that of the coordinate system where it is absent; SVG
  /// has a size on the page only with it.
  std::optional<LengthUnit> unit = std::nullopt;
  View view = View::kTop;
  CoordinateSystem coordinate_system = {};
};

/// A format of files of lines.
struct DrawingFormat {
  std::string_view name;
  std::string_view extension;  ///< in lower case, with the dot
  void (*write)(const std::filesystem::path& path, std::span<const lines::Curve> curves,
                const DrawingOptions& options);
};

/// The whole table.
std::span<const DrawingFormat> drawing_formats();

/// The extensions, such as ".dxf .obj .ply"; `last` separates the last one.
std::string drawing_extensions(std::string_view last = " ");

/// The format to write under that name. Throws Error(kUsage) if there is none, or if this build
/// lacks it.
const DrawingFormat& drawing_format_for(const std::filesystem::path& path);

/// Writes `curves` in the format that the extension names, the same bytes each time; no curves give
/// an empty, valid file. Coordinates keep every bit, except in DXF for arcs and circles in a tilted
/// plane, which have the plane's own axes, and in SVG, whose origin is a corner of the drawing. The
/// file appears under its name only when it is complete.
///
/// Throws Error(kUsage) as drawing_format_for() does and for an existing file, Error(kFailure) when
/// the disk is full, or for an invalid curve: without points, or with numbers that are not finite.
void write_drawing(const std::filesystem::path& path, std::span<const lines::Curve> curves,
                   const DrawingOptions& options = {});

/// How many arcs and circles are not horizontal within the tolerance of polylines.
std::size_t count_tilted(std::span<const lines::Curve> curves, const DrawingOptions& options);

/// The facts that the file does not hold, as phrases: GeoJSON without an EPSG code does not tell
/// that its coordinates are no degrees. Throws Error(kUsage) as drawing_format_for().
std::vector<std::string> drawing_losses(const std::filesystem::path& path,
                                        const DrawingOptions& options);

}  // namespace pcednet::io
