#include "workbench/study/cache.h"

#include <fmt/format.h>

#include "pcednet/core/digest.h"
#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/core/output_file.h"
#include "pcednet/formats/labels.h"
#include "pcednet/io/input_file.h"

namespace pcednet::study {
namespace {

namespace fs = std::filesystem;

constexpr std::pair<const char*, Cost Costs::*> kParts[] = {
    {"normals", &Costs::normals},
    {"describe", &Costs::describe},
    {"describe_training", &Costs::describe_training},
    {"train", &Costs::train},
    {"classify", &Costs::classify}};

OrderedJson to_json(const Costs& costs) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [name, part] : kParts) {
    json[name] = {(costs.*part).seconds, (costs.*part).joules};
  }
  return json;
}

Costs costs_of(const Json& json) {
  Costs costs;
  for (const auto& [name, part] : kParts) {
    costs.*part = {json.at(name).at(0).get<double>(), json.at(name).at(1).get<double>()};
  }
  return costs;
}

OrderedJson to_json(const EpochPoint& e) {
  return {e.epoch, e.seconds, e.loss, e.held_out_loss, e.held_out_accuracy, e.held_out_mcc};
}

EpochPoint epoch_of(const Json& json) {
  return {json.at(0).get<int>(),    json.at(1).get<double>(), json.at(2).get<double>(),
          json.at(3).get<double>(), json.at(4).get<double>(), json.at(5).get<double>()};
}

OrderedJson to_json(const eval::ConfusionCounts& c) {
  return {c.tp, c.fp, c.tn, c.fn};
}

eval::ConfusionCounts counts_of(const Json& json) {
  const auto at = [&](std::size_t i) { return json.at(i).get<std::size_t>(); };
  return {at(0), at(1), at(2), at(3)};
}

/// The content of the file, if it exists, is complete, and has that key.
std::optional<Json> read(const fs::path& path, const std::string& key) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  Json json = parse_json(io::InputFile(path).text());
  if (!json.is_object() || json.value("key", "") != key) return std::nullopt;
  return json;
}

/// The result of `work`, or none if it fails on the data read.
template <typename Work>
auto unless_damaged(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const Json::exception&) {
    return std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

Cache::Cache(fs::path folder) : folder_(std::move(folder)) {
  make_folder(folder_);
}

fs::path Cache::file(const std::string& kind, const std::string& key,
                     const std::string& extension) const {
  return folder_ / fmt::format("{}-{}{}", kind, Digest().add(key).hex(), extension);
}

std::optional<StoredModel> Cache::find_model(const std::string& key) const {
  return unless_damaged([&]() -> std::optional<StoredModel> {
    const auto json = read(file("model", key, ".json"), key);
    if (!json) return std::nullopt;
    StoredModel stored{.model = detect::load_model(file("model", key, ".safetensors")),
                       .costs = costs_of(json->at("costs"))};
    for (const Json& epoch : json->at("epochs")) stored.epochs.push_back(epoch_of(epoch));
    return stored;
  });
}

std::optional<StoredClasses> Cache::find_classes(const std::string& key) const {
  return unless_damaged([&]() -> std::optional<StoredClasses> {
    const auto json = read(file("classes", key, ".json"), key);
    if (!json) return std::nullopt;
    StoredClasses stored{.sharp = counts_of(json->at("sharp")),
                         .edge = counts_of(json->at("edge")),
                         .failure = json->at("failure").get<std::string>(),
                         .costs = costs_of(json->at("costs"))};
    if (stored.failure.empty()) stored.classes = formats::read_labels(file("classes", key, ".u8"));
    if (stored.classes.size() != json->at("points").get<std::size_t>()) return std::nullopt;
    return stored;
  });
}

void Cache::keep(const std::string& key, const StoredModel& model) const {
  detect::save_model(file("model", key, ".safetensors"), model.model, Overwrite::kYes);
  OrderedJson json = {
      {"key", key}, {"costs", to_json(model.costs)}, {"epochs", OrderedJson::array()}};
  for (const EpochPoint& epoch : model.epochs) json["epochs"].push_back(to_json(epoch));
  write_text_file(file("model", key, ".json"), to_text(json) + "\n", Overwrite::kYes);
}

void Cache::keep(const std::string& key, const StoredClasses& classes) const {
  const auto& bytes = classes.classes;
  write_text_file(file("classes", key, ".u8"),
                  {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, Overwrite::kYes);
  const OrderedJson json = {{"key", key},
                            {"points", bytes.size()},
                            {"sharp", to_json(classes.sharp)},
                            {"edge", to_json(classes.edge)},
                            {"failure", classes.failure},
                            {"costs", to_json(classes.costs)}};
  write_text_file(file("classes", key, ".json"), to_text(json) + "\n", Overwrite::kYes);
}

}  // namespace pcednet::study
