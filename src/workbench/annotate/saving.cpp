#include "workbench/annotate/saving.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "pcednet/detect/result_cloud.h"
#include "pcednet/detect/result_truth.h"
#include "pcednet/formats/format.h"
#include "pcednet/io/las/las.h"
#include "workbench/annotate/learn/outputs.h"
#include "workbench/annotate/project/painting.h"

namespace pcednet::annotate {

namespace fs = std::filesystem;

namespace {

/// Whether `name` is that of a file, not of a folder or of a hidden file, to every function that
/// takes it: one ends it at a NUL byte, another at a slash. JSON has seen to it that it is UTF-8.
bool is_plain(const std::string& name) {
  const auto is_odd = [](unsigned char c) { return c < ' ' || c == 127 || c == '/' || c == '\\'; };
  return !name.empty() && name.size() <= 200 && name[0] != '.' &&
         std::none_of(name.begin(), name.end(), is_odd);
}

bool is_drawing(const fs::path& name) {
  const auto formats = io::drawing_formats();
  return std::any_of(formats.begin(), formats.end(), [&](const io::DrawingFormat& format) {
    return format.extension == name.extension();
  });
}

/// The suffix after the input's stem. A LAS cloud stays LAS, for the user's other programs.
std::string ending_of(Saved what, const fs::path& input) {
  if (what == Saved::kModel) return ".safetensors";
  if (what == Saved::kLines) return "_lines.dxf";
  const formats::Format* format = formats::find_format(input);
  const bool stays = format && format->is_las();
  return "_annotated" + (stays ? input.extension().string() : ".ply");
}

bool fits(Saved what, const fs::path& name) {
  if (what == Saved::kModel) return name.extension() == ".safetensors";
  if (what == Saved::kProject) return name.extension() == ".json";
  if (what == Saved::kLines) return is_drawing(name);
  const formats::Format* format = formats::find_format(name);
  return format && format->is_written();
}

/// Whether both are one file, or will be.
bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) || fs::weakly_canonical(a) == fs::weakly_canonical(b);
}

/// `path` or, as a start is never overwritten, the first of `stem_2`, `stem_3` and so on that is
/// none.
fs::path beside_starts(const fs::path& path, std::span<const fs::path> starts) {
  fs::path free = path;
  const auto is_start = [&](const fs::path& start) { return is_same(free, start); };
  for (int number = 2; std::any_of(starts.begin(), starts.end(), is_start); ++number) {
    free.replace_filename(path.stem().string() + fmt::format("_{}", number) +
                          path.extension().string());
  }
  return free;
}

}  // namespace

fs::path default_project(const fs::path& input) {
  return input.parent_path() / (formats::stem_of(input) + "_annotation.json");
}

fs::path saving_path(Saved what, const std::string& name, std::span<const fs::path> inputs,
                     std::size_t cloud, const fs::path& project, std::span<const fs::path> starts) {
  const bool has_own = what == Saved::kCloud || what == Saved::kLines;
  const fs::path& input = inputs[has_own ? cloud : 0];
  if (!name.empty() && !(is_plain(name) && fits(what, name))) {
    throw Error(ErrorKind::kUsage,
                fmt::format("name: a file name without folder, ending in {} for a cloud, "
                            ".safetensors for a model, .json for a project, {} for lines",
                            formats::extensions_written(" or "), io::drawing_extensions(" or ")));
  }
  fs::path path = input.parent_path() / name;
  if (name.empty()) {
    if (what == Saved::kProject) return project;
    path = beside_starts(path / (formats::stem_of(input) + ending_of(what, input)), starts);
  }
  std::vector<fs::path> all_kept(inputs.begin(), inputs.end());
  all_kept.insert(all_kept.end(), {journal_of(project), project});
  all_kept.insert(all_kept.end(), starts.begin(), starts.end());
  for (const fs::path& kept : all_kept) {
    if ((what != Saved::kProject || kept != project) && is_same(path, kept)) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("name: {} itself is never overwritten", kept.filename().string()));
    }
  }
  return path;
}

void write_lines(const std::filesystem::path& path, const LineReview& review,
                 const PointCloud& cloud, Overwrite overwrite, io::DxfArcs arcs) {
  io::write_drawing(path, accepted_curves(review),
                    {.overwrite = overwrite,
                     .fit_tolerance = review.tolerance,
                     .dxf_arcs = arcs,
                     .coordinate_system = io::las_coordinate_system(cloud)});
}

PointCloud saved_cloud(const Scene& scene, const std::vector<std::uint8_t>& labels,
                       const ClassTable& table, const Prediction* prediction) {
  PointCloud cloud = scene.cloud;
  if (prediction) {
    detect::add_result(cloud, scene.prepared, prediction->result,
                       with_names(prediction->model, table));
  } else {
    if (cloud.has_labels()) {
      set_attribute(cloud, make_attribute(detect::kInputLabels, cloud.labels));
    }
    cloud.labels = labels;
  }
  if (has_own_classes(table)) detect::add_class_comments(cloud, table);
  set_attribute(cloud, make_attribute(detect::kPaintedLabels, labels));
  return cloud;
}

}  // namespace pcednet::annotate
