// lines_sample FOLDER writes the sample curves of tests/io/drawing in every format as lines.*, DXF
// in both versions, and files without curves as empty.*. Prints each curve: kind, class, closed,
// radius, centre and axis.
#include <filesystem>
#include <iostream>

#include "io/drawing/sample_curves.h"
#include "pcednet/core/error.h"
#include "pcednet/io/drawing/drawing.h"

namespace {

using namespace pcednet::io;

/// A coordinate system in the form of 2019, without a code.
constexpr const char* kWkt =
    R"(PROJCRS["a system of our own",BASEGEOGCRS["ETRS89",DATUM["European Terrestrial Reference )"
    R"(System 1989",ELLIPSOID["GRS 1980",6378137,298.257222101,LENGTHUNIT["metre",1]]]],)"
    R"(CONVERSION["ours",METHOD["Transverse Mercator"],PARAMETER["Latitude of natural origin",0,)"
    R"(ANGLEUNIT["degree",0.0174532925199433]],PARAMETER["Longitude of natural origin",10,)"
    R"(ANGLEUNIT["degree",0.0174532925199433]],PARAMETER["Scale factor at natural origin",1,)"
    R"(SCALEUNIT["unity",1]],PARAMETER["False easting",500000,LENGTHUNIT["metre",1]],)"
    R"w(PARAMETER["False northing",0,LENGTHUNIT["metre",1]]],CS[Cartesian,2],AXIS["(E)",east],)w"
    R"w(AXIS["(N)",north],LENGTHUNIT["metre",1]])w";

void write_all(const std::filesystem::path& folder,
               const std::vector<pcednet::lines::Curve>& curves, const std::string& name) {
  DrawingOptions options{.tolerance = 1e-4, .unit = LengthUnit::kMetre};
  options.coordinate_system.epsg = 25832;
  for (const DrawingFormat& format : drawing_formats()) {
    write_drawing(folder / (name + std::string(format.extension)), curves, options);
  }
  options.dxf_version = DxfVersion::kR12;
  write_drawing(folder / (name + "_r12.dxf"), curves, options);
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) return 2;
  const std::filesystem::path folder = words[1];
  const auto curves = sample_curves();
  try {
    drawing_format_for(folder / "lines.gpkg");
  } catch (const pcednet::Error& error) {
    std::cout << "skipped: " << error.what() << '\n';
    return 77;
  }
  write_all(folder, curves, "lines");
  write_all(folder, {}, "empty");
  write_drawing(folder / "own_system.gpkg", curves,
                {.coordinate_system = coordinate_system_of_wkt(kWkt)});
  write_drawing(folder / "no_system.gpkg", curves);
  std::cout.precision(17);
  for (const auto& curve : curves) {
    std::cout << name_of(curve.kind) << ' ' << static_cast<int>(curve.edge_class) << ' '
              << curve.closed << ' ' << curve.radius << ' ' << curve.centre.transpose() << ' '
              << curve.axis.transpose() << '\n';
  }
}
