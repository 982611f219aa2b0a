#include "clouds.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <optional>
#include <span>
#include <tuple>

#include "arrays.h"
#include "bindings.h"
#include "job.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/detect/result_cloud.h"
#include "pcednet/detect/result_truth.h"
#include "pcednet/formats/labels.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/las/file.h"
#include "pcednet/io/ply/faces.h"
#include "text.h"
#include "workbench/shapes/solids/mesh_samples.h"

namespace pcednet::python {
namespace {

py::array array_of(Attribute&& attribute, std::size_t points) {
  const auto count = static_cast<py::ssize_t>(points);
  std::vector<py::ssize_t> shape = {count};
  if (attribute.components != 1) shape.push_back(static_cast<py::ssize_t>(attribute.components));
  return visit_scalar(attribute.type, [&](auto zero) -> py::array {
    return give<decltype(zero)>(std::move(attribute.bytes), shape);
  });
}

/// The number type of an array; none if files do not have it.
std::optional<ScalarType> type_of(const py::dtype& dtype) {
  for (int i = 0; i <= static_cast<int>(ScalarType::kFloat64); ++i) {
    const auto type = static_cast<ScalarType>(i);
    const py::dtype known =
        visit_scalar(type, [](auto zero) { return py::dtype::of<decltype(zero)>(); });
    if (dtype.kind() == known.kind() && dtype.itemsize() == known.itemsize()) return type;
  }
  return std::nullopt;
}

/// A C-contiguous array of a number type, a row per point.
Attribute attribute_of(const std::string& name, const py::array& values) {
  const auto type = type_of(values.dtype());
  if (!type) {
    throw Error(ErrorKind::kUsage, "attribute " + name + ": numbers of 8 to 64 bits are possible");
  }
  Attribute attribute{name, *type, 1, {}};
  if (values.ndim() == 2) attribute.components = static_cast<std::size_t>(values.shape(1));
  attribute.bytes.resize(static_cast<std::size_t>(values.nbytes()));
  if (!attribute.bytes.empty()) {
    std::memcpy(attribute.bytes.data(), values.data(), attribute.bytes.size());
  }
  return attribute;
}

/// Arrays by the names of the attributes that they become.
void add_columns(const py::dict& columns, PointCloud& cloud) {
  for (const auto& [name, values] : columns) {
    cloud.attributes.push_back(
        attribute_of(bytes_of_text(name), py::reinterpret_borrow<py::array>(values)));
  }
}

std::vector<Vec3> copied(const py::handle& array) {
  const auto found = vectors(array.cast<Array<double>>());
  return {found.begin(), found.end()};
}

/// The inverse of take_apart(); without Kept, coordinates are written as `position_type`.
PointCloud put_together(const py::dict& parts) {
  PointCloud cloud;
  if (!parts["kept"].is_none()) {
    cloud = *parts["kept"].cast<const Kept&>().cloud;
  } else if (parts["is_float32"].cast<bool>()) {
    cloud.position_type = ScalarType::kFloat32;
  }
  cloud.positions = copied(parts["xyz"]);
  if (!parts["normals"].is_none()) {
    cloud.normals = copied(parts["normals"]);
    if (!normals_are_stored(cloud)) {
      cloud.stored_normals.clear();
      make_normals_unit(cloud);
    }
  }
  if (!parts["colours"].is_none()) {
    const auto colours = parts["colours"].cast<Array<std::uint8_t>>();
    cloud.colours.resize(static_cast<std::size_t>(colours.size()) / 3);
    if (colours.size() > 0) std::memcpy(cloud.colours.data(), colours.data(), colours.nbytes());
  }
  if (!parts["labels"].is_none()) {
    const auto labels = parts["labels"].cast<Array<std::uint8_t>>();
    cloud.labels.assign(labels.data(), labels.data() + labels.size());
  }
  add_columns(parts["attributes"], cloud);
  cloud.comments = bytes_of_texts(parts["comments"]);
  cloud.scanners = copied(parts["scanners"]);
  return cloud;
}

/// What is of any part of the points, too: the header and records of LAS, the number type.
Kept kept_of_part(const Kept& whole) {
  PointCloud part;
  part.position_type = whole.cloud->position_type;
  std::copy_if(whole.cloud->foreign_elements.begin(), whole.cloud->foreign_elements.end(),
               std::back_inserter(part.foreign_elements), io::is_las_element);
  return {std::make_shared<const PointCloud>(std::move(part))};
}

/// Throws for classes that lack the edge classes or, if `alone`, have others besides; `what` is
/// made of edge classes.
void check_edges(const std::vector<std::string>& lines, const std::string& what, bool alone) {
  const ClassTable table = table_of_lines(lines);
  if (has_edges(table) && !(alone && has_own_classes(table))) return;
  throw Error(ErrorKind::kUsage,
              "labels: the classes are " + names_of(table) + "; " + what + " are of edge classes");
}

/// The names by number.
std::vector<std::string> class_names(const std::vector<std::string>& lines) {
  std::vector<std::string> names;
  for (const PointClass& one : table_of_lines(lines)) names.push_back(one.name);
  return names;
}

/// The labels that detect::truth_of_result() finds, or None, and its note; None for a cloud that is
/// no result. `columns` are arrays of its kTruthColumns and kResultColumns by name.
py::object truth_of_result(const py::list& comments, const py::dict& columns,
                           const OptionalArray<std::uint8_t>& own) {
  PointCloud cloud;
  cloud.labels.assign(numbers(own).begin(), numbers(own).end());
  cloud.comments = bytes_of_texts(comments);
  add_columns(columns, cloud);
  auto truth = detect::truth_of_result(cloud);
  if (!truth) return py::none();
  py::object labels = py::none();
  if (!truth->labels.empty()) labels = give(std::move(truth->labels));
  return py::make_tuple(labels, text_of(truth->note));
}

/// The classes and the name of the column that formats::edge_column_of() finds among these; None if
/// there is none.
py::object edge_column(const py::dict& columns, std::size_t points) {
  PointCloud cloud;
  cloud.positions.resize(points, Vec3::Zero());
  add_columns(columns, cloud);
  auto found = formats::edge_column_of(cloud);
  if (!found) return py::none();
  return py::make_tuple(give(std::move(found->classes)), text_of(found->column));
}

py::tuple state_of(const std::string& text, const std::vector<std::byte>& bytes) {
  return py::make_tuple(text_of(text),
                        py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

std::vector<std::byte> bytes_of(const py::handle& object) {
  const auto text = object.cast<std::string_view>();
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// For pickles and copies. The normals in a file are three columns of one type each.
py::tuple state_of(const Kept& kept) {
  py::list normals, elements;
  for (const Attribute& one : kept.cloud->stored_normals) {
    normals.append(
        py::make_tuple(static_cast<int>(one.type), one.components, state_of(one.name, one.bytes)));
  }
  for (const ForeignElement& one : kept.cloud->foreign_elements) {
    elements.append(state_of(one.header, one.bytes));
  }
  return py::make_tuple(static_cast<int>(kept.cloud->position_type), normals, elements);
}

Kept kept_of(const py::tuple& state) {
  PointCloud cloud;
  cloud.position_type = static_cast<ScalarType>(state[0].cast<int>());
  for (const py::handle one : state[1]) {
    const auto [type, components, rest] = one.cast<std::tuple<int, std::size_t, py::tuple>>();
    cloud.stored_normals.push_back(
        {bytes_of_text(rest[0]), static_cast<ScalarType>(type), components, bytes_of(rest[1])});
  }
  for (const py::handle one : state[2]) {
    const auto element = one.cast<py::tuple>();
    cloud.foreign_elements.push_back({bytes_of_text(element[0]), bytes_of(element[1])});
  }
  return {std::make_shared<const PointCloud>(std::move(cloud))};
}

py::tuple read(const std::filesystem::path& path) {
  io::LoadedCloud loaded;
  run_job({py::none()}, [&](const Progress*) { loaded = formats::read_cloud(path); });
  return py::make_tuple(take_apart(std::move(loaded.cloud)), texts_of(loaded.warnings));
}

/// Points on the faces of a cloud, as `pcednet convert --sample` makes them.
py::dict sample_faces(const py::dict& parts, std::size_t points, std::uint64_t seed) {
  PointCloud cloud = put_together(parts);
  run_job({py::none()}, [&](const Progress* job) {
    const auto triangles = io::triangles_of(cloud);
    if (triangles.empty()) {
      throw Error(ErrorKind::kInsufficient,
                  "no faces to sample: .obj, .off, .ply and .stl files can have faces");
    }
    cloud = shapes::sample_mesh(cloud, triangles, {.points = points, .seed = seed}, job);
    detect::set_estimated_normals(cloud, false);
  });
  return take_apart(std::move(cloud));
}

/// A result, added to the cloud as the command line does.
struct ResultParts {
  std::vector<Vec3> made = {};
  detect::Classification found = {};
  const detect::EdgeModel* model = nullptr;
};

ResultParts result_of(const py::dict& parts) {
  ResultParts result{.model = parts["model"].cast<const detect::EdgeModel*>()};
  if (parts["made_normals"].cast<bool>()) result.made = copied(parts["normals"]);
  const auto copy = [&](const char* name, auto& values) {
    using Number = typename std::remove_reference_t<decltype(values)>::value_type;
    const auto given = parts[name].cast<Array<Number>>();
    values.assign(given.data(), given.data() + given.size());
  };
  copy("labels", result.found.classes);
  copy("p_sharp", result.found.p_sharp);
  copy("p_smooth", result.found.p_smooth);
  if (!parts["p_class"].is_none()) copy("p_class", result.found.p_class);
  const auto scales = parts["scales"].cast<std::pair<double, double>>();
  std::tie(result.found.s_min, result.found.s_max) = scales;
  return result;
}

/// Returns the data that the format cannot hold.
py::list write(const std::filesystem::path& path, const py::dict& parts,
               const std::optional<py::dict>& result, bool class_colours, bool ascii,
               bool overwrite) {
  PointCloud cloud = put_together(parts);
  io::WriteOptions options{.overwrite = overwrite ? Overwrite::kYes : Overwrite::kNo,
                           .ascii = ascii};
  std::optional<ResultParts> found;
  if (result) found = result_of(*result);
  std::vector<std::string> losses;
  run_job({py::none()}, [&](const Progress*) {
    if (found) {
      detect::add_result(cloud, found->made, found->found, *found->model,
                         {.class_colours = class_colours});
      options.new_normals = found->made.empty();
    }
    check_consistent(cloud);
    losses = formats::losses(path, cloud);
    formats::write_cloud(path, cloud, options);
  });
  return texts_of(losses);
}

}  // namespace

ClassTable table_of_lines(const std::vector<std::string>& lines) {
  const auto table = table_of(lines);
  if (!table) throw Error(ErrorKind::kUsage, "classes: not a table of classes");
  return *table;
}

py::dict take_apart(PointCloud&& cloud) {
  const std::size_t points = cloud.size();
  py::dict parts, attributes;
  const auto optional = [](bool there, const auto& make) { return there ? make() : py::none(); };
  const auto rows = static_cast<py::ssize_t>(points);
  parts["normals"] =
      optional(cloud.has_normals(), [&]() -> py::object { return give(std::move(cloud.normals)); });
  parts["colours"] = optional(!cloud.colours.empty(), [&]() -> py::object {
    return give<std::uint8_t>(std::move(cloud.colours), {rows, 3});
  });
  parts["labels"] =
      optional(cloud.has_labels(), [&]() -> py::object { return give(std::move(cloud.labels)); });
  for (Attribute& attribute : cloud.attributes) {
    const py::str name = text_of(attribute.name);
    attributes[name] = array_of(std::move(attribute), points);
  }
  parts["attributes"] = attributes;
  parts["comments"] = texts_of(cloud.comments);
  parts["scanners"] = give(std::move(cloud.scanners));
  parts["is_float32"] = cloud.position_type == ScalarType::kFloat32;
  parts["xyz"] = give(std::move(cloud.positions));
  cloud.positions = {};
  cloud.normals = {};
  cloud.colours = {};
  cloud.labels = {};
  cloud.attributes = {};
  cloud.comments = {};
  cloud.scanners = {};
  parts["kept"] = Kept{std::make_shared<const PointCloud>(std::move(cloud))};
  return parts;
}

void add_clouds(py::module_& module) {
  py::class_<Kept>(module, "Kept")
      .def("of_part", kept_of_part)
      .def_property_readonly("faces", [](const Kept& kept) { return io::face_count(*kept.cloud); })
      .def(py::pickle([](const Kept& kept) { return state_of(kept); },
                      [](const py::tuple& state) { return kept_of(state); }));
  module.attr("ESTIMATED_NORMALS") = std::string(detect::kEstimatedNormals);
  module.attr("TRUTH_COLUMNS") =
      std::vector<std::string>(detect::kTruthColumns.begin(), detect::kTruthColumns.end());
  module.attr("RESULT_COLUMNS") =
      std::vector<std::string>(detect::kResultColumns.begin(), detect::kResultColumns.end());
  module.def("truth_of_result", truth_of_result);
  module.def("edge_column", edge_column);
  module.def("class_lines", [](const py::list& comments) {
    return lines_of(classes_of(bytes_of_texts(comments)));
  });
  module.def("class_names", class_names);
  module.def("check_edges", check_edges);
  module.def("read", read);
  module.def("sample_faces", sample_faces);
  module.def("write", write);
}

}  // namespace pcednet::python
