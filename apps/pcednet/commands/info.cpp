#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "batch.h"
#include "commands.h"
#include "e57_facts.h"
#include "las_facts.h"
#include "pcednet/cloud/bounding_box.h"
#include "pcednet/cloud/edge_class.h"
#include "pcednet/core/error.h"
#include "pcednet/core/output_file.h"
#include "pcednet/core/random.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::app {
namespace {

using nlohmann::ordered_json;

struct Request {
  std::vector<std::string> inputs;
  std::string json;
};

const char* name_of(ScalarType type) {
  static constexpr std::array kNames = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                        "uint32", "int64", "uint64", "float32", "float64"};
  return kNames[static_cast<std::size_t>(type)];
}

std::string name_of_class(std::uint8_t label) {
  if (label < kEdgeClasses.size()) return std::string(kEdgeClasses[label].name);
  return label == kUnlabelled ? "unlabelled" : fmt::format("class {}", label);
}

struct Spacing {
  double mean = 0.0;    ///< distance to the ten nearest others
  double median = 0.0;  ///< of the distances to the nearest other
};

/// Over at most 2000 points drawn with a fixed seed; none unless there are eleven points.
std::optional<Spacing> find_spacing(const PointCloud& cloud) {
  constexpr std::size_t kNeighbours = 10, kSample = 2000;
  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.positions[i].allFinite()) finite.push_back(i);
  }
  if (finite.size() <= kNeighbours) return std::nullopt;
  const spatial::KdTree tree(cloud.positions);
  Random random(1);
  const std::size_t sample = std::min(finite.size(), kSample);
  double sum = 0.0;
  std::vector<double> nearest;
  std::vector<spatial::Neighbour> found;
  for (std::size_t s = 0; s < sample; ++s) {
    const std::size_t i = finite[sample == finite.size() ? s : random.index(finite.size())];
    // The nearest of all is the point itself.
    tree.nearest(cloud.positions[i], kNeighbours + 1, found);
    for (const spatial::Neighbour& neighbour : found) sum += std::sqrt(neighbour.sq_distance);
    nearest.push_back(std::sqrt(found[1].sq_distance));
  }
  std::nth_element(nearest.begin(), nearest.begin() + sample / 2, nearest.end());
  return Spacing{sum / static_cast<double>(sample * kNeighbours), nearest[sample / 2]};
}

/// What may surprise, one sentence each.
std::vector<std::string> find_problems(const io::LoadedCloud& loaded, const Defects& defects,
                                       const BoundingBox& box,
                                       const std::optional<Spacing>& spacing) {
  const PointCloud& cloud = loaded.cloud;
  std::vector<std::string> problems;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) problems.push_back(fmt::format("{} of {} {}", count, cloud.size(), what));
  };
  if (cloud.empty()) problems.emplace_back("no points");
  add(defects.positions, "points have no finite position: kept, not labelled");
  add(defects.duplicates, "points lie exactly on another one");
  if (!cloud.empty() && !cloud.has_normals()) {
    problems.emplace_back("no normals: they will be estimated");
  }
  add(defects.normals, "normals are zero or not finite");
  add(loaded.rescaled_normals, "normals are not of unit length: made so");
  if (!box.empty() && spacing) {
    const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    const double step = std::ldexp(1.0, std::ilogb(std::max(largest, 1e-30)) - 23);
    if (step > 0.1 * spacing->median) {
      problems.push_back(fmt::format(
          "coordinates up to {}: as float they would be rounded to "
          "{:.2g}, the points are {:.2g} apart",
          largest < 1e15 ? fmt::format("{:.0f}", largest) : fmt::format("{:g}", largest), step,
          spacing->median));
    }
  }
  return problems;
}

ordered_json describe_labels(const PointCloud& cloud) {
  std::map<std::uint8_t, std::size_t> counts;
  for (const std::uint8_t label : cloud.labels) ++counts[label];
  ordered_json described = ordered_json::object();
  for (const auto& [label, count] : counts) described[std::to_string(label)] = count;
  return described;
}

/// Least and largest number of an attribute, NaN left out.
ordered_json describe_attribute(const Attribute& attribute, std::size_t points) {
  double least = INFINITY, largest = -INFINITY;
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t c = 0; c < attribute.components; ++c) {
      const double value = attribute.value(i, c);
      least = std::fmin(least, value);
      largest = std::fmax(largest, value);
    }
  }
  ordered_json described = {{"name", attribute.name},
                            {"type", name_of(attribute.type)},
                            {"components", attribute.components}};
  if (least <= largest) {
    described["min"] = least;
    described["max"] = largest;
  }
  return described;
}

ordered_json to_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

ordered_json describe(const std::filesystem::path& path) {
  const io::LoadedCloud loaded = formats::read_cloud(path);
  const PointCloud& cloud = loaded.cloud;
  const Defects defects = find_defects(cloud);
  ordered_json file = {{"file", path.string()},
                       {"format", formats::format_of(io::InputFile(path)).name},
                       {"points", cloud.size()},
                       {"position_type", name_of(cloud.position_type)}};
  const BoundingBox box = bounding_box(cloud.positions);
  if (!box.empty()) file["bounds"] = {{"min", to_json(box.min)}, {"max", to_json(box.max)}};
  const auto spacing = find_spacing(cloud);
  if (spacing) {
    file["mean_spacing"] = spacing->mean;
    file["median_spacing"] = spacing->median;
  }
  file["normals"] = cloud.has_normals();
  file["colours"] = !cloud.colours.empty();
  if (cloud.has_labels()) file["labels"] = describe_labels(cloud);
  file["attributes"] = ordered_json::array();
  for (const Attribute& attribute : cloud.attributes) {
    file["attributes"].push_back(describe_attribute(attribute, cloud.size()));
  }
  file["comments"] = cloud.comments;
  file["elements"] = ordered_json::array();
  for (const ForeignElement& element : cloud.foreign_elements) {
    file["elements"].push_back(element.header.substr(0, element.header.find('\n')));
  }
  file["defects"] = {{"positions_not_finite", defects.positions},
                     {"normals_unusable", defects.normals},
                     {"duplicate_positions", defects.duplicates}};
  file["problems"] = find_problems(loaded, defects, box, spacing);
  if (file["format"] == "E57") file["e57"] = e57_facts(path);
  if (file["format"] == "LAS") file["las"] = las_facts(path, cloud);
  file["warnings"] = loaded.warnings;
  return file;
}

std::string list_labels(const ordered_json& labels) {
  std::vector<std::string> parts;
  for (const auto& [label, count] : labels.items()) {
    parts.push_back(fmt::format("{} {} ({})", count.get<std::size_t>(),
                                name_of_class(static_cast<std::uint8_t>(std::stoi(label))), label));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string list_vector(const ordered_json& v) {
  return fmt::format("{} {} {}", v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
}

void print_line(std::string_view name, const std::string& value) {
  fmt::print("  {:<14} {}\n", name, value);
}

void print_attributes(const ordered_json& attributes) {
  for (const ordered_json& a : attributes) {
    const auto components = a["components"].get<std::size_t>();
    std::string text =
        fmt::format("{} {}", a["type"].get<std::string>(), a["name"].get<std::string>());
    if (components > 1) text += fmt::format(" x {}", components);
    if (a.contains("min")) {
      const bool narrow = a["type"] == name_of(ScalarType::kFloat32);
      for (const auto& [word, key] : {std::pair(", ", "min"), std::pair(" to ", "max")}) {
        const double value = a[key].get<double>();
        text += word +
                (narrow ? fmt::format("{}", static_cast<float>(value)) : fmt::format("{}", value));
      }
    }
    print_line("attribute", text);
  }
}

void print_defects(const ordered_json& defects) {
  std::vector<std::string> parts;
  for (const auto& [name, count] : defects.items()) {
    std::string words = name;
    std::replace(words.begin(), words.end(), '_', ' ');
    if (count != 0) parts.push_back(fmt::format("{} {}", count.get<std::size_t>(), words));
  }
  print_line("defects", parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", ")));
}

void print(const ordered_json& file) {
  fmt::print("{}\n", file["file"].get<std::string>());
  print_line("format", file["format"].get<std::string>());
  print_line("points", fmt::format("{}", file["points"].get<std::size_t>()));
  print_line("position type", file["position_type"].get<std::string>());
  if (file.contains("bounds")) {
    print_line("least x y z", list_vector(file["bounds"]["min"]));
    print_line("largest x y z", list_vector(file["bounds"]["max"]));
  }
  if (file.contains("mean_spacing")) {
    print_line("mean spacing", fmt::format("{:.6g}", file["mean_spacing"].get<double>()));
    print_line("median spacing", fmt::format("{:.6g}", file["median_spacing"].get<double>()));
  }
  const auto unusable = file["defects"]["normals_unusable"].get<std::size_t>();
  print_line("normals", !file["normals"].get<bool>() ? "no"
                        : unusable == 0              ? "yes, made unit"
                                        : fmt::format("yes, made unit; {} unusable", unusable));
  print_line("colours", file["colours"].get<bool>() ? "yes" : "no");
  print_line("labels", file.contains("labels") ? list_labels(file["labels"]) : "no");
  print_attributes(file["attributes"]);
  for (const auto& element : file["elements"]) print_line("also", element.get<std::string>());
  for (const auto& comment : file["comments"]) print_line("comment", comment.get<std::string>());
  print_defects(file["defects"]);
  for (const auto& problem : file["problems"]) print_line("problem", problem.get<std::string>());
  if (file.contains("e57")) print_e57_facts(file["e57"]);
  if (file.contains("las")) print_las_facts(file["las"]);
  for (const auto& warning : file["warnings"]) print_line("warning", warning.get<std::string>());
}

void write_json(const Request& request, const ordered_json& files, const Common& common) {
  if (request.json.empty()) return;
  // Names and comments of foreign files need not be UTF-8.
  const std::string text = files.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
  if (request.json == "-") {
    fmt::print("{}", text);
  } else {
    write_text_file(request.json, text, common.overwrite());
  }
}

void info(const Request& request, const Common& common) {
  if (request.json != "-") check_writable(request.json, common.overwrite());
  const Progress progress = console_progress(common);
  const Inputs inputs = find_inputs(request.inputs);
  Batch batch(inputs);
  ordered_json files = ordered_json::array();
  const auto add_failure = [&](const Failure& failure) {
    files.push_back({{"file", failure.input}, {"error", failure.error.what()}});
  };
  std::for_each(batch.failures().begin(), batch.failures().end(), add_failure);
  for (const std::filesystem::path& path : inputs.files) {
    throw_if_cancelled(&progress);
    if (!batch.run(path, [&] { files.push_back(describe(path)); })) {
      add_failure(batch.failures().back());
    } else if (request.json != "-") {
      print(files.back());
    }
  }
  write_json(request, files, common);
  batch.finish();
}

}  // namespace

void add_info(CLI::App& app, Common& common) {
  CLI::App* command = add_command(app, common, "info", "Says what point files hold",
                                  "pcednet info scan.ply\n"
                                  "pcednet info folder/ --json report.json\n"
                                  "pcednet info scan.ply --json -");
  auto request = std::make_shared<Request>();
  command->add_option("inputs", request->inputs, "Point files, or folders of them")->required();
  command->add_option("--json", request->json,
                      "Write the same as JSON to this file, or to stdout alone with -");
  command->callback([request, &common] { info(*request, common); });
}

}  // namespace pcednet::app
