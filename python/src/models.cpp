#include "models.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.h"
#include "bindings.h"
#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/core/named.h"
#include "pcednet/detect/cloud_kind.h"
#include "pcednet/detect/points/rounding.h"
#include "pcednet/formats/cloud_facts.h"
#include "pcednet/gls/scales.h"
#include "pcednet/nn/model_file.h"
#include "pcednet/nn/predict.h"

namespace pcednet::python {
namespace {

using detect::EdgeModel;

gls::FeatureSet feature_set_of(int count) {
  for (const gls::FeatureSet set : gls::feature_sets()) {
    if (gls::feature_count(set) == count) return set;
  }
  throw Error(ErrorKind::kUsage, "features: 28, 7, 6, 4 or 3 numbers per scale are possible");
}

gls::Reconstruction reconstruction_named(const std::string& name) {
  std::vector<std::pair<std::string_view, gls::Reconstruction>> all;
  for (const std::string_view known : gls::reconstruction_names()) {
    all.emplace_back(known, *gls::reconstruction_of(known));
  }
  return named(all, "reconstruction", name);
}

/// The keyword arguments of describe().
py::dict settings_of(const gls::ScaleSpaceOptions& options) {
  py::dict settings;
  settings["scales"] = options.scales;
  settings["features"] = gls::feature_count(options.features);
  settings["reconstruction"] = gls::name_of(options.reconstruction);
  settings["gate"] = options.side_gate;
  settings["second_gate"] = options.second_gate;
  settings["s_max_ratio"] = options.range.s_max_ratio;
  settings["octaves"] = options.range.octaves;
  // What files do not keep.
  const gls::ScaleSpaceOptions usual;
  if (options.range.s_min != usual.range.s_min) settings["s_min"] = options.range.s_min;
  if (options.range.s_max != usual.range.s_max) settings["s_max"] = options.range.s_max;
  if (options.engine == gls::Engine::kExact) settings["exact"] = true;
  if (options.eps != usual.eps) settings["eps"] = options.eps;
  return settings;
}

/// The tensors of a network by the names they have in a file.
py::dict tensors_of(const nn::Model& model) {
  py::dict tensors;
  for (auto& [name, tensor] : nn::to_safetensors(model).tensors) {
    tensors[py::str(name)] =
        give<float>(std::vector<float>(tensor.values), {tensor.shape.begin(), tensor.shape.end()});
  }
  return tensors;
}

py::dict facts_of(const nn::Model& model) {
  py::dict facts;
  for (const auto& [key, value] : nn::to_safetensors(model).metadata) facts[py::str(key)] = value;
  return facts;
}

py::array_t<float> predict(const nn::Model& model, const Array<float>& rows) {
  std::vector<float> found = nn::predict(model, numbers(rows));
  const auto classes = static_cast<py::ssize_t>(model.network.architecture.classes);
  const auto samples = static_cast<py::ssize_t>(found.size()) / classes;
  return give<float>(std::move(found), {samples, classes});
}

}  // namespace

gls::ScaleSpaceOptions descriptor_of(const py::dict& settings, gls::ScaleSpaceOptions options) {
  const auto set = [&](const char* name, auto& value) {
    if (settings.contains(name)) {
      value = settings[name].cast<std::remove_reference_t<decltype(value)>>();
    }
  };
  set("scales", options.scales);
  set("s_min", options.range.s_min);
  set("s_max", options.range.s_max);
  set("s_max_ratio", options.range.s_max_ratio);
  set("octaves", options.range.octaves);
  set("gate", options.side_gate);
  set("second_gate", options.second_gate);
  set("eps", options.eps);
  if (settings.contains("features")) {
    options.features = feature_set_of(settings["features"].cast<int>());
  }
  if (settings.contains("reconstruction")) {
    options.reconstruction = reconstruction_named(settings["reconstruction"].cast<std::string>());
  }
  if (settings.contains("exact") && settings["exact"].cast<bool>()) {
    options.engine = gls::Engine::kExact;
  }
  return options;
}

std::string note_on_extent(const gls::ScaleSpaceOptions& options, std::span<const Vec3> positions,
                           const std::string& whose) {
  return gls::note_on_extent(options, bounding_box(positions).diagonal(), whose,
                             {.s_min = "s_min", .s_max = "s_max"});
}

std::string note_on_float(bool is_float32, const detect::PreparedCloud& cloud,
                          const gls::ScaleSpaceOptions& options, double s_min) {
  const auto type = is_float32 ? ScalarType::kFloat32 : ScalarType::kFloat64;
  if (!detect::may_be_too_coarse(type, cloud.decision, options.range)) return {};
  return formats::note_on_float(bounding_box(cloud.positions), s_min,
                                detect::share_of_places(cloud.positions, cloud.curve));
}

void add_models(py::module_& module) {
  module.def("write_file",
             [](const std::filesystem::path& path, const std::string& bytes, bool overwrite) {
               write_text_file(path, bytes, overwrite ? Overwrite::kYes : Overwrite::kNo);
             });
  py::class_<nn::Model>(module, "Network")
      .def_property_readonly("tensors", tensors_of)
      .def_property_readonly("metadata", facts_of)
      .def_property_readonly("weights",
                             [](const nn::Model& model) { return model.network.parameters.size(); })
      .def("predict", predict);
  py::class_<EdgeModel>(module, "EdgeModel")
      .def(py::init([](const std::filesystem::path& path) { return detect::load_model(path); }))
      .def("save",
           [](const EdgeModel& model, const std::filesystem::path& path, bool overwrite) {
             detect::save_model(path, model, overwrite ? Overwrite::kYes : Overwrite::kNo);
           })
      .def("without_context",
           [](EdgeModel model) {
             detect::drop_context(model);
             return model;
           })
      .def("with_settings",
           [](EdgeModel model, const py::dict& settings) {
             model.descriptor = descriptor_of(settings, std::move(model.descriptor));
             return model;
           })
      .def_readwrite("name", &EdgeModel::name)
      .def_readonly("seed", &EdgeModel::seed)
      .def_property_readonly("classes",
                             [](const EdgeModel& model) {
                               return std::vector<int>(model.classes.begin(), model.classes.end());
                             })
      .def_property_readonly("class_lines",
                             [](const EdgeModel& model) { return lines_of(model.table); })
      .def_property_readonly(
          "columns", [](const EdgeModel& model) { return gls::column_names(model.descriptor); })
      .def_property_readonly("descriptor",
                             [](const EdgeModel& model) { return settings_of(model.descriptor); })
      .def_readonly("network", &EdgeModel::network)
      .def_property_readonly(
          "context", [](const EdgeModel& model) { return model.context; },
          py::return_value_policy::copy);
}

}  // namespace pcednet::python
