#include "lines_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common.h"
#include "number_options.h"
#include "pcednet/core/error.h"
#include "pcednet/io/length_units.h"
#include "pcednet/io/projection.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::app {
namespace {

/// The codes of "EPSG:25832" or, with heights, "EPSG:25832+7837"; 0 and 0 if they are none.
std::pair<int, int> codes_of(std::string_view word) {
  if (io::lower_case(word.substr(0, 5)) != "epsg:") return {};
  word.remove_prefix(5);
  const std::size_t plus = word.find('+');
  const int epsg = io::epsg_code(word.substr(0, plus));
  if (plus == std::string_view::npos) return {epsg, 0};
  const int heights = io::epsg_code(word.substr(plus + 1));
  return epsg > 0 && heights > 0 ? std::pair(epsg, heights) : std::pair(0, 0);
}

/// Adds --crs, which sets `system` to that of a code of EPSG, as io::system_of_code() does.
CLI::Option* add_crs_option(CLI::App& command, std::optional<io::CoordinateSystem>& system) {
  return command
      .add_option_function<std::string>(
          "--crs",
          [&system](const std::string& word) {
            const auto [epsg, heights] = codes_of(word);
            with_name_in_errors("--crs", [&] { system = io::system_of_code(epsg, heights); });
          },
          "The coordinate system, such as EPSG:25832 or, with that of the heights, "
          "EPSG:25832+7837, where the file does not name it")
      ->check(CLI::Validator(
          [](const std::string& word) {
            return codes_of(word).first > 0 ? "" : word + " is not a code such as EPSG:25832";
          },
          "EPSG:CODE[+CODE]"));
}

}  // namespace

void add_line_options(CLI::App& command, lines::LineOptions& options) {
  const CLI::Validator length = length_above_0();
  command
      .add_option("--min-length", options.min_length,
                  "Leave out shorter curves (default: from the spacing, as the two below)")
      ->check(length);
  command.add_option("--gap", options.gap, "Join edge points over gaps up to this length")
      ->check(length);
  command
      .add_option("--tolerance", options.tolerance,
                  "How far the points may be from their curve; also of the polylines that stand "
                  "for arcs in formats without arcs (default there: a thousandth of the radius, if "
                  "that is less)")
      ->check(length);
  command
      .add_option("--angle", options.angle,
                  "Split a curve where it bends by more than this many degrees")
      ->capture_default_str()
      ->check(
          number("an angle above 0, up to 180", [](double v) { return v > 0.0 && v <= 180.0; }));
  command.add_flag("--regularise", options.regularise,
                   "Make nearly parallel and nearly right angles exactly so");
  command.add_flag("--boundaries", options.boundaries,
                   "Also draw where the surface ends, on a layer of its own; --class with boundary "
                   "does the same");
  add_choice(command, "--stage", options.stage, lines::kLineStages,
             "Stop after a step and draw what it found: a short segment for each edge point, these "
             "in order, segments and arcs before they meet, or the finished curves");
}

void add_drawing_options(CLI::App& command, LinesArguments& arguments) {
  CLI::Option* classes =
      command
          .add_option("--class", arguments.classes,
                      "The classes to draw, with commas between: sharp, smooth (rounded edges, at "
                      "the cost of some that are none), boundary (where the surface ends)")
          ->delimiter(',')
          ->default_str("sharp, with --boundaries sharp,boundary")
          ->check(CLI::IsMember({"sharp", "smooth", "boundary"}));
  classes->each([&arguments](const std::string& name) {
    arguments.lines.boundaries = arguments.lines.boundaries || name == "boundary";
  });
  command
      .add_option("--kind", arguments.kinds,
                  "Keep these kinds only: segment, arc, circle, polyline, with commas between")
      ->delimiter(',')
      ->check(CLI::IsMember({"segment", "arc", "circle", "polyline"}));
  command
      .add_option("--min-confidence", arguments.min_confidence,
                  "Leave out curves whose points are edges with a lower mean probability")
      ->capture_default_str()
      ->check(share());
  command
      .add_option("--min-dihedral", arguments.min_dihedral,
                  "Leave out curves whose surfaces differ by fewer degrees in the mean")
      ->capture_default_str()
      ->check(number("an angle from 0 to 180", [](double v) { return v >= 0.0 && v <= 180.0; }));
  command
      .add_option("--min-points", arguments.min_points, "Leave out curves with fewer edge points")
      ->capture_default_str();
  const auto of_formats = [&arguments](CLI::Option* option,
                                       const std::vector<std::string>& extensions) {
    option->each([&arguments, name = option->get_name(), extensions](const std::string&) {
      arguments.of_formats.emplace_back(name, extensions);
    });
  };
  of_formats(add_choice(command, "--dxf-version", arguments.drawing.dxf_version, io::kDxfVersions,
                        "DXF: of AutoCAD 2000, which all later ones read, or R12 for old programs"),
             {".dxf"});
  of_formats(add_choice(command, "--dxf-arcs", arguments.drawing.dxf_arcs, io::kDxfArcs,
                        "DXF: all arcs and circles as such, or the flat ones (in horizontal "
                        "planes), or none; the others as polylines, for programs that misplace "
                        "arcs in tilted planes: FreeCAD and LibreCAD (flat), CloudCompare (none)"),
             {".dxf"});
  of_formats(add_choice(command, "--view", arguments.drawing.view, io::kViews,
                        "SVG: seen from above, from the front (x, z) or from the side (y, z)"),
             {".svg"});
  Choices<std::optional<io::LengthUnit>> units;
  for (const auto& entry : io::length_units()) units.emplace_back(entry.name, entry.unit);
  of_formats(
      add_choice(
          command, "--unit", arguments.drawing.unit, units,
          "DXF: the unit of the coordinates (default: that of the coordinate system of a LAS "
          "file, otherwise none); SVG: gives the drawing its true size (default: none)"),
      {".dxf", ".svg"});
  of_formats(add_crs_option(command, arguments.crs), {".gpkg", ".geojson", ".dxf"});
}

void check_format_options(const LinesArguments& arguments) {
  for (const auto& [option, extensions] : arguments.of_formats) {
    const auto is_one = [&, &its = extensions](const std::filesystem::path& output) {
      return std::find(its.begin(), its.end(), io::extension_of(output)) != its.end();
    };
    if (std::any_of(arguments.outputs.begin(), arguments.outputs.end(), is_one)) continue;
    throw Error(ErrorKind::kUsage, fmt::format("{} is for {} files, and none is an output", option,
                                               fmt::join(extensions, " ")));
  }
  if (arguments.drawing.unit && arguments.drawing.dxf_version == io::DxfVersion::kR12) {
    throw Error(ErrorKind::kUsage, "--unit has no effect with --dxf-version r12: R12 has no unit");
  }
}

}  // namespace pcednet::app
