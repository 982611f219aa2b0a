#include "pcednet/io/drawing/drawing.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>

#include "io/drawing/sample_curves.h"
#include "io/scratch.h"
#include "pcednet/io/drawing/read_curves.h"
#include "pcednet/io/drawing/writers.h"
#include "pcednet/io/projection.h"

namespace pcednet::io {
namespace {

using lines::Curve;
using nlohmann::json;

/// What the file must hold of the curve: its vertices, the first again at the end of a closed one.
std::vector<Vec3> vertices_of(const Curve& curve, double tolerance) {
  return sampled(curve, tolerance);
}

std::vector<Vec3> closed_up(const Curve& curve) {
  std::vector<Vec3> vertices = curve.points;
  if (curve.closed) vertices.push_back(vertices.front());
  return vertices;
}

constexpr double kTolerance = 0.01;

TEST(Drawing, ObjAndPlyGiveBackEveryBit) {
  const Scratch scratch;
  const auto curves = sample_curves();
  for (const char* name : {"a.obj", "a.ply"}) {
    write_drawing(scratch.path(name), curves, {.tolerance = kTolerance});
    const auto back = read_curves(scratch.path(name));
    ASSERT_EQ(back.size(), curves.size()) << name;
    // OBJ groups by class: sharp, smooth, boundary.
    const std::vector<std::size_t> order = std::string(name) == "a.obj"
                                               ? std::vector<std::size_t>{0, 4, 1, 3, 2}
                                               : std::vector<std::size_t>{0, 1, 2, 3, 4};
    for (std::size_t i = 0; i < back.size(); ++i) {
      const Curve& given = curves[order[i]];
      EXPECT_EQ(closed_up(back[i]), vertices_of(given, kTolerance)) << name << i;
      EXPECT_EQ(back[i].edge_class, given.edge_class) << name << i;
      EXPECT_EQ(back[i].closed, given.closed) << name << i;
    }
  }
}

TEST(Drawing, PolylinesOfArcsKeepToTheFitWhereThatIsFiner) {
  const Scratch scratch;
  const std::vector<Curve> tank = {make_circle(Vec3(3, 4, 5), Vec3::UnitZ(), 20.0)};
  const auto vertices = [&](const DrawingOptions& options) {
    write_drawing(scratch.path("a.obj"), tank, options);
    return read_curves(scratch.path("a.obj")).at(0).points.size();
  };
  const auto sides_for = [&](double tolerance) { return sampled(tank[0], tolerance).size() - 1; };
  constexpr auto kYes = Overwrite::kYes;
  EXPECT_EQ(vertices({.overwrite = kYes}), sides_for(0.02));
  EXPECT_EQ(vertices({.overwrite = kYes, .fit_tolerance = 0.002}), sides_for(0.002));
  EXPECT_EQ(vertices({.overwrite = kYes, .fit_tolerance = 0.3}), sides_for(0.02));
  EXPECT_EQ(vertices({.overwrite = kYes, .tolerance = 0.1, .fit_tolerance = 0.002}),
            sides_for(0.1));
}

TEST(Drawing, CurvesShareTheirCornersInObjAndPly) {
  const Scratch scratch;
  const Vec3 a(0.1, 0, 0), b(1, 0, 0), c(1, 1, 0);
  const std::vector<Curve> triangle = {make_polyline({a, b}, kSharpEdge),
                                       make_polyline({b, c}, kSharpEdge),
                                       make_polyline({c, a}, kSmoothEdge)};
  write_drawing(scratch.path("a.obj"), triangle);
  const std::string obj = bytes_of(scratch.path("a.obj"));
  EXPECT_TRUE(contains(obj, "\nv 0.1 0 0\nv 1 0 0\nv 1 1 0\no sharp-edge\n"));
  EXPECT_TRUE(contains(obj, "\nl 1 2\n"));
  EXPECT_TRUE(contains(obj, "\nl 3 1\n"));
  EXPECT_FALSE(contains(obj, "radius"));
  write_drawing(scratch.path("round.obj"), std::vector{make_circle(a, Vec3::UnitZ(), 0.75)});
  EXPECT_TRUE(contains(bytes_of(scratch.path("round.obj")), ", radius 0.75\nl 1 2 "));
  write_drawing(scratch.path("a.ply"), triangle);
  EXPECT_TRUE(contains(bytes_of(scratch.path("a.ply")), "element vertex 3\n"));
}

TEST(Drawing, GeoJsonHoldsAttributesAndExactCoordinates) {
  const Scratch scratch;
  const auto curves = sample_curves();
  write_drawing(scratch.path("a.geojson"), curves,
                {.tolerance = kTolerance, .coordinate_system = {.epsg = 25832}});
  const json file = json::parse(bytes_of(scratch.path("a.geojson")));
  EXPECT_EQ(file["crs"]["properties"]["name"], "urn:ogc:def:crs:EPSG::25832");
  ASSERT_EQ(file["features"].size(), curves.size());
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const json& feature = file["features"][i];
    EXPECT_EQ(feature["geometry"]["type"], "LineString");
    std::vector<Vec3> vertices;
    for (const json& p : feature["geometry"]["coordinates"]) {
      vertices.emplace_back(p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>());
    }
    EXPECT_EQ(vertices, vertices_of(curves[i], kTolerance));
  }
  const json& first = file["features"][0]["properties"];
  EXPECT_EQ(first["class"], "sharp-edge");
  EXPECT_EQ(first["kind"], "segment");
  EXPECT_EQ(first["points"], 123);
  EXPECT_EQ(first["confidence"], 0.9375);
  EXPECT_DOUBLE_EQ(first["dihedral_angle"], 90.0);
  EXPECT_DOUBLE_EQ(first["length"], (curves[0].points[1] - curves[0].points[0]).norm());
  EXPECT_TRUE(first["radius"].is_null());
  const json& circle = file["features"][4]["properties"];
  EXPECT_EQ(circle["radius"], 0.75);
  EXPECT_DOUBLE_EQ(circle["length"], 1.5 * std::numbers::pi);
}

TEST(Drawing, GeoJsonWithoutACodeIsALoss) {
  EXPECT_EQ(drawing_losses("a.geojson", {.coordinate_system = {.epsg = 25832}}).size(), 0u);
  EXPECT_EQ(drawing_losses("a.svg", {}).size(), 0u);
  const auto losses = drawing_losses("a.geojson", {.coordinate_system = {.wkt = "PROJCS[]"}});
  ASSERT_EQ(losses.size(), 1u);
  EXPECT_TRUE(contains(losses[0], "degrees of WGS 84"));
}

// What must hold with PROJ and SQLite, and what without.
TEST(Drawing, GeoPackageDefinesASystemThatHasACodeOnly) {
  const Scratch scratch;
  const auto write = [&] {
    write_drawing(scratch.path("a.gpkg"), sample_curves(), {.coordinate_system = {.epsg = 25832}});
  };
  if (has_geopackage()) {
    write();
  } else {
    error_of(ErrorKind::kUsage, write);
  }
  const std::string bytes = bytes_of(scratch.path("a.gpkg"));
  EXPECT_EQ(contains(bytes, "EPSG:25832"), has_geopackage());
  EXPECT_EQ(contains(bytes, "PROJCS[\"ETRS89 / UTM zone 32N\""),
            has_geopackage() && has_projections());
}

TEST(Drawing, GeoPackageHasNoSystemWhereHeightsAloneHaveOne) {
  if (!has_geopackage()) return;
  const Scratch scratch;
  const std::string vertical =
      R"(VERT_CS["DHHN2016",VERT_DATUM["D",2005],UNIT["metre",1],AXIS["Up",UP]])";
  const auto bytes_with = [&](const std::string& name, const CoordinateSystem& system) {
    write_drawing(scratch.path(name), sample_curves(), {.coordinate_system = system});
    return bytes_of(scratch.path(name));
  };
  const std::string none = bytes_with("none.gpkg", {});
  EXPECT_EQ(bytes_with("wkt.gpkg", coordinate_system_of_wkt(vertical)), none);
  EXPECT_EQ(bytes_with("code.gpkg", {.vertical_epsg = 7837}), none);
  EXPECT_TRUE(contains(bytes_with("own.gpkg", {.wkt = "LOCAL_CS[\"site\"]"}), "LOCAL_CS"));
}

TEST(Drawing, SvgShowsTheView) {
  const Scratch scratch;
  const std::vector<Curve> curves = {
      make_polyline({Vec3(10, 20, 40), Vec3(14, 22, 40)}, kSharpEdge),
      make_polyline({Vec3(10, 20, 40), Vec3(10, 20, 43)}, kBoundary)};
  const struct {
    View view;
    const char *box, *sharp, *boundary;
  } views[] = {{View::kTop, "0 0 4.16 2.16", "0.08,2.08 4.08,0.08", "0.08,2.08 0.08,2.08"},
               {View::kFront, "0 0 4.16 3.16", "0.08,3.08 4.08,3.08", "0.08,3.08 0.08,0.08"},
               {View::kSide, "0 0 2.12 3.12", "0.06,3.06 2.06,3.06", "0.06,3.06 0.06,0.06"}};
  const std::regex number("-?[0-9]+(\\.[0-9]+)?(e-?[0-9]+)?");
  const auto numbers_after = [&](const std::string& text, const std::string& start) {
    std::vector<double> values;
    const std::size_t begin = text.find(start) + start.size();
    const std::string part = text.substr(begin, text.find('"', begin) - begin);
    for (std::sregex_iterator it(part.begin(), part.end(), number), end; it != end; ++it) {
      values.push_back(std::stod(it->str()));
    }
    return values;
  };
  const auto expect_near = [](const std::vector<double>& found, const std::vector<double>& wanted) {
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-12);
  };
  for (const auto& [view, box, sharp, boundary] : views) {
    write_drawing(scratch.path("a.svg"), curves, {.overwrite = Overwrite::kYes, .view = view});
    const std::string svg = bytes_of(scratch.path("a.svg"));
    const auto wanted = [&](const char* text) {
      return numbers_after(std::string(text) + '"', "");
    };
    expect_near(numbers_after(svg, "viewBox=\""), wanted(box));
    const std::size_t layer = svg.find("<g id=\"sharp-edge\"");
    EXPECT_TRUE(contains(svg.substr(layer, 80), "rgb(168,0,0)"));
    expect_near(numbers_after(svg.substr(layer), "points=\""), wanted(sharp));
    expect_near(numbers_after(svg.substr(svg.find("<g id=\"boundary\"")), "points=\""),
                wanted(boundary));
  }
}

TEST(Drawing, SvgHasItsTrueSizeInAUnit) {
  const Scratch scratch;
  const std::vector<Curve> curves = {
      make_polyline({Vec3(10, 20, 40), Vec3(110, 70, 40)}, kSharpEdge)};
  const auto head = [&](std::optional<LengthUnit> unit, CoordinateSystem system = {}) {
    write_drawing(scratch.path("a.svg"), curves,
                  {.overwrite = Overwrite::kYes, .unit = unit, .coordinate_system = system});
    const std::string svg = bytes_of(scratch.path("a.svg"));
    return svg.substr(0, svg.find('>'));
  };
  EXPECT_TRUE(head(LengthUnit::kMillimetre).ends_with(" width=\"104mm\" height=\"54mm\""));
  EXPECT_TRUE(head(LengthUnit::kInch).ends_with(" width=\"2641.6mm\" height=\"1371.6mm\""));
  for (const auto& plain :
       {head({}), head(LengthUnit::kNone), head({}, {.unit = LengthUnit::kMetre})}) {
    EXPECT_FALSE(contains(plain, "width"));
  }
}

/// The formats that this build writes.
std::vector<std::string> names() {
  std::vector<std::string> names;
  for (const DrawingFormat& format : drawing_formats()) {
    try {
      drawing_format_for("a" + std::string(format.extension));
      names.push_back("a" + std::string(format.extension));
    } catch (const Error& error) {
      EXPECT_TRUE(contains(error.what(), "SQLite")) << error.what();
    }
  }
  return names;
}

TEST(Drawing, NoCurvesGiveAFileAndTheSameCurvesTheSameBytes) {
  const Scratch scratch;
  EXPECT_GE(names().size(), 5u);
  for (const std::string& name : names()) {
    write_drawing(scratch.path(name), {});
    const std::string empty = bytes_of(scratch.path(name));
    EXPECT_FALSE(empty.empty()) << name;
    const auto write = [&] {
      write_drawing(scratch.path(name), sample_curves(), {.overwrite = Overwrite::kYes});
      return bytes_of(scratch.path(name));
    };
    const std::string once = write();
    EXPECT_EQ(once, write()) << name;
    EXPECT_NE(once, empty) << name;
  }
  write_drawing(scratch.path("empty.obj"), {});
  EXPECT_TRUE(read_curves(scratch.path("empty.obj")).empty());
  write_drawing(scratch.path("empty.ply"), {});
  EXPECT_TRUE(read_curves(scratch.path("empty.ply")).empty());
  write_drawing(scratch.path("empty.geojson"), {});
  const json empty = json::parse(bytes_of(scratch.path("empty.geojson")));
  EXPECT_TRUE(empty["features"].empty());
  EXPECT_TRUE(empty["crs"].is_null());
}

TEST(Drawing, RefusesExistingFilesAndOtherNames) {
  const Scratch scratch;
  for (const std::string& name : names()) {
    scratch.file(name, "precious");
    const std::string said =
        error_of(ErrorKind::kUsage, [&] { write_drawing(scratch.path(name), sample_curves()); });
    EXPECT_TRUE(contains(said, name)) << said;
    EXPECT_EQ(bytes_of(scratch.path(name)), "precious");
  }
  const std::string said =
      error_of(ErrorKind::kUsage, [&] { write_drawing(scratch.path("a.shp"), {}); });
  EXPECT_TRUE(contains(said, ".gpkg or .svg")) << said;
}

TEST(Drawing, RefusesCurvesThatAreNone) {
  const Scratch scratch;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::vector<Curve>> broken(7, sample_curves());
  broken[0][1].points.clear();
  broken[1][0].points.pop_back();
  broken[2][2].points[1].z() = nan;
  broken[3][3].radius = 0.0;
  broken[4][3].axis = Vec3::Zero();
  broken[5][4].centre.x() = std::numeric_limits<double>::infinity();
  broken[6][0].confidence = nan;
  for (const auto& curves : broken) {
    for (const std::string& name : names()) {
      const std::string said =
          error_of(ErrorKind::kFailure, [&] { write_drawing(scratch.path(name), curves); });
      EXPECT_TRUE(contains(said, "curve ")) << said;
      EXPECT_FALSE(std::filesystem::exists(scratch.path(name)));
    }
  }
}

/// Limits how large a file may grow, as a full disk does.
class SmallFiles {
 public:
  SmallFiles() : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{256, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallFiles(const SmallFiles&) = delete;
  SmallFiles& operator=(const SmallFiles&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_ = {};
};

TEST(Drawing, AFullDiskIsAnErrorThatLeavesNothing) {
  const Scratch scratch;
  for (const std::string& name : names()) {
    const std::string said = error_of(ErrorKind::kFailure, [&] {
      const SmallFiles small;
      write_drawing(scratch.path(name), sample_curves());
    });
    EXPECT_TRUE(contains(said, name)) << said;
  }
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path("")));
}

}  // namespace
}  // namespace pcednet::io
