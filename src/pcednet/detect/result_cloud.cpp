#include "pcednet/detect/result_cloud.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/cloud/edge_class.h"
#include "pcednet/core/version.h"

namespace pcednet::detect {
namespace {

constexpr Rgb kUnlabelledColour = {128, 128, 128};

Rgb colour_of(std::uint8_t edge_class) {
  return edge_class < kEdgeClasses.size() ? kEdgeClasses[edge_class].colour : kUnlabelledColour;
}

std::string class_comment() {
  std::string comment = "pcednet classes";
  for (const auto& [edge_class, name, colour] : kEdgeClasses) {
    comment += fmt::format(" {} {}", static_cast<int>(edge_class), name);
  }
  return comment + fmt::format(" {} unlabelled", static_cast<int>(kUnlabelled));
}

/// Comments of an earlier classification give way to those of this one.
void replace_comments(PointCloud& cloud, const EdgeModel& model, const Classification& result) {
  std::erase_if(cloud.comments,
                [](const std::string& comment) { return comment.starts_with("pcednet "); });
  cloud.comments.push_back(fmt::format("pcednet {}", kVersion));
  cloud.comments.push_back(fmt::format("pcednet model {}", model.name));
  cloud.comments.push_back(fmt::format("pcednet seed {}", model.seed));
  if (result.s_max > 0.0) {
    cloud.comments.push_back(
        fmt::format("pcednet scales {:.9g} to {:.9g}", result.s_min, result.s_max));
  }
  cloud.comments.push_back(class_comment());
}

}  // namespace

KeptInput add_result(PointCloud& cloud, const PreparedCloud& prepared, const Classification& result,
                     const EdgeModel& model, const ResultOptions& options) {
  KeptInput kept;
  const bool classified_before = find_attribute(cloud, "scalar_edge_class") != nullptr;
  if (cloud.has_labels() && !classified_before) {
    set_attribute(cloud, make_attribute("scalar_input_label", cloud.labels));
    kept.labels = true;
  }
  if (!prepared.made.empty()) cloud.normals = prepared.made;
  if (cloud.colours.empty() || options.class_colours) {
    cloud.colours.resize(cloud.size());
    std::transform(result.classes.begin(), result.classes.end(), cloud.colours.begin(), colour_of);
  } else {
    kept.colours = true;
  }
  std::vector<float> edge(result.classes.size());
  for (std::size_t i = 0; i < edge.size(); ++i) edge[i] = result.p_sharp[i] + result.p_smooth[i];
  set_attribute(cloud, make_attribute("quality", edge));
  set_attribute(cloud, make_attribute("scalar_edge_class", result.classes));
  set_attribute(cloud, make_attribute("scalar_p_sharp", result.p_sharp));
  set_attribute(cloud, make_attribute("scalar_p_smooth", result.p_smooth));
  cloud.labels = result.classes;
  replace_comments(cloud, model, result);
  return kept;
}

}  // namespace pcednet::detect
