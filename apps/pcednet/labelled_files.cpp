#include "labelled_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "batch.h"
#include "common.h"
#include "descriptor_options.h"
#include "memory_size.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/outputs.h"
#include "result_plan.h"
#include "workbench/truth/read_labelled.h"

namespace pcednet::app {
namespace {

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
