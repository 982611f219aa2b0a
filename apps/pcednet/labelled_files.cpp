#include "labelled_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "batch.h"
#include "common.h"
#include "descriptor_options.h"
#include "memory_size.h"
#include "pcednet/cloud/class_table.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/outputs.h"
#include "pcednet/formats/format.h"
#include "pcednet/io/las/copc.h"
#include "pcednet/io/las/file.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/tiles/inputs.h"
#include "result_plan.h"
#include "workbench/truth/read_labelled.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kField = "Classification";

/// COPC is of a format that holds every code.
bool keeps_format(const fs::path& output) {
  return formats::format_for(output).is_las() && !io::is_copc_name(output);
}

/// The LAS header that a file is, or carries, without its points.
io::LasFile las_file_of(const fs::path& input) {
  const io::InputFile file(input);
  const formats::Format& format = formats::format_of(file);
  std::vector<std::string> ignored;
  if (format.is_las()) return io::read_las_file(file, ignored);
  if (!format.is_tiled()) return {};
  return io::attached_las_file(tiles::read_finished(*tiles::open_chunks(input), 0));
}

void check_fits(const LasCodes& codes, const Job& job, const io::LasFile& las) {
  if (las.header.empty()) return;
  const unsigned format = las.point_format();
  for (const io::LasField& field : io::las_standard_fields(format)) {
    if (field.name != kField || field.bits == 0) continue;
    const int most = (1 << field.bits) - 1;
    for (const auto& [edge_class, code] : codes) {
      if (code <= most) continue;
      throw Error(
          ErrorKind::kUsage,
          fmt::format("{}: --las-classification {}={} does not fit point format {}, which "
                      "{} keeps: its codes are 0 to {}. Point formats 6 to 10, and "
                      ".copc.laz, hold codes up to 255",
                      job.input.string(), edge_class, code, format, job.output.string(), most));
    }
  }
}

/// Clouds with own classes, as the annotator saves them, give a model with these classes.
void take_classes(const std::filesystem::path& input, const PointCloud& cloud, bool is_first,
                  detect::TrainOptions& options) {
  const ClassTable table = classes_of(cloud.comments);
  if (is_first) options.table = table;
  if (table == options.table) return;
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: its classes are {}, those of the first cloud {}", input.string(),
                          pcednet::names_of(table), pcednet::names_of(options.table)));
}

/// Labels of other classes are not learnt from.
void warn_of_labels(const std::filesystem::path& input, const PointCloud& cloud,
                    const ClassTable& table) {
  const auto others = std::count_if(
      cloud.labels.begin(), cloud.labels.end(),
      [&](std::uint8_t label) { return label >= table.size() && label != kUnlabelled; });
  if (others == 0) return;
  warn(fmt::format("{}: {} labels are none of the classes {}: taken as unlabelled", input.string(),
                   others, pcednet::names_of(table)));
}

/// Three classes cannot be learnt from labels of two, and an edge that has but one kind is sharp.
void check_kinds_of_edges(std::span<const detect::NamedLabels> clouds,
                          const detect::TrainOptions& options) {
  if (has_own_classes(options.table)) return;
  const auto has = [&](EdgeClass wanted) {
    return std::any_of(clouds.begin(), clouds.end(), [&](const auto& cloud) {
      return std::find(cloud.labels.begin(), cloud.labels.end(), wanted) != cloud.labels.end();
    });
  };
  const bool smooth = has(kSmoothEdge), sharp = has(kSharpEdge);
  if (smooth == sharp || (sharp && options.architecture.classes != 3)) return;
  throw Error(ErrorKind::kInsufficient,
              sharp ? "train: no point is labelled smooth-edge (1); --classes 2 learns sharp-edge "
                      "(2) alone, --start general needs no point of it"
                    : "train: no point is labelled sharp-edge (2), but points are smooth-edge (1): "
                      "if 1 stands for any edge, write 2 in its place and give --classes 2");
}

}  // namespace

LasCodes las_codes(const std::string& pairs, std::size_t classes) {
  LasCodes codes;
  if (pairs.empty()) return codes;
  for (const std::string& pair : CLI::detail::split(pairs, ',')) {
    const std::vector<std::string> words = CLI::detail::split(CLI::detail::trim_copy(pair), '=');
    const auto edge_class = io::parse_count(words.front()), code = io::parse_count(words.back());
    if (words.size() != 2 || !edge_class || *edge_class >= classes || !code || *code > 255) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("--las-classification: \"{}\" is not class=code, class 0 to {}, code "
                              "0 to 255",
                              pair, classes - 1));
    }
    codes.emplace_back(static_cast<int>(*edge_class), static_cast<int>(*code));
  }
  return codes;
}

void add_label_codes_option(CLI::App& command, std::string& pairs) {
  command.add_option("--las-classification", pairs,
                     "Take the labels from the LAS field Classification: class=code,..., such as "
                     "0=2,0=6,2=64; points of other codes are unlabelled");
}

LasCodes label_codes(const std::string& pairs) {
  const LasCodes codes = las_codes(pairs, edge_classes().size());
  for (auto pair = codes.begin(); pair != codes.end(); ++pair) {
    const auto same = std::find_if(codes.begin(), pair, [&](const auto& before) {
      return before.second == pair->second && before.first != pair->first;
    });
    if (same == pair) continue;
    throw Error(ErrorKind::kUsage,
                fmt::format("--las-classification: code {} stands for the classes {} and {}",
                            pair->second, same->first, pair->first));
  }
  return codes;
}

void check_codes_fit(const LasCodes& codes, const std::vector<Job>& jobs) {
  if (codes.empty()) return;
  for (const Job& job : jobs) {
    std::error_code ignored;  // a pipe can be read only once
    if (!keeps_format(job.output) || !fs::is_regular_file(job.input, ignored)) continue;
    io::LasFile las;
    try {
      las = las_file_of(job.input);
    } catch (const Error&) {
      continue;  // told where the input is read
    }
    check_fits(codes, job, las);
  }
}

void check_codes_fit(const LasCodes& codes, const Job& job, const PointCloud& cloud) {
  if (codes.empty() || !keeps_format(job.output)) return;
  check_fits(codes, job, io::attached_las_file(cloud));
}

void set_las_codes(const LasCodes& codes, const std::vector<std::uint8_t>& classes,
                   PointCloud& cloud) {
  if (codes.empty()) return;
  const Attribute* present = find_attribute(cloud, kField);
  std::vector<std::uint8_t> values(cloud.size());
  if (present && present->type == ScalarType::kUint8 && present->components == 1) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<std::uint8_t>(present->bytes[i]);
    }
  }
  for (const auto& [edge_class, code] : codes) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (classes[i] == edge_class) values[i] = code;
    }
  }
  set_attribute(cloud, make_attribute(kField, values));
}

std::vector<LabelledFile> read_labelled_files(const std::vector<std::string>& inputs,
                                              const LasCodes& codes, bool no_normals,
                                              detect::TrainOptions& options,
                                              const Progress& progress) {
  std::vector<LabelledFile> files;
  for (const auto& input : without_results(expand_inputs(inputs))) {
    with_name_in_errors(input, [&] {
      io::LoadedCloud loaded = truth::read_labelled(input, codes);
      warn_all(input, loaded.warnings);
      files.push_back({input, std::move(loaded.cloud)});
    });
    throw_if_cancelled(&progress);
    PointCloud& cloud = files.back().cloud;
    if (no_normals) cloud.normals.clear();
    take_classes(input, cloud, files.size() == 1, options);
    warn_of_labels(input, cloud, options.table);
    check_scales(input, bounding_box(cloud.positions), options.descriptor);
  }
  return files;
}

void check_can_learn(std::span<const detect::NamedLabels> labels,
                     const detect::TrainOptions& options) {
  check_kinds_of_edges(labels, options);
  detect::check_labels(labels, options);
}

void warn_of_memory(std::span<const LabelledFile> files, const detect::TrainOptions& options,
                    bool describes_all) {
  constexpr std::uint64_t kPrepared = 140, kEstimatingNormals = 640;  // bytes a point, measured
  const std::uint64_t row = detect::row_width(options.descriptor) * sizeof(float);
  std::uint64_t points = 0, training = 0, normals = 0;
  for (const auto& [path, cloud] : files) {
    const auto labelled = std::ranges::count_if(cloud.labels, [&](std::uint8_t label) {
      return detect::is_learnt_from(label, options.table);
    });
    const auto described = describes_all ? cloud.size() : static_cast<std::size_t>(labelled);
    points += cloud.size();
    training += kPrepared * cloud.size() + row * described;
    if (!cloud.has_normals()) normals = std::max(normals, kEstimatingNormals * cloud.size());
  }
  const std::uint64_t most = std::max(training, normals), free = free_memory();
  if (most <= free) return;
  warn(
      fmt::format("train: {} points may take {} of memory, more than the {} that are free; the "
                  "surroundings of the labelled points alone take less",
                  points, size_text(most), size_text(free)));
}

}  // namespace pcednet::app
