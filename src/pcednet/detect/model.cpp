#include "pcednet/detect/model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/core/version.h"
#include "pcednet/detect/cloud_kind.h"
#include "pcednet/detect/context.h"
#include "pcednet/detect/outputs.h"
#include "pcednet/gls/oriented_points.h"
#include "pcednet/nn/metadata.h"
#include "pcednet/nn/model_file.h"

namespace pcednet::detect {
namespace {

constexpr const char* kFormat = "pcednet-edge-model-1";
constexpr const char* kContextFormat = "pcednet-edge-model-2";  // with a context network
constexpr const char* kExpertFormat = "pcednet-edge-model-4";   // with experts
constexpr const char* kPiecesFormat = "pcednet-edge-model-5";   // with a network for pieces
constexpr const char* kOwnFormat = "pcednet-class-model-1";     // with own classes
constexpr const char* kOwnContextFormat = "pcednet-class-model-2";
constexpr std::string_view kContext = "context.", kPieces = "pieces.";
constexpr const char* kKind = "kind";  // of experts
const std::array<std::vector<std::uint8_t>, 2> kClassLists = {
    {{kNonEdge, kSmoothEdge, kSharpEdge}, {kNonEdge, kSharpEdge}}};

std::string text_of(const std::vector<std::uint8_t>& classes) {
  return fmt::format("{}", fmt::join(classes, " "));
}

std::string names_of(gls::FeatureSet set) {
  return fmt::format("{}", fmt::join(gls::feature_names(set), " "));
}

gls::FeatureSet take_features(nn::Metadata& metadata) {
  const std::string key = "descriptor_features", names = metadata.take(key);
  for (const gls::FeatureSet set : gls::feature_sets()) {
    if (names == names_of(set)) return set;
  }
  metadata.refuse_value(key, names);
}

gls::Reconstruction take_reconstruction(nn::Metadata& metadata) {
  const std::string key = "descriptor_reconstruction", name = metadata.take(key);
  if (const auto found = gls::reconstruction_of(name)) return *found;
  metadata.refuse_value(key, name);
}

struct Parts {
  bool context = false, experts = false, pieces = false;
};

const char* format_of(bool has_own_classes, const Parts& parts) {
  if (has_own_classes) return parts.context ? kOwnContextFormat : kOwnFormat;
  if (parts.pieces) return kPiecesFormat;
  if (parts.experts) return kExpertFormat;
  return parts.context ? kContextFormat : kFormat;
}

std::string expert_prefix(std::size_t number) {
  return fmt::format("expert{}.", number + 1);
}

/// Every line of a text, which ends with one.
std::vector<std::string> lines_in(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != std::string::npos;) {
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

ClassTable take_table(nn::Metadata& metadata) {
  const std::string key = "class_table", text = metadata.take(key);
  const auto table = table_of(lines_in(text));
  if (!table) metadata.refuse_value(key, text);
  return *table;
}

void put_table(const ClassTable& table, std::map<std::string, std::string>& metadata) {
  metadata["class_table"] = fmt::format("{}\n", fmt::join(lines_of(table), "\n"));
}

/// Whether the numbers may be those of a network's outputs.
bool are_outputs(const std::vector<std::uint8_t>& classes, const ClassTable& table) {
  if (!has_own_classes(table)) {
    return std::find(kClassLists.begin(), kClassLists.end(), classes) != kClassLists.end();
  }
  const bool ascends =
      std::adjacent_find(classes.begin(), classes.end(), std::greater_equal<>()) == classes.end();
  const bool bounds = has_edges(table) && std::count(classes.begin(), classes.end(), kBoundary) > 0;
  return classes.size() >= 2 && ascends && classes.back() < table.size() && !bounds;
}

std::vector<std::uint8_t> take_classes(nn::Metadata& metadata, const ClassTable& table) {
  const std::string key = "classes", text = metadata.take(key);
  std::vector<std::uint8_t> classes;
  for (const char digit : text) {
    if (digit != ' ') classes.push_back(static_cast<std::uint8_t>(digit - '0'));
  }
  if (text != text_of(classes) || !are_outputs(classes, table)) metadata.refuse_value(key, text);
  return classes;
}

double take_positive(nn::Metadata& metadata, const std::string& key) {
  const auto number = metadata.take_number<double>(key);
  if (!(number > 0.0)) metadata.refuse_value(key, fmt::format("{}", number));
  return number;
}

gls::ScaleSpaceOptions take_descriptor(nn::Metadata& metadata) {
  gls::ScaleSpaceOptions descriptor;
  descriptor.scales = metadata.take_number<int>("descriptor_scales");
  descriptor.features = take_features(metadata);
  descriptor.reconstruction = take_reconstruction(metadata);
  descriptor.max_projection_steps = metadata.take_number<int>("descriptor_projection_steps");
  if (metadata.has("descriptor_side_gate")) {
    descriptor.side_gate = metadata.take_number<double>("descriptor_side_gate");
  }
  if (metadata.has("descriptor_second_gate")) {
    descriptor.second_gate = metadata.take_number<double>("descriptor_second_gate");
  }
  if (metadata.has("descriptor_s_max_fraction")) {
    descriptor.range.s_max_fraction = take_positive(metadata, "descriptor_s_max_fraction");
  }
  if (metadata.has("descriptor_s_max_ratio")) {
    descriptor.range.s_max_ratio = take_positive(metadata, "descriptor_s_max_ratio");
  }
  if (metadata.has("descriptor_octaves")) {
    metadata.take_fixed("descriptor_octaves", "1");
    descriptor.range.octaves = true;
  }
  try {
    gls::check({}, descriptor);
  } catch (const Error& error) {
    metadata.refuse(error.what());
  }
  return descriptor;
}

void put_descriptor(const gls::ScaleSpaceOptions& descriptor,
                    std::map<std::string, std::string>& metadata) {
  metadata["descriptor_scales"] = std::to_string(descriptor.scales);
  metadata["descriptor_features"] = names_of(descriptor.features);
  metadata["descriptor_reconstruction"] = gls::name_of(descriptor.reconstruction);
  metadata["descriptor_projection_steps"] = std::to_string(descriptor.max_projection_steps);
  if (descriptor.side_gate) {
    metadata["descriptor_side_gate"] = fmt::format("{}", *descriptor.side_gate);
  }
  if (descriptor.second_gate) {
    metadata["descriptor_second_gate"] = fmt::format("{}", *descriptor.second_gate);
  }
  if (descriptor.range.s_max_fraction != gls::kPartOfDiagonal) {
    metadata["descriptor_s_max_fraction"] = fmt::format("{}", descriptor.range.s_max_fraction);
  }
  if (descriptor.range.s_max_ratio > 0.0) {
    metadata["descriptor_s_max_ratio"] = fmt::format("{}", descriptor.range.s_max_ratio);
  }
  if (descriptor.range.octaves) metadata["descriptor_octaves"] = "1";
}

/// Moves entries whose names have `prefix` out of `all`, and strips the prefix.
template <typename Value>
std::map<std::string, Value> take_part(std::map<std::string, Value>& all, std::string_view prefix) {
  std::map<std::string, Value> part;
  for (auto entry = all.begin(); entry != all.end();) {
    if (entry->first.starts_with(prefix)) {
      part.emplace(entry->first.substr(prefix.size()), std::move(entry->second));
      entry = all.erase(entry);
    } else {
      ++entry;
    }
  }
  return part;
}

nn::Safetensors take_part(nn::Safetensors& all, std::string_view prefix) {
  return {take_part(all.tensors, prefix), take_part(all.metadata, prefix)};
}

/// Adds `part` to `all`, with `prefix` before the names.
void add_part(const nn::Safetensors& part, std::string_view prefix, nn::Safetensors& all) {
  for (const auto& [name, value] : part.tensors) all.tensors[std::string(prefix) + name] = value;
  for (const auto& [name, value] : part.metadata) all.metadata[std::string(prefix) + name] = value;
}

std::optional<nn::Model> read_context(const std::filesystem::path& path,
                                      const nn::Safetensors& content, std::size_t classes) {
  if (content.tensors.empty()) return {};
  nn::Model context = nn::from_safetensors(content, path.string() + ": context network");
  const nn::Architecture& its = context.network.architecture;
  const nn::Architecture wanted = context_architecture(static_cast<int>(classes));
  if (its.scales != wanted.scales || its.features != wanted.features ||
      its.classes != wanted.classes) {
    throw Error(ErrorKind::kModelMismatch,
                fmt::format("{}: the context network does not fit the classes", path.string()));
  }
  return context;
}

bool fits(const nn::Model& model, const gls::ScaleSpaceOptions& descriptor, std::size_t classes) {
  const nn::Architecture& network = model.network.architecture;
  return network.scales == descriptor.scales && network.features == gls::column_count(descriptor) &&
         network.classes == static_cast<int>(classes);
}

bool fits(const nn::Model& model, const EdgeModel& its) {
  return fits(model, its.descriptor, its.classes.size());
}

Expert read_expert(const std::filesystem::path& path, nn::Safetensors content,
                   const EdgeModel& model) {
  Expert expert;
  const nn::Safetensors context = take_part(content, kContext);
  const std::string where = path.string() + ": networks for clouds of a kind";
  expert.network = nn::from_safetensors(content, where);
  nn::Metadata metadata(std::move(expert.network.metadata), where);
  const std::string text = metadata.take(kKind);
  const auto kind = cloud_kind_of(text);
  if (!kind) metadata.refuse_value(kKind, text);
  expert.kind = *kind;
  if (!fits(expert.network, model)) metadata.refuse("they do not fit the descriptor and classes");
  expert.network.metadata = std::move(metadata.rest());
  expert.context = read_context(path, context, edge_outputs(model).size());
  return expert;
}

/// The parts of a file that hold the experts.
std::vector<nn::Safetensors> take_experts(nn::Safetensors& content) {
  std::vector<nn::Safetensors> experts;
  for (;;) {
    nn::Safetensors part = take_part(content, expert_prefix(experts.size()));
    if (part.tensors.empty()) return experts;
    experts.push_back(std::move(part));
  }
}

std::optional<nn::Model> read_pieces(const std::filesystem::path& path,
                                     const nn::Safetensors& content, const EdgeModel& model) {
  if (content.tensors.empty()) return {};
  nn::Model pieces = nn::from_safetensors(content, path.string() + ": network for pieces");
  if (!fits(pieces, model.descriptor, kPieceOutputs)) {
    throw Error(
        ErrorKind::kModelMismatch,
        fmt::format("{}: the network for pieces does not fit the descriptor and two classes",
                    path.string()));
  }
  return pieces;
}

nn::Safetensors to_store(const Expert& expert) {
  nn::Model network = expert.network;
  network.metadata[kKind] = text_of(expert.kind);
  nn::Safetensors part = nn::to_safetensors(network);
  if (expert.context) add_part(nn::to_safetensors(*expert.context), kContext, part);
  return part;
}

}  // namespace

std::vector<std::uint8_t> edge_outputs(const EdgeModel& model) {
  if (!has_edges(model.table)) return {};
  std::vector<std::uint8_t> edges = model.classes;
  std::erase_if(edges, [](std::uint8_t id) { return id > kSharpEdge; });
  return edges;
}

bool CloudKind::has(const CloudTraits& traits) const {
  return (below == 0 || traits.points < below) &&
         estimated.value_or(traits.estimated) == traits.estimated && (!exact || traits.exact) &&
         (!noisy || traits.noisy);
}

const Expert* expert_for(const EdgeModel& model, const CloudTraits& traits) {
  const auto found = std::find_if(model.experts.begin(), model.experts.end(),
                                  [&](const Expert& expert) { return expert.kind.has(traits); });
  return found == model.experts.end() ? nullptr : &*found;
}

EdgeModel suited_to(EdgeModel model, const CloudTraits& traits) {
  if (const Expert* expert = expert_for(model, traits)) {
    model.network = expert->network;
    model.context = expert->context;
  }
  model.experts.clear();
  model.pieces.reset();
  return model;
}

void drop_context(EdgeModel& model) {
  model.context.reset();
  for (Expert& expert : model.experts) expert.context.reset();
}

void check_fits(const EdgeModel& expert, const gls::ScaleSpaceOptions& descriptor,
                std::size_t classes) {
  gls::ScaleSpaceOptions own = expert.descriptor;
  own.range.octaves =
      descriptor.range.octaves;  // the model's hold: networks may learn without them
  if (own == descriptor && expert.classes.size() == classes) return;
  throw Error(
      ErrorKind::kModelMismatch,
      fmt::format("{}: its networks need another descriptor, or other classes", expert.name));
}

void check_classes(const EdgeModel& expert, const ClassTable& table) {
  if (names_of(expert.table) == names_of(table)) return;
  throw Error(ErrorKind::kModelMismatch, fmt::format("{}: its classes are {}, not {}", expert.name,
                                                     names_of(expert.table), names_of(table)));
}

void join_expert(EdgeModel& model, const EdgeModel& expert, const CloudKind& kind) {
  check_fits(expert, model.descriptor, model.classes.size());
  check_classes(expert, model.table);
  if (expert.classes != model.classes) {
    throw Error(ErrorKind::kModelMismatch,
                fmt::format("{}: it knows the classes {}, not {}", expert.name,
                            text_of(expert.classes), text_of(model.classes)));
  }
  model.experts.push_back({kind, expert.network, expert.context});
}

EdgeModel load_model(const std::filesystem::path& path) {
  EdgeModel model;
  nn::Safetensors content = nn::read_safetensors(path);
  const std::vector<nn::Safetensors> experts = take_experts(content);
  const nn::Safetensors context = take_part(content, kContext);
  const nn::Safetensors pieces = take_part(content, kPieces);
  model.network = nn::from_safetensors(content, path.string());
  nn::Metadata metadata(std::move(model.network.metadata), path.string());
  if (metadata.has("class_table")) model.table = take_table(metadata);
  metadata.take_fixed("format", format_of(has_own_classes(model.table),
                                          {.context = !context.tensors.empty(),
                                           .experts = !experts.empty(),
                                           .pieces = !pieces.tensors.empty() && !experts.empty()}));
  metadata.take_fixed("undefined", "zero");
  metadata.take("version");
  model.name = metadata.take("name");
  model.seed = metadata.take_number<std::uint64_t>("seed");
  model.descriptor = take_descriptor(metadata);
  model.classes = take_classes(metadata, model.table);
  if (metadata.has("context_least_edge")) {
    model.least_edge = metadata.take_number<float>("context_least_edge");
  }
  if (!fits(model.network, model)) {
    metadata.refuse("the network does not fit its descriptor and classes");
  }
  model.network.metadata = std::move(metadata.rest());
  model.context = read_context(path, context, edge_outputs(model).size());
  for (const nn::Safetensors& part : experts) {
    model.experts.push_back(read_expert(path, part, model));
  }
  model.pieces = read_pieces(path, pieces, model);
  return model;
}

void save_model(const std::filesystem::path& path, const EdgeModel& model, Overwrite overwrite) {
  nn::Model network = model.network;
  auto& metadata = network.metadata;
  metadata["format"] =
      format_of(has_own_classes(model.table), {.context = model.context.has_value(),
                                               .experts = !model.experts.empty(),
                                               .pieces = model.pieces.has_value()});
  metadata["version"] = kVersion;
  metadata["undefined"] = "zero";
  metadata["name"] = model.name;
  metadata["seed"] = std::to_string(model.seed);
  put_descriptor(model.descriptor, metadata);
  metadata["classes"] = text_of(model.classes);
  if (has_own_classes(model.table)) put_table(model.table, metadata);
  if (model.context && model.least_edge != kLeastEdge) {
    metadata["context_least_edge"] = fmt::format("{}", model.least_edge);
  }
  nn::Safetensors content = nn::to_safetensors(network);
  if (model.context) add_part(nn::to_safetensors(*model.context), kContext, content);
  for (std::size_t number = 0; number < model.experts.size(); ++number) {
    add_part(to_store(model.experts[number]), expert_prefix(number), content);
  }
  if (model.pieces) add_part(nn::to_safetensors(*model.pieces), kPieces, content);
  nn::write_safetensors(path, content, overwrite);
}

}  // namespace pcednet::detect
