#include "lines_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numbers>
#include <string_view>

#include "common.h"
#include "pcednet/core/counted.h"
#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::app {
namespace {

using lines::Curve;
using lines::CurveKind;

constexpr std::array kKinds = {CurveKind::kSegment, CurveKind::kArc, CurveKind::kCircle,
                               CurveKind::kPolyline};

bool is_listed(const std::vector<std::string>& names, std::string_view name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

/// The option that draws these classes, and another if it is named.
std::string class_option(const LinesArguments& arguments, const std::string& other = "") {
  std::vector<std::string> classes = arguments.classes;
  if (!arguments.lines.boundaries) std::erase(classes, "boundary");
  if (!other.empty()) classes.push_back(other);
  return fmt::format("--class {}", fmt::join(classes, ","));
}

/// How to draw rounded edges, if they are not drawn and longer than the others.
std::string hint_of_rounded(const LinesArguments& arguments, const std::vector<Curve>& curves) {
  double rounded = 0.0, others = 0.0;
  for (const Curve& curve : curves) {
    (curve.edge_class == kSmoothEdge ? rounded : others) += length_of(curve);
  }
  if (is_listed(arguments.classes, "smooth") || rounded <= others) return "";
  return fmt::format(" (rounded edges are {:.6g} long: {} draws them)", rounded,
                     class_option(arguments, "smooth"));
}

}  // namespace

void tell_labels(const std::string& file, std::span<const std::uint8_t> classes) {
  const auto others = std::count_if(classes.begin(), classes.end(), [](std::uint8_t label) {
    return label > kBoundary && label != kUnlabelled;
  });
  if (others > 0) {
    warn(
        fmt::format("{}: {} labels are not edge classes (1 smooth, 2 sharp, 3 boundary): "
                    "counted as non-edge",
                    file, others));
  }
  std::string edges;
  for (const io::LineClass& entry : io::kLineClasses) {
    const auto points = std::count(classes.begin(), classes.end(), entry.edge_class);
    if (points == 0) continue;
    edges += fmt::format("{}{} {}", edges.empty() ? "" : ", ", points, entry.name);
  }
  if (edges.empty()) {
    warn(file +
         ": its labels are used, but none is an edge class; --classify labels the cloud anew");
  } else {
    say(fmt::format("{}: its labels are used: {}; --classify finds others", file, edges));
  }
}

std::string filter_lines(const LinesArguments& arguments, const lines::LineScale& scale,
                         std::vector<Curve>& curves) {
  struct Option {
    std::string text;
    std::function<bool(const Curve&)> keeps;
  };
  const Option options[] = {
      {class_option(arguments) + hint_of_rounded(arguments, curves),
       [&](const Curve& curve) {
         const std::string_view name = io::line_class(curve.edge_class).name;
         return is_listed(arguments.classes, name.substr(0, name.find('-')));
       }},
      {fmt::format("--kind {}", fmt::join(arguments.kinds, ",")),
       [&](const Curve& curve) { return is_listed(arguments.kinds, name_of(curve.kind)); }},
      {fmt::format("--min-confidence {}", arguments.min_confidence),
       [&](const Curve& curve) { return !(curve.confidence < arguments.min_confidence); }},
      {fmt::format("--min-dihedral {}", arguments.min_dihedral),
       [&](const Curve& curve) {
         return !(curve.dihedral_angle < arguments.min_dihedral * std::numbers::pi / 180.0);
       }},
      {fmt::format("--min-points {}", arguments.min_points),
       [&](const Curve& curve) { return curve.support >= arguments.min_points; }}};
  std::vector<std::string> left_out;
  if (arguments.lines.min_length > 0.0 && scale.too_short > 0) {
    left_out.push_back(
        fmt::format("{} by --min-length {}", scale.too_short, arguments.lines.min_length));
  }
  for (const Option& option : options) {
    const auto count =
        std::erase_if(curves, [&](const Curve& curve) { return !option.keeps(curve); });
    if (count > 0) left_out.push_back(fmt::format("{} by {}", count, option.text));
  }
  return left_out.empty() ? "" : fmt::format("; left out: {}", fmt::join(left_out, ", "));
}

void warn_of_tolerance(const LinesArguments& arguments, const lines::LineScale& scale) {
  const double given = arguments.lines.tolerance, noise = scale.noise * scale.spacing;
  if (given <= 0.0 || given >= noise) return;
  warn(fmt::format(
      "--tolerance {} is below the noise of the points, {:.3g}: where no segment or arc "
      "is as near to them, edges are polylines that follow the noise",
      given, noise));
}

void report_lines(const LinesArguments& arguments, const lines::LineScale& scale,
                  const std::vector<Curve>& curves, const std::string& left_out,
                  std::span<const std::uint8_t> classes) {
  double length = 0.0;
  for (const Curve& curve : curves) length += length_of(curve);
  say(fmt::format("{}: {}, total length {:.6g}{}", arguments.input, counted(curves.size(), "curve"),
                  length, left_out));
  for (const io::LineClass& entry : io::kLineClasses) {
    std::string kinds;
    double class_length = 0.0;
    for (const CurveKind kind : kKinds) {
      std::size_t count = 0;
      for (const Curve& curve : curves) {
        if (curve.edge_class != entry.edge_class || curve.kind != kind) continue;
        ++count;
        class_length += length_of(curve);
      }
      if (count == 0) continue;
      kinds += counted(count, name_of(kind)) + ", ";
    }
    if (!kinds.empty()) say(fmt::format("  {}: {}length {:.6g}", entry.name, kinds, class_length));
  }
  if (curves.empty()) {
    const auto boundary = std::count(classes.begin(), classes.end(), kBoundary);
    const bool undrawn = boundary > 0 && !arguments.lines.boundaries;
    say(fmt::format(
        "  {}: what was written holds no lines{}",
        left_out.empty() ? "no edges" : "all curves were left out",
        undrawn ? fmt::format("; --boundaries draws where the surface ends ({} points)", boundary)
                : ""));
  }
  if (!(scale.spacing > 0.0)) return;
  say(
      fmt::format("  spacing {:.3g}, noise {:.2g} of it: min-length {:.3g}, gap {:.3g}, "
                  "tolerance {:.3g}",
                  scale.spacing, scale.noise, scale.min_length, scale.gap, scale.tolerance));
}

void report_outputs(const LinesArguments& arguments, const std::vector<Curve>& curves) {
  const std::size_t tilted = io::count_tilted(curves, arguments.drawing);
  for (const std::string& output : arguments.outputs) {
    const bool misplaces = io::extension_of(output) == ".dxf" && tilted > 0 &&
                           arguments.drawing.dxf_arcs == io::DxfArcs::kAll;
    say(fmt::format("  -> {}{}", output,
                    misplaces
                        ? fmt::format(" (FreeCAD, LibreCAD and CloudCompare misplace arcs and "
                                      "circles of tilted planes, here {}; --dxf-arcs avoids it)",
                                      tilted)
                        : ""));
  }
}

}  // namespace pcednet::app
