#include <fmt/format.h>

#include <algorithm>

#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/drawing/writers.h"
#include "pcednet/io/length_units.h"

namespace pcednet::io {
namespace {

/// The axes to the right and up.
struct ViewAxes {
  int right, up;
};

ViewAxes axes_of(View view) {
  switch (view) {
    case View::kTop:
      return {0, 1};
    case View::kFront:
      return {0, 2};
    case View::kSide:
      break;
  }
  return {1, 2};
}

/// The sheet: its left upper corner in the cloud, its size.
struct Sheet {
  double left = 0.0, top = 0.0, width = 1.0, height = 1.0;
};

Sheet sheet_of(const BoundingBox& box, const ViewAxes& axes) {
  if (box.empty()) return {};
  const double width = box.max[axes.right] - box.min[axes.right];
  const double height = box.max[axes.up] - box.min[axes.up];
  const double larger = std::max(width, height);
  const double margin = larger > 0.0 ? 0.02 * larger : 0.5;
  return {box.min[axes.right] - margin, box.max[axes.up] + margin, width + 2.0 * margin,
          height + 2.0 * margin};
}

/// The attributes that give the sheet its true size on a page; none without a unit.
std::string size_on_page(const Sheet& sheet, const DrawingOptions& options) {
  const double metres = options.unit ? entry_of(*options.unit).metres : 0.0;
  if (!(metres > 0.0)) return {};
  return fmt::format(" width=\"{:.9g}mm\" height=\"{:.9g}mm\"", 1000.0 * metres * sheet.width,
                     1000.0 * metres * sheet.height);
}

void append_path(std::string& text, const lines::Curve& curve, const Sheet& sheet,
                 const ViewAxes& axes, const DrawingOptions& options) {
  text += "<polyline points=\"";
  bool is_first = true;
  for (const Vec3& p : drawn(curve, options)) {
    text += fmt::format("{}{},{}", is_first ? "" : " ", p[axes.right] - sheet.left,
                        sheet.top - p[axes.up]);
    is_first = false;
  }
  text += "\"/>\n";
}

}  // namespace

void write_svg(const std::filesystem::path& path, Curves curves, const DrawingOptions& options) {
  const ViewAxes axes = axes_of(options.view);
  const Sheet sheet = sheet_of(drawn_box(curves, options), axes);
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\"{}>\n"
      "<desc>{} curves; the corner at the left and the top is {} = {}, {} = {}</desc>\n",
      sheet.width, sheet.height, size_on_page(sheet, options), curves.size(), "xyz"[axes.right],
      sheet.left, "xyz"[axes.up], sheet.top);
  for (const LineClass& layer : kLineClasses) {
    text += fmt::format(
        "<g id=\"{}\" fill=\"none\" stroke=\"rgb({},{},{})\" stroke-width=\"{}\" "
        "stroke-linecap=\"round\" stroke-linejoin=\"round\">\n",
        layer.name, layer.colour[0], layer.colour[1], layer.colour[2],
        std::max(sheet.width, sheet.height) / 500.0);
    for (const lines::Curve& curve : curves) {
      if (&line_class(curve.edge_class) == &layer) append_path(text, curve, sheet, axes, options);
    }
    text += "</g>\n";
  }
  text += "</svg>\n";
  write_text_file(path, text, options.overwrite);
}

}  // namespace pcednet::io
