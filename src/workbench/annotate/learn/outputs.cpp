#include "workbench/annotate/learn/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "pcednet/core/error.h"
#include "pcednet/nn/plan.h"

namespace pcednet::annotate {
namespace {

/// The bias of an output that no input can outweigh.
constexpr float kNever = -1e4f;

/// The bias of an output that has learnt nothing yet: one in some hundreds against an even logit.
constexpr float kUnheard = -6.0f;

/// The network with outputs for `wanted`, which hold all of `known` and more.
void add_outputs(nn::Network& network, const std::vector<std::uint8_t>& known,
                 const std::vector<std::uint8_t>& wanted) {
  const nn::Layer old = nn::make_plan(network.architecture).layers.back();
  const auto inputs = static_cast<std::size_t>(old.maps.front().length);
  const std::vector<float> before = network.parameters;
  network.architecture.classes = static_cast<int>(wanted.size());
  const nn::Layer layer = nn::make_plan(network.architecture).layers.back();
  network.parameters.resize(layer.weight);
  network.parameters.resize(layer.bias, 0.0f);
  network.parameters.resize(layer.bias + wanted.size(), kUnheard);
  for (std::size_t to = 0; to < wanted.size(); ++to) {
    const auto found = std::find(known.begin(), known.end(), wanted[to]);
    if (found == known.end()) continue;
    const auto from = static_cast<std::size_t>(found - known.begin());
    const auto weights = before.begin() + static_cast<std::ptrdiff_t>(old.weight + from * inputs);
    std::copy_n(
        weights, inputs,
        network.parameters.begin() + static_cast<std::ptrdiff_t>(layer.weight + to * inputs));
    network.parameters[layer.bias + to] = before[old.bias + from];
  }
}

}  // namespace

bool can_start(const detect::EdgeModel& model, const ClassTable& table) {
  return model.table.size() <= table.size() && has_edges(model.table) == has_edges(table) &&
         std::all_of(model.classes.begin(), model.classes.end(),
                     [&](std::uint8_t id) { return model.table[id].name == table[id].name; });
}

void check_start(const detect::EdgeModel& model, const std::string& name, const ClassTable& table) {
  if (can_start(model, table)) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("model {} knows {} and cannot be the start for {}: begin with nothing",
                          name, names_of(model.table), names_of(table)));
}

detect::EdgeModel with_outputs(detect::EdgeModel model, const ClassTable& table,
                               std::span<const std::uint8_t> labels) {
  if (!has_own_classes(table)) return model;
  std::set<std::uint8_t> ids(model.classes.begin(), model.classes.end());
  const std::size_t first = has_edges(table) ? kEdgeClasses.size() : 0;
  for (const std::uint8_t label : labels) {
    if (label >= first && label < table.size()) ids.insert(label);
  }
  const std::vector<std::uint8_t> wanted(ids.begin(), ids.end());
  if (wanted != model.classes) add_outputs(model.network.network, model.classes, wanted);
  model.classes = wanted;
  return with_names(std::move(model), table);
}

detect::EdgeModel with_classes(detect::EdgeModel model, int classes) {
  const auto& ids = model.classes;
  const auto smooth = std::find(ids.begin(), ids.end(), kSmoothEdge);
  if (classes == 3 || !has_edges(model.table) || smooth == ids.end()) return model;
  const auto silence = [&](nn::Model& first, std::optional<nn::Model>& context) {
    nn::Network& network = (context ? *context : first).network;
    network.parameters[nn::make_plan(network.architecture).layers.back().bias +
                       static_cast<std::size_t>(smooth - ids.begin())] = kNever;
  };
  silence(model.network, model.context);
  for (detect::Expert& expert : model.experts) silence(expert.network, expert.context);
  return model;
}

bool knows_smooth_edge(const detect::EdgeModel& model) {
  const auto& ids = model.classes;
  return !has_edges(model.table) || std::find(ids.begin(), ids.end(), kSmoothEdge) != ids.end();
}

detect::EdgeModel with_names(detect::EdgeModel model, const ClassTable& table) {
  model.table = table;
  auto& names = model.network.class_names;
  names.clear();
  for (const std::uint8_t id : model.classes) names.push_back(table[id].name);
  return model;
}

}  // namespace pcednet::annotate
