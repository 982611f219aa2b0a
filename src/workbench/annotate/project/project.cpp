#include "workbench/annotate/project/project.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <numeric>

#include "pcednet/core/digest.h"
#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/core/version.h"
#include "pcednet/io/input_file.h"

namespace pcednet::annotate {
namespace {

using Kind = Record::Kind;

constexpr const char* kFormat = "pcednet-annotation-1";
constexpr const char* kSeveralFormat = "pcednet-annotation-2";  // of several inputs
constexpr int kMostRuns = 1'000'000'000;

[[noreturn]] void refuse_project(const std::string& why) {
  throw Error(ErrorKind::kUnreadable, why);
}

Json json_of(const Settings& s) {
  return {{"classes", s.classes}, {"auto", s.automatic}, {"start", s.start}, {"seed", s.seed}};
}

SettingsChange settings_change_of(const Json& json) {
  SettingsChange change;
  if (const auto found = json.find("classes"); found != json.end()) {
    change.classes = *found == 2 ? 2 : *found == 3 ? 3 : 0;
  }
  if (json.contains("auto")) change.automatic = json.at("auto").get<bool>();
  if (json.contains("start")) change.start = json.at("start").get<std::string>();
  if (const auto found = json.find("seed"); found != json.end()) {
    if (!found->is_number_unsigned())
      throw Error(ErrorKind::kUsage, "seed: a whole number, not negative");
    change.seed = found->get<std::uint64_t>();
  }
  return change;
}

Settings settings_of(const Json& json) {
  return changed({}, settings_change_of(json));
}

/// Ascending numbers as differences, which are short to write.
Json steps_of(const std::vector<std::uint32_t>& points) {
  Json steps = Json::array();
  std::uint32_t last = 0;
  for (const std::uint32_t point : points) {
    steps.push_back(point - last);
    last = point;
  }
  return steps;
}

std::vector<std::uint32_t> points_of(const Json& steps, std::size_t points) {
  std::vector<std::uint32_t> result;
  std::uint64_t last = 0;
  for (const Json& step : steps) {
    if (!step.is_number_unsigned()) refuse_project("a stroke's point is no number");
    const auto by = step.get<std::uint64_t>();
    if (by >= points || (by == 0 && !result.empty()))
      refuse_project("a stroke's points do not ascend");
    last += by;
    if (last >= points)
      refuse_project(fmt::format("point {} of a stroke: the input has {}", last, points));
    result.push_back(static_cast<std::uint32_t>(last));
  }
  return result;
}

Json json_of(const RunRecord& run) {
  const RunFacts& facts = run.facts;
  Json json = {{"run", run.number}, {"records", run.records}, {"settings", json_of(run.settings)}};
  const auto tell = [&](const char* name, const auto& fact) {
    if (fact) json[name] = *fact;
  };
  if (run.clouds > 1) json["clouds"] = run.clouds;
  tell("painted", facts.painted);
  tell("classes", facts.classes);
  tell("loss", facts.loss);
  tell("seconds_train", facts.seconds_train);
  tell("seconds_classify", facts.seconds_classify);
  if (!facts.time.empty()) json["time"] = facts.time;
  return json;
}

RunRecord run_of(const Json& json) {
  RunRecord run{.number = json.at("run").get<int>(),
                .records = json.at("records").get<std::size_t>(),
                .settings = settings_of(json.at("settings"))};
  if (run.number < 1 || run.number > kMostRuns) refuse_project("a run of no number");
  const auto learn = [&]<typename Fact>(const char* name, std::optional<Fact>& fact) {
    // A number that is not finite was written as null.
    if (const auto found = json.find(name); found != json.end() && !found->is_null()) {
      fact = found->get<Fact>();
    }
  };
  learn("painted", run.facts.painted);
  learn("classes", run.facts.classes);
  learn("loss", run.facts.loss);
  learn("seconds_train", run.facts.seconds_train);
  learn("seconds_classify", run.facts.seconds_classify);
  if (json.contains("clouds")) run.clouds = json.at("clouds").get<std::size_t>();
  if (run.clouds < 1) refuse_project("a run on no cloud");
  if (json.contains("time")) run.facts.time = json.at("time").get<std::string>();
  return run;
}

Json json_of(const ProjectClasses& classes) {
  Json list = Json::array();
  for (std::size_t id = 0; id < classes.table.size(); ++id) {
    const PointClass& one = classes.table[id];
    list.push_back({{"name", one.name}, {"colour", text_of(one.colour)}});
    if (classes.removed.contains(static_cast<std::uint8_t>(id))) list.back()["removed"] = true;
  }
  return list;
}

ProjectClasses classes_in(const Json& list) {
  ProjectClasses classes{.table = {}};
  if (!list.is_array()) throw Error(ErrorKind::kUsage, "classes: a list of classes is wanted");
  if (list.size() > kMostClasses) check_classes(ClassTable(kMostClasses + 1));
  for (const Json& json : list) {
    const auto colour = colour_of(json.at("colour").get<std::string>());
    if (!colour) throw Error(ErrorKind::kUsage, "classes: a colour is #rrggbb");
    if (json.value("removed", false)) {
      classes.removed.insert(static_cast<std::uint8_t>(classes.table.size()));
    }
    classes.table.push_back({json.at("name").get<std::string>(), *colour});
  }
  check_classes(classes.table);
  return classes;
}

Json json_of(const Record& record) {
  switch (record.kind) {
    case Kind::kStroke:
      return {
          {"stroke", record.id}, {"class", record.edge_class}, {"points", steps_of(record.points)}};
    case Kind::kUndo:
      return {{"undo", true}};
    case Kind::kRedo:
      return {{"redo", true}};
    case Kind::kSettings:
      return {{"settings", json_of(record.settings)}};
    case Kind::kClasses:
      return {{"table", json_of(record.classes)}};
    case Kind::kRun:
      return json_of(record.run);
    case Kind::kRestore:
      break;
  }
  return {{"restore", record.run.number}};
}

Record record_of(const Json& json, std::size_t points) {
  if (json.contains("stroke")) {
    const int edge_class = json.at("class").get<int>();
    const bool is_class = edge_class >= 0 && edge_class < static_cast<int>(kMostClasses);
    if (!is_class && edge_class != kUnlabelled) refuse_project("a stroke of no class");
    return {.id = json.at("stroke").get<std::string>(),
            .edge_class = static_cast<std::uint8_t>(edge_class),
            .points = points_of(json.at("points"), points)};
  }
  if (json.contains("undo")) return {.kind = Kind::kUndo};
  if (json.contains("redo")) return {.kind = Kind::kRedo};
  if (json.contains("table")) {
    Record record{.kind = Kind::kClasses};
    record.classes = classes_in(json.at("table"));
    return record;
  }
  if (json.contains("run")) return {.kind = Kind::kRun, .run = run_of(json)};
  if (json.contains("restore")) {
    return {.kind = Kind::kRestore, .run = {.number = json.at("restore").get<int>()}};
  }
  return {.kind = Kind::kSettings, .settings = settings_of(json.at("settings"))};
}

Json json_of(const InputIdentity& input) {
  return {{"name", input.name}, {"digest", input.digest}, {"points", input.points}};
}

InputIdentity input_of(const Json& json) {
  return {.name = json.at("name").get<std::string>(),
          .digest = json.at("digest").get<std::string>(),
          .points = json.at("points").get<std::size_t>()};
}

/// The inputs of a project, or of the first line of a journal.
Inputs inputs_of(const Json& file) {
  const Json& format = file.at("format");
  Inputs inputs;
  if (format == kFormat) {
    inputs.push_back(input_of(file.at("input")));
  } else if (format == kSeveralFormat) {
    for (const Json& json : file.at("inputs")) inputs.push_back(input_of(json));
    if (inputs.empty()) refuse_project("no input");
  } else {
    refuse_project(fmt::format("not of the format {} or {}", kFormat, kSeveralFormat));
  }
  if (points_of(inputs) > 0xfffffff0u) refuse_project("more points than 32 bits can count");
  return inputs;
}

/// The file's format and its inputs, by their names.
Json head_of(const Inputs& inputs) {
  if (inputs.size() == 1) return {{"format", kFormat}, {"input", json_of(inputs.front())}};
  Json list = Json::array();
  for (const InputIdentity& input : inputs) list.push_back(json_of(input));
  return {{"format", kSeveralFormat}, {"inputs", std::move(list)}};
}

/// Runs `read` and turns any exception into Error(kUnreadable).
template <typename Read>
auto strictly(Read&& read) {
  try {
    return read();
  } catch (const Error& error) {
    refuse_project(error.what());
  } catch (const Json::exception& error) {
    refuse_project(words_of(error));
  }
}

}  // namespace

std::size_t points_of(std::span<const InputIdentity> inputs) {
  return std::accumulate(
      inputs.begin(), inputs.end(), std::size_t{0},
      [](std::size_t sum, const InputIdentity& input) { return sum + input.points; });
}

std::string digest_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse_project(fmt::format("{}: cannot be read", path.string()));
  std::vector<char> part(std::size_t{1} << 20);
  Digest digest;
  while (file.read(part.data(), static_cast<std::streamsize>(part.size())), file.gcount() > 0) {
    digest.add(std::string_view(part.data(), static_cast<std::size_t>(file.gcount())));
  }
  return digest.hex();
}

std::string to_line(const Record& record) {
  return to_text(json_of(record));
}

std::string to_line(const Inputs& inputs) {
  return to_text(head_of(inputs));
}

Record parse_record(std::string_view line, std::size_t points) {
  return strictly([&] { return record_of(parse_json(line), points); });
}

Inputs parse_inputs(std::string_view line) {
  return strictly([&] { return inputs_of(parse_json(line)); });
}

std::string to_line(const Settings& settings) {
  return to_text(json_of(settings));
}

ProjectClasses parse_classes_change(std::string_view text) {
  try {
    return classes_in(parse_json(text).at("classes"));
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::kUsage, fmt::format("classes: {}", words_of(error)));
  }
}

SettingsChange parse_settings_change(std::string_view text) {
  try {
    return settings_change_of(parse_json(text));
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::kUsage, fmt::format("settings: {}", words_of(error)));
  }
}

Settings changed(Settings settings, const SettingsChange& change) {
  settings.classes = change.classes.value_or(settings.classes);
  settings.automatic = change.automatic.value_or(settings.automatic);
  settings.start = change.start.value_or(settings.start);
  settings.seed = change.seed.value_or(settings.seed);
  if (settings.classes != 2 && settings.classes != 3) {
    throw Error(ErrorKind::kUsage, "classes: 2 or 3");
  }
  return settings;
}

Project read_project(const std::filesystem::path& path) {
  const std::string text = io::InputFile(path).text();
  try {
    return strictly([&] {
      const Json json = parse_json(text);
      Project project{.inputs = inputs_of(json), .records = {}};
      const std::size_t points = points_of(project.inputs);
      ProjectClasses classes;
      for (const Json& record : json.at("records")) {
        with_name_in_errors(fmt::format("record {}", project.records.size() + 1), [&] {
          project.records.push_back(strictly([&] { return record_of(record, points); }));
          follow_classes(project.records.back(), classes);
        });
      }
      return project;
    });
  } catch (const Error& error) {
    refuse_project(fmt::format("{}: no project: {}", path.string(), error.what()));
  }
}

void write_project(const std::filesystem::path& path, const Project& project, Overwrite overwrite) {
  const Replayed end = replay(project.records, points_of(project.inputs));
  const Json head = head_of(project.inputs);
  const char* name = project.inputs.size() == 1 ? "input" : "inputs";
  std::string text = fmt::format(
      "{{\"format\":{},\"version\":\"{}\",\n\"{}\":{},\n\"settings\":{},\n\"run\":{},\n"
      "\"records\":[",
      to_text(head.at("format")), kVersion, name, to_text(head.at(name)),
      to_text(json_of(end.settings)), end.run ? std::to_string(end.run->number) : "null");
  for (std::size_t i = 0; i < project.records.size(); ++i) {
    text += (i == 0 ? "\n" : ",\n") + to_line(project.records[i]);
  }
  write_text_file(path, text + "]}\n", overwrite);
}

}  // namespace pcednet::annotate
