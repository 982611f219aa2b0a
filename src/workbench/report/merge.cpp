#include "workbench/report/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/formats/file_name.h"
#include "pcednet/formats/labels.h"
#include "pcednet/io/input_file.h"
#include "workbench/report/scene.h"
#include "workbench/truth/read_labelled.h"

namespace pcednet::report {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStudySchema = "pcednet-study-1";
constexpr std::string_view kPlace = "\"PCEDNET-REPORT-DATA\"";

std::vector<fs::path> json_files(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    const bool is_file = fs::exists(folder, error);
    throw Error(
        ErrorKind::kUnreadable,
        folder.string() + (is_file ? ": is no folder; give the one that `pcednet study` wrote"
                                   : ": no such folder"));
  }
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Throws Error(kUnreadable), also for a file that is no JSON.
OrderedJson read_json(const fs::path& file) {
  const std::string text = io::InputFile(file).text();
  try {
    return parse_ordered_json(text);
  } catch (const OrderedJson::parse_error& error) {
    throw io::unreadable(file, fmt::format("no JSON at byte {}", error.byte));
  }
}

/// A place in a study's file, for messages.
struct Place {
  const fs::path& file;
  std::string where = {};
};

const OrderedJson& member(const OrderedJson& parent, const char* key, OrderedJson::value_t type,
                          const Place& place) {
  const auto found = parent.is_object() ? parent.find(key) : parent.end();
  if (!parent.is_object() || found == parent.end() || found->type() != type) {
    throw io::unreadable(place.file, fmt::format("{}\"{}\" is missing or not {}", place.where, key,
                                                 OrderedJson(type).type_name()));
  }
  return *found;
}

const OrderedJson& array_of(const OrderedJson& parent, const char* key, const Place& place) {
  return member(parent, key, OrderedJson::value_t::array, place);
}

std::string text_of(const OrderedJson& parent, const char* key, const Place& place) {
  return member(parent, key, OrderedJson::value_t::string, place).get<std::string>();
}

/// The names that the objects of an array have under `key`.
std::vector<std::string> names_in(const OrderedJson& array, const char* key, const Place& place) {
  std::vector<std::string> names;
  for (const OrderedJson& object : array) names.push_back(text_of(object, key, place));
  return names;
}

void check_scores(const OrderedJson& scores, const Place& place) {
  for (const char* key : {"precision", "recall", "mcc", "f1", "accuracy", "iou"}) {
    if (!scores.contains(key) || !scores[key].is_number()) {
      throw io::unreadable(place.file, fmt::format("{}no number \"{}\"", place.where, key));
    }
  }
}

void check_result(const OrderedJson& result, const std::vector<std::string>& variants,
                  const std::vector<std::string>& sets, const Place& place) {
  const auto known = [&](const char* key, const std::vector<std::string>& names) {
    const std::string name = text_of(result, key, place);
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw io::unreadable(place.file,
                           fmt::format("{}the {} \"{}\" is not defined", place.where, key, name));
    }
  };
  known("variant", variants);
  known("set", sets);
  for (const OrderedJson& cloud : array_of(result, "clouds", place)) {
    text_of(cloud, "name", place);
    check_scores(cloud, place);
  }
  for (const char* key : {"median", "pooled"}) {
    const bool measured = result.contains(key) && !result[key].is_null();
    if (measured) check_scores(member(result, key, OrderedJson::value_t::object, place), place);
  }
}

/// Throws unless `study` has everything the page relies on.
void check_study(const OrderedJson& study, const fs::path& file) {
  for (const char* key : {"experiment", "title"}) text_of(study, key, {file});
  const OrderedJson& sets = array_of(study, "sets", {file});
  const auto set_names = names_in(sets, "name", {file, "a set: "});
  for (const OrderedJson& set : sets) {
    const Place place{file, fmt::format("set \"{}\": ", set["name"].get<std::string>())};
    names_in(array_of(set, "clouds", place), "name", place);
    names_in(array_of(set, "clouds", place), "file", place);
  }
  const auto variants = names_in(array_of(study, "variants", {file}), "id", {file, "a variant: "});
  const OrderedJson& results = array_of(study, "results", {file});
  for (std::size_t i = 0; i < results.size(); ++i) {
    check_result(results[i], variants, set_names, {file, fmt::format("result {}: ", i)});
  }
}

struct Studies {
  std::vector<OrderedJson> texts = {};
  std::vector<fs::path> files = {};
  std::vector<std::string> warnings = {};
};

Studies read_studies(const fs::path& folder) {
  Studies studies;
  std::optional<Error> broken;
  for (const fs::path& file : json_files(folder)) {
    OrderedJson text;
    try {
      text = read_json(file);
    } catch (const Error& error) {
      studies.warnings.push_back(fmt::format("{}: left out", error.what()));
      if (!broken) broken = error;
      continue;
    }
    if (!text.is_object() || text.value("schema", OrderedJson()) != kStudySchema) {
      studies.warnings.push_back(
          fmt::format("{}: not of schema {}: left out", file.string(), kStudySchema));
      continue;
    }
    check_study(text, file);
    studies.texts.push_back(std::move(text));
    studies.files.push_back(file);
  }
  if (studies.texts.empty()) {
    if (broken) throw *broken;
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: no study in it; give the folder that `pcednet study methods "
                            "--test SET=CLOUDS -o FOLDER` writes",
                            folder.string()));
  }
  return studies;
}

/// A cloud of a set, and where predictions for it lie.
struct Exhibit {
  std::string set, cloud;
  fs::path file;
  struct Source {
    std::size_t study = 0;
    std::string variant;
    OrderedJson seed;
    fs::path predictions;
  };
  std::vector<Source> sources = {};
};

fs::path find_cloud(const std::string& name, const fs::path& folder, const fs::path& study) {
  std::error_code error;
  for (const fs::path& written : {folder / name, fs::path(name)}) {
    const fs::path candidate = formats::find_written(written);
    if (fs::is_regular_file(candidate, error)) return fs::weakly_canonical(candidate);
  }
  throw MissingCloud(ErrorKind::kUnreadable,
                     fmt::format("{}: its cloud {} is not there", study.string(), name));
}

bool lists_cloud(const OrderedJson& result, const std::string& cloud) {
  return std::any_of(result["clouds"].begin(), result["clouds"].end(),
                     [&](const OrderedJson& row) { return row["name"] == cloud; });
}

/// The first result of each variant that keeps predictions for this cloud.
std::vector<Exhibit::Source> sources_in(const OrderedJson& study, std::size_t number,
                                        const std::string& set, const std::string& cloud,
                                        const fs::path& folder) {
  std::vector<Exhibit::Source> sources;
  for (const OrderedJson& result : study["results"]) {
    const auto kept = result.find("predictions");
    if (kept == result.end() || !kept->is_string()) continue;
    if (result["set"] != set || !lists_cloud(result, cloud)) continue;
    const auto variant = result["variant"].get<std::string>();
    const auto same = [&](const auto& source) { return source.variant == variant; };
    if (std::any_of(sources.begin(), sources.end(), same)) continue;
    sources.push_back({number, variant, result.value("seed", OrderedJson()),
                       formats::find_written(folder / kept->get<std::string>() / (cloud + ".u8"))});
  }
  return sources;
}

std::vector<Exhibit> choose_exhibits(const Studies& studies, const fs::path& folder,
                                     std::size_t clouds_per_set) {
  std::vector<Exhibit> exhibits;
  const auto exhibit_of = [&](const std::string& set, const std::string& cloud,
                              const fs::path& file) -> Exhibit& {
    for (Exhibit& e : exhibits) {
      if (e.set == set && e.cloud == cloud && e.file == file) return e;
    }
    return exhibits.emplace_back(Exhibit{set, cloud, file});
  };
  for (std::size_t number = 0; number < studies.texts.size(); ++number) {
    const OrderedJson& study = studies.texts[number];
    for (const OrderedJson& set : study["sets"]) {
      const auto set_name = set["name"].get<std::string>();
      std::size_t shown = 0;
      for (const OrderedJson& cloud : set["clouds"]) {
        if (shown == clouds_per_set) break;
        const auto name = cloud["name"].get<std::string>();
        auto sources = sources_in(study, number, set_name, name, folder);
        if (sources.empty()) continue;
        ++shown;
        const auto file =
            find_cloud(cloud["file"].get<std::string>(), folder, studies.files[number]);
        auto& all = exhibit_of(set_name, name, file).sources;
        all.insert(all.end(), sources.begin(), sources.end());
      }
    }
  }
  return exhibits;
}

std::vector<fs::path> files_of(const Studies& studies, const std::vector<Exhibit>& exhibits) {
  std::vector<fs::path> files = studies.files;
  for (const Exhibit& exhibit : exhibits) {
    files.push_back(exhibit.file);
    for (const auto& source : exhibit.sources) files.push_back(source.predictions);
  }
  return files;
}

std::vector<std::uint8_t> read_classes(const fs::path& predictions, const fs::path& cloud,
                                       std::size_t points) {
  auto classes = formats::read_labels(predictions);
  if (classes.size() == points) return classes;
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: {} classes, but {} has {} points", predictions.string(),
                          classes.size(), cloud.string(), points));
}

/// Advances `stage` by one for the truth and for each prediction.
OrderedJson scene_of(const Exhibit& exhibit, const MergeOptions& options, const Progress* progress,
                     Stage& stage) {
  const auto cloud = truth::read_labelled(exhibit.file).cloud;
  const Scene scene = make_scene(cloud, options.points_per_cloud, progress);
  const Progress quiet = without_report(progress);
  detect::PreparedCloud prepared;
  if (options.lines) prepared = detect::prepare(cloud, {.average_noise = true}, &quiet);
  const auto add_lines = [&](OrderedJson& json, const std::vector<std::uint8_t>& classes) {
    if (options.lines) json["lines"] = find_drawn_lines(prepared, classes, scene, &quiet);
    stage.advance();
  };
  OrderedJson json = {{"set", exhibit.set},
                      {"cloud", exhibit.cloud},
                      {"file", exhibit.file.filename().string()},
                      {"points", cloud.size()},
                      {"shown", scene.shown.size()},
                      {"min", scene.min},
                      {"size", scene.size},
                      {"view", scene.view},
                      {"positions", scene.positions},
                      {"normals", scene.normals},
                      {"truth", pack_classes(cloud.labels, scene.shown)}};
  add_lines(json, cloud.labels);
  json["predictions"] = OrderedJson::array();
  for (const Exhibit::Source& source : exhibit.sources) {
    const auto classes = read_classes(source.predictions, exhibit.file, cloud.size());
    OrderedJson prediction = {{"study", source.study},
                              {"variant", source.variant},
                              {"seed", source.seed},
                              {"classes", pack_classes(classes, scene.shown)}};
    add_lines(prediction, classes);
    json["predictions"].push_back(std::move(prediction));
  }
  return json;
}

}  // namespace

MergedStudies merge_studies(const fs::path& folder, const MergeOptions& options,
                            const Progress* progress) {
  Studies studies = read_studies(folder);
  const auto exhibits = choose_exhibits(studies, folder, options.clouds_per_set);
  OrderedJson scenes = OrderedJson::array();
  std::size_t labellings = exhibits.size();
  for (const Exhibit& exhibit : exhibits) labellings += exhibit.sources.size();
  Stage stage(progress, "clouds", labellings);
  for (const Exhibit& exhibit : exhibits) {
    scenes.push_back(scene_of(exhibit, options, progress, stage));
  }
  MergedStudies merged{.studies = studies.texts.size(),
                       .scenes = scenes.size(),
                       .files = files_of(studies, exhibits),
                       .warnings = std::move(studies.warnings)};
  OrderedJson whole = {{"schema", "pcednet-report-1"},
                       {"studies", std::move(studies.texts)},
                       {"scenes", std::move(scenes)}};
  if (!options.title.empty()) whole["title"] = options.title;
  if (!options.date.empty()) whole["date"] = options.date;
  // Names in foreign files need not be UTF-8.
  merged.json = to_text(whole, -1, NotUtf8::kReplace);
  return merged;
}

std::string fill_page(std::string_view page, std::string_view json) {
  const std::size_t place = page.find(kPlace);
  if (place == std::string_view::npos) {
    throw Error(ErrorKind::kFailure, "the page has no place for data");
  }
  std::string filled(page.substr(0, place));
  filled.reserve(page.size() + json.size() + json.size() / 64);
  for (const char c : json) {
    // In JSON a '<' stands only inside a string, where it may be written so.
    if (c == '<') {
      filled += "\\u003c";
    } else {
      filled += c;
    }
  }
  return filled.append(page.substr(place + kPlace.size()));
}

}  // namespace pcednet::report
