#include "model_facts.h"

#include <fmt/format.h>

#include <algorithm>

namespace pcednet::app {
namespace {

bool is_predicted(const detect::EdgeModel& model, std::size_t id) {
  const auto& classes = model.classes;
  return std::find(classes.begin(), classes.end(), id) != classes.end();
}

std::size_t weights_of(const nn::Model& model) {
  return model.network.parameters.size();
}

}  // namespace

bool is_model_file(const std::filesystem::path& path) {
  return path.extension() == ".safetensors";
}

OrderedJson json_of(const std::filesystem::path& path, const detect::EdgeModel& model) {
  OrderedJson classes = OrderedJson::array();
  for (std::size_t id = 0; id < model.table.size(); ++id) {
    classes.push_back({{"id", id},
                       {"name", model.table[id].name},
                       {"colour", pcednet::text_of(model.table[id].colour)},
                       {"predicted", is_predicted(model, id)}});
  }
  return {{"file", path.string()},
          {"format", "model"},
          {"name", model.name},
          {"seed", model.seed},
          {"classes", classes},
          {"scales", model.descriptor.scales},
          {"weights", weights_of(model.network)},
          {"context_weights", model.context ? weights_of(*model.context) : 0}};
}

std::string text_of(const std::filesystem::path& path, const detect::EdgeModel& model) {
  std::string text = path.string() + "\n";
  const auto add = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<14} {}\n", name, value);
  };
  add("format", "model");
  add("name", model.name);
  for (std::size_t id = 0; id < model.table.size(); ++id) {
    const bool by_geometry = id == kBoundary && has_edges(model.table);
    add("class", fmt::format("{} {} {}{}", id, pcednet::text_of(model.table[id].colour),
                             model.table[id].name,
                             is_predicted(model, id) ? ""
                             : by_geometry           ? ", found by geometry"
                                                     : ", not learnt"));
  }
  add("scales", std::to_string(model.descriptor.scales));
  add("weights",
      fmt::format(
          "{}{}", weights_of(model.network),
          model.context ? fmt::format(" and {} for context", weights_of(*model.context)) : ""));
  return text;
}

}  // namespace pcednet::app
