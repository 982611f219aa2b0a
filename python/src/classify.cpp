#include "pcednet/detect/classify.h"

#include <pybind11/stl.h>

#include <algorithm>

#include "bindings.h"
#include "input_cloud.h"
#include "models.h"
#include "pcednet/detect/averages.h"
#include "pcednet/detect/boundary.h"
#include "pcednet/detect/describe.h"

namespace pcednet::python {
namespace {

/// The normals of a prepared cloud as an array; those of the cloud itself are copied.
py::array_t<double> normals_of(detect::PreparedCloud& prepared) {
  if (!prepared.made.empty()) return give(of_all_points(prepared, std::move(prepared.made)));
  return give(std::vector<Vec3>(prepared.normals.begin(), prepared.normals.end()));
}

py::dict classify(const detect::EdgeModel& model, const Array<double>& xyz, bool is_float32,
                  const OptionalArray<double>& normals, const OptionalArray<double>& scanners,
                  bool boundary, bool keep_orientation, const py::object& progress, int threads) {
  detect::PreparedCloud prepared;
  detect::Classification found;
  std::optional<InputCloud> cloud;
  std::string note, rounded;
  run_job({progress, threads}, [&](const Progress* job) {
    cloud.emplace(xyz, normals, scanners);
    prepared = cloud->prepare(
        {.keep_orientation = keep_orientation, .average_noise = averages_noise(model)}, job);
    note = note_on_extent(model.descriptor, prepared.positions);
    found = detect::classify(prepared, model, job);
    rounded = note_on_float(is_float32, prepared, model.descriptor, found.s_min);
    if (boundary && has_edges(model.table)) detect::mark_boundary(prepared, found, job);
    found = of_all_points(prepared, std::move(found));
  });
  for (const std::string& one : {note, rounded, found.note}) {
    if (!one.empty()) prepared.notes.push_back(one);
  }
  py::dict result;
  result["made_normals"] = !prepared.made.empty();
  result["normals"] = normals_of(prepared);
  result["moved"] = py::none();
  result["averaged"] = prepared.is_averaged();
  if (!prepared.is_averaged() && !prepared.moved.empty()) {
    result["moved"] = give(std::move(prepared.moved));
  }
  result["notes"] = prepared.notes;
  result["scales"] = py::make_tuple(found.s_min, found.s_max);
  result["labels"] = give(std::move(found.classes));
  result["p_sharp"] = give(std::move(found.p_sharp));
  result["p_smooth"] = give(std::move(found.p_smooth));
  result["p_class"] = py::none();
  if (has_own_classes(model.table)) result["p_class"] = give(std::move(found.p_class));
  return result;
}

/// Describes every point into its row of `matrix`, which is all zeros; returns the scales, of
/// octave 0 if there are several.
std::vector<double> describe_all(const detect::PreparedCloud& cloud, bool is_float32,
                                 const gls::ScaleSpaceOptions& descriptor,
                                 std::vector<std::string>& notes, std::span<float> matrix,
                                 const Progress* progress) {
  const std::size_t width = detect::row_width(descriptor);
  notes = cloud.notes;
  const std::string extent = note_on_extent(descriptor, cloud.positions);
  const auto take = [&](std::span<const std::uint32_t> points, std::span<const float> rows) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::copy_n(rows.data() + i * width, width, matrix.data() + points[i] * width);
    }
  };
  const std::vector<double> scales = detect::describe_rows(cloud, descriptor, take, progress);
  for (const auto& note : {extent, note_on_float(is_float32, cloud, descriptor, scales.front()),
                           gls::note_on(descriptor, scales, cloud.positions)}) {
    if (!note.empty()) notes.push_back(note);
  }
  return scales;
}

py::tuple describe(const Array<double>& xyz, bool is_float32, const OptionalArray<double>& normals,
                   const OptionalArray<double>& scanners, bool keep_orientation,
                   const py::dict& settings, const py::object& progress, int threads) {
  const gls::ScaleSpaceOptions descriptor = descriptor_of(settings);
  const auto points = static_cast<py::ssize_t>(vectors(xyz).size());
  std::vector<float> matrix;
  std::vector<double> scales;
  std::vector<std::string> notes;
  run_job({progress, threads}, [&](const Progress* job) {
    const InputCloud cloud(xyz, normals, scanners);
    const auto prepared = cloud.prepare({.keep_orientation = keep_orientation}, job);
    matrix.resize(prepared.positions.size() * detect::row_width(descriptor));
    scales = describe_all(prepared, is_float32, descriptor, notes, matrix, job);
  });
  const auto count = static_cast<py::ssize_t>(scales.size());
  const py::ssize_t columns = gls::column_count(descriptor);
  return py::make_tuple(give<float>(std::move(matrix), {points, count, columns}),
                        give(std::move(scales)), notes);
}

}  // namespace

void add_classify(py::module_& module) {
  module.def("classify", classify);
  module.def("describe", describe);
}

}  // namespace pcednet::python
