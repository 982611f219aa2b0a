#include "workbench/truth/read_labelled.h"

#include <fmt/format.h>

#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/detect/result_truth.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/io/text_scan.h"
#include "workbench/truth/abc_features.h"
#include "workbench/truth/colour_labels.h"

namespace pcednet::truth {

namespace {

/// The labels of a result are no truth: those that were painted, or those of its input, are.
void take_truth_of_result(io::LoadedCloud& loaded) {
  auto truth = detect::truth_of_result(loaded.cloud);
  if (!truth) return;
  if (!truth->labels.empty()) loaded.cloud.labels = std::move(truth->labels);
  loaded.warnings.push_back(std::move(truth->note));
}

}  // namespace

io::LoadedCloud read_labelled(const std::filesystem::path& path) {
  io::LoadedCloud loaded = formats::read_cloud(path);
  PointCloud& cloud = loaded.cloud;
  if (cloud.has_labels()) take_truth_of_result(loaded);
  if (cloud.empty() || cloud.has_labels()) return loaded;
  if (io::extension_of(path) == ".obj") {
    const std::filesystem::path features = find_abc_features(path);
    if (!features.empty()) {
      cloud.labels = read_abc_labels(features, cloud.size());
      loaded.warnings.push_back(fmt::format("labels from {}", features.string()));
      return loaded;
    }
  }
  cloud.labels = labels_of_colours(cloud);
  if (cloud.labels.empty()) {
    throw Error(ErrorKind::kInsufficient, fmt::format("{}: has no labels", path.string()));
  }
  loaded.warnings.emplace_back("labels from the colours: grey, yellow and red are the classes");
  take_truth_of_result(loaded);
  return loaded;
}

}  // namespace pcednet::truth
