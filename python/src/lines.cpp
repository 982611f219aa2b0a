#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <map>
#include <string>

#include "bindings.h"
#include "clouds.h"
#include "input_cloud.h"
#include "models.h"
#include "pcednet/core/error.h"
#include "pcednet/core/named.h"
#include "pcednet/detect/averages.h"
#include "pcednet/io/drawing/drawing.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/length_units.h"
#include "pcednet/io/projection.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::python {
namespace {

using lines::Curve;

lines::LineOptions line_options_of(const py::dict& settings) {
  lines::LineOptions options;
  options.min_length = settings["min_length"].cast<double>();
  options.gap = settings["gap"].cast<double>();
  options.angle = settings["angle"].cast<double>();
  options.tolerance = settings["tolerance"].cast<double>();
  options.regularise = settings["regularise"].cast<bool>();
  options.boundaries = settings["boundaries"].cast<bool>();
  options.stage = named(lines::kLineStages, "stage", settings["stage"].cast<std::string>());
  return options;
}

/// Curves, notes on the normals, and the tolerance of the fit. `prepared` says that positions and
/// normals come from a classification.
py::tuple find_lines(const Array<double>& xyz, bool is_float32,
                     const OptionalArray<double>& normals, const OptionalArray<double>& scanners,
                     bool prepared, const Array<std::uint8_t>& labels,
                     const OptionalArray<float>& p_sharp, const OptionalArray<float>& p_smooth,
                     const py::dict& settings, const py::object& progress, int threads) {
  const lines::LineOptions options = line_options_of(settings);
  std::vector<Curve> curves;
  std::vector<std::string> notes;
  lines::LineScale scale;
  run_job({progress, threads}, [&](const Progress* job) {
    const InputCloud cloud(xyz, normals, scanners);
    lines::EdgePoints points{.positions = cloud.positions(),
                             .normals = cloud.normals(),
                             .classes = numbers(labels),
                             .p_sharp = numbers(p_sharp),
                             .p_smooth = numbers(p_smooth),
                             .scanners = cloud.scanners()};
    detect::PreparedCloud made;
    detect::Classification fewer;
    if (!prepared) {
      made = cloud.prepare({.average_noise = true}, job);
      points.positions = made.positions;
      points.normals = made.normals;
      points.curve = made.curve;
      notes = made.notes;
    }
    if (made.is_averaged()) {
      detect::Classification given;
      given.classes.assign(points.classes.begin(), points.classes.end());
      given.p_sharp.assign(points.p_sharp.begin(), points.p_sharp.end());
      given.p_smooth.assign(points.p_smooth.begin(), points.p_smooth.end());
      fewer = of_averages(made, std::move(given));
      points.scanners = made.scanners;
      points.classes = fewer.classes;
      points.p_sharp = fewer.p_sharp;
      points.p_smooth = fewer.p_smooth;
    }
    curves = lines::find_lines(points, options, job, &scale);
    const std::string rounded = prepared ? "" : note_on_float(is_float32, made, {}, scale.spacing);
    if (!rounded.empty()) notes.push_back(rounded);
  });
  return py::make_tuple(std::move(curves), notes, scale.tolerance);
}

io::DrawingOptions drawing_of(const py::dict& settings, const Kept* kept) {
  io::DrawingOptions options;
  options.overwrite = settings["overwrite"].cast<bool>() ? Overwrite::kYes : Overwrite::kNo;
  options.tolerance = settings["tolerance"].cast<double>();
  options.fit_tolerance = settings["fit_tolerance"].cast<double>();
  options.dxf_version =
      named(io::kDxfVersions, "dxf_version", settings["dxf_version"].cast<std::string>());
  options.dxf_arcs = named(io::kDxfArcs, "dxf_arcs", settings["dxf_arcs"].cast<std::string>());
  options.view = named(io::kViews, "view", settings["view"].cast<std::string>());
  if (kept) options.coordinate_system = io::las_coordinate_system(*kept->cloud);
  if (!settings["epsg"].is_none()) {
    with_name_in_errors("epsg", [&] {
      options.coordinate_system = io::system_of_code(settings["epsg"].cast<int>());
    });
  }
  if (!settings["unit"].is_none()) {
    std::map<std::string, io::LengthUnit> units;
    for (const auto& entry : io::length_units()) units.emplace(entry.name, entry.unit);
    options.unit = named(units, "unit", settings["unit"].cast<std::string>());
  }
  return options;
}

void write_lines(const std::filesystem::path& path, const std::vector<Curve>& curves,
                 const py::dict& settings, const std::optional<Kept>& kept) {
  const io::DrawingOptions options = drawing_of(settings, kept ? &*kept : nullptr);
  run_job({py::none()}, [&](const Progress*) { io::write_drawing(path, curves, options); });
}

py::array_t<double> row(const Vec3& place) {
  return py::array_t<double>(3, place.data());
}

/// For pickles and copies.
py::tuple state_of(const Curve& curve) {
  return py::make_tuple(static_cast<int>(curve.kind), static_cast<int>(curve.edge_class),
                        give(std::vector<Vec3>(curve.points)), curve.closed, row(curve.centre),
                        row(curve.axis), curve.radius, curve.confidence, curve.dihedral_angle,
                        curve.support);
}

Curve curve_of(const py::tuple& state) {
  const auto arrays = [&](std::size_t i) { return state[i].cast<Array<double>>(); };
  const auto points = arrays(2), centre = arrays(4), axis = arrays(5);
  return {.kind = static_cast<lines::CurveKind>(state[0].cast<int>()),
          .edge_class = static_cast<EdgeClass>(state[1].cast<int>()),
          .points = {vectors(points).begin(), vectors(points).end()},
          .closed = state[3].cast<bool>(),
          .centre = vectors(centre)[0],
          .axis = vectors(axis)[0],
          .radius = state[6].cast<double>(),
          .confidence = state[7].cast<double>(),
          .dihedral_angle = state[8].cast<double>(),
          .support = state[9].cast<std::size_t>()};
}

}  // namespace

void add_lines(py::module_& module) {
  py::class_<Curve>(module, "Curve", "An edge as a curve, in the unit and place of its cloud.")
      .def(py::pickle([](const Curve& curve) { return state_of(curve); },
                      [](const py::tuple& state) { return curve_of(state); }))
      .def_property_readonly(
          "kind", [](const Curve& curve) { return lines::name_of(curve.kind); },
          "``'segment'``, ``'arc'``, ``'circle'`` or ``'polyline'``.")
      .def_property_readonly(
          "label", [](const Curve& curve) { return static_cast<int>(curve.edge_class); },
          "Its class: 1 smooth-edge, 2 sharp-edge, 3 boundary.")
      .def_property_readonly(
          "points", [](const Curve& curve) { return give(std::vector<Vec3>(curve.points)); },
          "(k, 3) float64: both ends of a segment or arc, one point of a circle, the vertices of "
          "a polyline.")
      .def_readonly("closed", &Curve::closed, "Whether it returns to its first point.")
      .def_property_readonly(
          "centre", [](const Curve& curve) { return row(curve.centre); },
          "(3,) float64: of an arc or circle.")
      .def_property_readonly(
          "axis", [](const Curve& curve) { return row(curve.axis); },
          "(3,) float64, unit: arcs and circles run counter-clockwise about it.")
      .def_readonly("radius", &Curve::radius, "Of an arc or circle, else 0.")
      .def_readonly("confidence", &Curve::confidence,
                    "Mean probability of its points to be of an edge, 0 to 1.")
      .def_readonly("dihedral_angle", &Curve::dihedral_angle,
                    "Mean angle between the normals of its two surfaces, radians; 0: flat.")
      .def_readonly("support", &Curve::support, "Edge points that it stands for.")
      .def_property_readonly("length", lines::length_of, "Its length.")
      .def(
          "sampled",
          [](const Curve& curve, double tolerance) {
            if (!(tolerance > 0.0)) {
              throw Error(ErrorKind::kUsage, "tolerance: a length above 0 is needed");
            }
            return give(lines::sampled(curve, tolerance));
          },
          py::arg("tolerance"),
          "Vertices (k, 3) of a polyline nowhere farther from the curve than `tolerance`.")
      .def("__repr__", [](const Curve& curve) {
        return py::str("<Curve {} of class {}, length {:.6g}>")
            .format(lines::name_of(curve.kind), static_cast<int>(curve.edge_class),
                    lines::length_of(curve));
      });
  module.attr("EPSG_CODES") = py::make_tuple(io::kLeastEpsgCode, io::kMostEpsgCode);
  module.def("find_lines", find_lines);
  module.def("write_lines", write_lines);
}

}  // namespace pcednet::python
