#include "workbench/annotate/scene/file_classes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

#include "pcednet/cloud/class_table.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/result_truth.h"
#include "pcednet/formats/labels.h"
#include "pcednet/io/las/facts.h"
#include "pcednet/io/promote.h"

namespace pcednet::annotate {
namespace {

/// By code: colours that maps use for such things.
constexpr std::array<Rgb, io::kLasClasses> kLasColours = {{
    {125, 132, 142},  // never classified
    {190, 196, 204},  // unassigned
    {166, 118, 66},   // ground
    {188, 214, 110},  // low vegetation
    {108, 179, 68},   // medium vegetation
    {38, 118, 46},    // high vegetation
    {222, 94, 56},    // building
    {216, 27, 96},    // low noise
    {134, 87, 168},   // model key point
    {47, 120, 183},   // water
    {93, 74, 102},    // rail
    {72, 82, 96},     // road surface
    {201, 166, 216},  // overlap
    {242, 212, 61},   // guard wire
    {240, 163, 10},   // conductor wire
    {122, 75, 158},   // transmission tower
    {194, 92, 150},   // wire connector
    {127, 200, 216},  // bridge deck
    {255, 64, 129},   // high noise
    {138, 106, 79},   // overhead structure
    {214, 190, 150},  // ignored ground
    {240, 246, 252},  // snow
    {84, 92, 104},    // temporal exclusion
}};

FileClass las_class(std::uint8_t code) {
  if (code >= kLasColours.size()) {
    return {.id = code, .name = fmt::format("class {}", code), .colour = usual_colour(code)};
  }
  const std::string name = fmt::format("{} {}", code, io::las_class_name(code));
  return {.id = code, .name = name, .colour = kLasColours[code]};
}

FileClass class_of_table(std::uint8_t id, const ClassTable& table) {
  if (id >= table.size()) {
    return {.id = id, .name = fmt::format("class {}", id), .colour = usual_colour(id)};
  }
  return {.id = id, .name = table[id].name, .colour = table[id].colour};
}

FileClasses counted(std::vector<std::uint8_t> ids,
                    const std::function<FileClass(std::uint8_t id)>& class_of) {
  std::array<std::size_t, kUnlabelled + 1> counts = {};
  for (const std::uint8_t id : ids) ++counts[id];
  FileClasses found;
  for (std::size_t id = 0; id < kUnlabelled; ++id) {
    if (counts[id] == 0) continue;
    found.classes.push_back(class_of(static_cast<std::uint8_t>(id)));
    found.classes.back().points = counts[id];
  }
  if (!found.classes.empty()) found.ids = std::move(ids);
  return found;
}

/// A column of a name that we give may hold other numbers than ours: then it says nothing.
std::vector<std::uint8_t> own_labels(const PointCloud& cloud, const std::filesystem::path& file) {
  try {
    return formats::labels_of(cloud, file);
  } catch (const Error&) {
    return cloud.labels;
  }
}

}  // namespace

FileClasses file_labels(const PointCloud& cloud, const std::filesystem::path& file) {
  std::vector<std::uint8_t> ids;
  auto truth = detect::truth_of_result(cloud);
  if (truth) ids = std::move(truth->labels);
  const bool are_predicted = truth && ids.empty();
  if (ids.empty()) ids = own_labels(cloud, file);
  if (ids.empty()) {
    if (auto column = formats::edge_column_of(cloud)) ids = std::move(column->classes);
  }
  const ClassTable table = classes_of(cloud.comments);
  FileClasses found =
      counted(std::move(ids), [&](std::uint8_t id) { return class_of_table(id, table); });
  found.are_predicted = are_predicted;
  return found;
}

FileClasses las_classes(const PointCloud& cloud) {
  const Attribute* field = io::find_called(cloud, "classification");
  if (!field) return {};
  auto codes = io::to_labels(*field, cloud.size());
  if (!codes) return {};
  FileClasses found = counted(std::move(*codes), las_class);
  return found.classes.size() < 2 ? FileClasses{} : found;
}

std::uint8_t error_of(std::uint8_t predicted, std::uint8_t label) {
  if (predicted == kUnlabelled || label == kUnlabelled) return kUnlabelled;
  const bool found = predicted == kSharpEdge, is = label == kSharpEdge;
  if (found) return is ? 1 : 2;
  return is ? 3 : 0;
}

}  // namespace pcednet::annotate
