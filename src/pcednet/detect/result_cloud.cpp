#include "pcednet/detect/result_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pcednet/cloud/class_table.h"
#include "pcednet/core/version.h"
#include "pcednet/detect/averages.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/result_truth.h"

namespace pcednet::detect {
namespace {

constexpr Rgb kUnlabelledColour = {128, 128, 128};

/// The classes in one comment.
std::string edge_class_comment() {
  std::string comment = "pcednet classes";
  for (const auto& [edge_class, name, colour] : kEdgeClasses) {
    comment += fmt::format(" {} {}", static_cast<int>(edge_class), name);
  }
  return comment + fmt::format(" {} unlabelled", static_cast<int>(kUnlabelled));
}

/// Replaces comments of an earlier classification.
void replace_comments(PointCloud& cloud, bool estimated_normals, const EdgeModel& model,
                      const Classification& result) {
  std::erase_if(cloud.comments,
                [](const std::string& comment) { return comment.starts_with("pcednet "); });
  cloud.comments.push_back(fmt::format("pcednet {}", kVersion));
  cloud.comments.push_back(fmt::format("{}{}", kModelComment, model.name));
  cloud.comments.push_back(fmt::format("pcednet seed {}", model.seed));
  if (result.s_max > 0.0) {
    cloud.comments.push_back(
        fmt::format("pcednet scales {:.9g} to {:.9g}", result.s_min, result.s_max));
  }
  set_estimated_normals(cloud, estimated_normals);
  if (has_own_classes(model.table)) {
    add_class_comments(cloud, model.table);
  } else {
    cloud.comments.push_back(edge_class_comment());
  }
}

/// Adds the columns of the result, and removes those of other classes.
void set_columns(PointCloud& cloud, const Classification& result, const ClassTable& table) {
  const bool edges = has_edges(table), own = has_own_classes(table);
  if (edges) {
    erase_attribute(cloud, "scalar_class");
  } else {
    erase_attribute(cloud, "scalar_edge_class");
    erase_attribute(cloud, "scalar_p_sharp");
    erase_attribute(cloud, "scalar_p_smooth");
  }
  if (own) {
    set_attribute(cloud, make_attribute("quality", result.p_class));
    set_attribute(cloud,
                  make_attribute(edges ? "scalar_edge_class" : "scalar_class", result.classes));
    set_attribute(cloud, make_attribute("scalar_p_class", result.p_class));
    if (!edges) return;
  } else {
    erase_attribute(cloud, "scalar_p_class");
    std::vector<float> edge(result.classes.size());
    for (std::size_t i = 0; i < edge.size(); ++i) edge[i] = result.p_sharp[i] + result.p_smooth[i];
    set_attribute(cloud, make_attribute("quality", edge));
    set_attribute(cloud, make_attribute("scalar_edge_class", result.classes));
  }
  set_attribute(cloud, make_attribute("scalar_p_sharp", result.p_sharp));
  set_attribute(cloud, make_attribute("scalar_p_smooth", result.p_smooth));
}

}  // namespace

std::vector<std::string> replaced_attributes(const PointCloud& cloud) {
  if (names_model(cloud)) return {};
  std::vector<std::string> names;
  for (const std::string name : {"edge_class", "class", "p_sharp", "p_smooth", "p_class"}) {
    if (find_attribute(cloud, "scalar_" + name)) names.push_back(name);
  }
  if (find_attribute(cloud, "quality")) names.emplace_back("quality");
  return names;
}

void add_class_comments(PointCloud& cloud, const ClassTable& table) {
  std::erase_if(cloud.comments,
                [](const std::string& comment) { return comment.starts_with(kClassComment); });
  for (std::string& line : lines_of(table, kClassComment)) {
    cloud.comments.push_back(std::move(line));
  }
}

KeptInput add_result(PointCloud& cloud, const PreparedCloud& prepared, const Classification& result,
                     const EdgeModel& model, const ResultOptions& options) {
  if (!prepared.is_averaged()) {
    return add_result(cloud, prepared.made, result, model, options);
  }
  return add_result(cloud, of_all_points(prepared, prepared.made), of_all_points(prepared, result),
                    model, options);
}

KeptInput add_result(PointCloud& cloud, std::span<const Vec3> made, const Classification& result,
                     const EdgeModel& model, const ResultOptions& options) {
  check_size(result, cloud.size());
  KeptInput kept{.replaced = replaced_attributes(cloud)};
  const bool classified_before = names_model(cloud) || has_result_columns(cloud);
  if (cloud.has_labels() && !classified_before) {
    set_attribute(cloud, make_attribute(kInputLabels, cloud.labels));
    kept.labels = true;
  }
  const bool estimated =
      has_estimated_normals(cloud) ||
      (!made.empty() && std::none_of(cloud.normals.begin(), cloud.normals.end(), is_usable));
  if (!made.empty()) cloud.normals.assign(made.begin(), made.end());
  if (cloud.colours.empty() || options.class_colours) {
    cloud.colours.resize(cloud.size());
    std::transform(result.classes.begin(), result.classes.end(), cloud.colours.begin(),
                   [&](std::uint8_t id) {
                     return id < model.table.size() ? model.table[id].colour : kUnlabelledColour;
                   });
  } else {
    kept.colours = true;
  }
  set_columns(cloud, result, model.table);
  cloud.labels = result.classes;
  replace_comments(cloud, estimated, model, result);
  return kept;
}

}  // namespace pcednet::detect
