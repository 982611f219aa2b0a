#include <fmt/format.h>

#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/drawing/writers.h"

namespace pcednet::io {
namespace {

/// Without a member crs, readers would take the coordinates for degrees.
std::string crs_member(const CoordinateSystem& system) {
  if (system.epsg == 0) return "null";
  return fmt::format(R"({{"type":"name","properties":{{"name":"urn:ogc:def:crs:EPSG::{}"}}}})",
                     system.epsg);
}

void append_feature(std::string& text, const lines::Curve& curve, const DrawingOptions& options) {
  text += fmt::format(R"({{"type":"Feature","properties":{{"class":"{}","kind":"{}","length":{},)"
                      R"("confidence":{},"dihedral_angle":{},"points":{},"radius":{}}},)"
                      R"("geometry":{{"type":"LineString","coordinates":[)",
                      line_class(curve.edge_class).name, name_of(curve.kind),
                      real_digits(length_of(curve)), real_digits(curve.confidence),
                      real_digits(dihedral_degrees(curve)), curve.support,
                      curve.radius > 0.0 ? real_digits(curve.radius) : "null");
  bool is_first = true;
  for (const Vec3& p : drawn(curve, options)) {
    text += fmt::format("{}[{},{},{}]", is_first ? "" : ",", p.x(), p.y(), p.z());
    is_first = false;
  }
  text += "]}}";
}

}  // namespace

void write_geojson(const std::filesystem::path& path, Curves curves,
                   const DrawingOptions& options) {
  std::string text =
      fmt::format(R"({{"type":"FeatureCollection","name":"edges","crs":{},"features":[)",
                  crs_member(options.coordinate_system));
  for (std::size_t i = 0; i < curves.size(); ++i) {
    text += i == 0 ? "\n" : ",\n";
    append_feature(text, curves[i], options);
  }
  text += "\n]}\n";
  write_text_file(path, text, options.overwrite);
}

}  // namespace pcednet::io
