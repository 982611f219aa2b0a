#include "workbench/study/cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>

#include "pcednet/core/digest.h"
#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/core/output_file.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/processor.h"
#include "pcednet/formats/labels.h"
#include "pcednet/io/input_file.h"

namespace pcednet::study {
namespace {

namespace fs = std::filesystem;

/// Joules that the packages' counters show; empty if there is none to read. Joules lost when a
/// counter starts over (after 2^18 J or so) show as a negative lap, which counts as zero.
std::optional<double> counted_joules() {
  std::error_code error;
  std::optional<double> sum;
  for (const auto& entry : fs::directory_iterator("/sys/class/powercap", error)) {
    const std::string name = entry.path().filename().string();
    // "intel-rapl:0" is a package, "intel-rapl:0:1" a part of it; AMD's are called so too.
    if (!name.starts_with("intel-rapl:") || std::count(name.begin(), name.end(), ':') != 1) {
      continue;
    }
    double microjoules = 0;
    if (std::ifstream(entry.path() / "energy_uj") >> microjoules) {
      sum = sum.value_or(0.0) + 1e-6 * microjoules;
    }
  }
  return sum;
}

double processor_seconds() {
  timespec time = {};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

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

// The structured bindings below name every member, so that a new one does not compile before it
// has its place in the text.

std::string text_of_network(const nn::Architecture& architecture) {
  const auto& [kind, scales, features, classes, width, hidden] = architecture;
  // Scales and features are the descriptor's.
  static_cast<void>(scales), static_cast<void>(features);
  return fmt::format("network {} classes {} width {} hidden {}", static_cast<int>(kind), classes,
                     width, hidden);
}

std::string text_of_training(const nn::TrainOptions& options) {
  const auto& [optimiser, learning_rate, anneal, momentum, epochs, batch, balance, least_per_epoch,
               most_per_epoch, even_validation, held_out, standardise, sign_rule, class_names,
               start, seed] = options;
  // The runner has no model to start from; the signs and the names of the classes follow from the
  // rest.
  static_cast<void>(start), static_cast<void>(class_names), static_cast<void>(sign_rule);
  return fmt::format(
      "optimiser {} rate {} anneal {} momentum {} epochs {} batch {} balance {} least {} most {} "
      "validation {} held out {} standardise {} seed {}",
      static_cast<int>(optimiser), learning_rate, anneal, momentum, epochs, batch, balance,
      least_per_epoch, most_per_epoch, even_validation, held_out, standardise, seed);
}

}  // namespace

Costs& Costs::operator+=(const Costs& other) {
  normals += other.normals;
  describe += other.describe;
  describe_training += other.describe_training;
  train += other.train;
  classify += other.classify;
  return *this;
}

EnergyMeter::EnergyMeter(double watts_per_core)
    : watts_per_core_(watts_per_core),
      has_counters_(counted_joules().has_value()),
      joules_(joules_now()) {}

double EnergyMeter::joules_now() const {
  if (has_counters_) return counted_joules().value_or(joules_);
  return watts_per_core_ * processor_seconds();
}

Cost EnergyMeter::lap() {
  const double now = joules_now();
  const Cost cost{watch_.lap(), std::max(0.0, now - joules_)};
  joules_ = now;
  return cost;
}

std::string machine_name() {
  std::ifstream file("/proc/cpuinfo");
  std::string name = "unknown processor";
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) {
      name = line.substr(std::min(line.size(), line.find(':') + 2));
      break;
    }
  }
  return fmt::format("{}, {} threads", name, thread_count());
}

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

std::string text_of(const detect::TrainOptions& options) {
  const auto& [descriptor, architecture, table, training, symmetry, teachers, context] = options;
  static_cast<void>(table);  // a study is of edge classes
  return fmt::format("{}, {}, {}, symmetry {}, teachers {}{}", gls::text_of(descriptor),
                     text_of_network(architecture), text_of_training(training),
                     static_cast<int>(symmetry), teachers, context ? ", context" : "");
}

std::string text_of(const Treatment& treatment) {
  const auto& [keep, noise, along_normal, estimate_normals] = treatment;
  return fmt::format("keep {} noise {} {} normals {}", keep, noise,
                     along_normal ? "along normals" : "every way",
                     estimate_normals ? "estimated" : "given");
}

std::string text_of(const CloudSet& set) {
  std::string text;
  for (const StudyCloud& cloud : set.clouds) text += cloud.digest + " ";
  return text;
}

std::string this_program() {
  return fmt::format("{} level {}", Digest().add(io::InputFile("/proc/self/exe").text()).hex(),
                     static_cast<int>(instruction_set()));
}

}  // namespace pcednet::study
