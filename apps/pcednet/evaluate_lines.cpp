#include "evaluate_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <numbers>
#include <optional>

#include "batch.h"
#include "pcednet/eval/line_scores.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/io/drawing/read_curves.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

/// The first file STEM + ending, of the folders in turn; `place` itself if it is not a folder.
fs::path find_file(const fs::path& place, const std::vector<fs::path>& folders,
                   const std::string& stem, const std::vector<std::string>& endings) {
  std::error_code ignored;
  if (!fs::is_directory(place, ignored)) return place;
  for (const fs::path& folder : folders) {
    for (const std::string& ending : endings) {
      const fs::path path = folder / (stem + ending);
      if (fs::is_regular_file(path, ignored)) return path;
    }
  }
  return {};
}

fs::path find_truth(const fs::path& place, const std::string& stem) {
  return find_file(place, {place / "curves", place}, stem,
                   {"_curves.obj", "_curves.ply", ".obj", ".ply"});
}

fs::path find_cloud(const fs::path& place, const std::string& stem) {
  std::vector<std::string> endings;
  for (const formats::Format& format : formats::all_formats()) {
    endings.insert(endings.end(), format.extensions.begin(), format.extensions.end());
  }
  return find_file(place, {place}, stem, endings);
}

/// None if a folder has no file of them for `stem`; a point file of that name is the cloud.
std::optional<std::vector<lines::Curve>> read_truth(const fs::path& place,
                                                    const std::string& stem) {
  const fs::path file = find_truth(place, stem);
  if (file.empty()) return std::nullopt;
  const bool may_be_cloud = file != place && io::extension_of(file) == ".ply";
  try {
    auto curves = io::read_curves(file);
    if (!curves.empty()) return curves;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kInsufficient && may_be_cloud) return std::nullopt;
    throw;
  }
  throw Error(ErrorKind::kInsufficient, file.string() + ": has no curves to compare with");
}

/// An OBJ file with vertices only has no lines: a method that found nothing may write it. A PLY
/// file of lines says so with an element edge, even of none.
std::vector<lines::Curve> read_found(const fs::path& path) {
  try {
    return io::read_curves(path);
  } catch (const Error& error) {
    const bool is_obj = io::extension_of(path) == ".obj";
    if (error.kind() != ErrorKind::kInsufficient || !is_obj) throw;
    warn(std::string(error.what()) + ": taken for a result without lines");
    return {};
  }
}

/// How many ends of segments go on nearly straight in exactly one other segment.
std::size_t count_joints(const std::vector<lines::Curve>& curves) {
  std::map<std::array<double, 3>, std::vector<Vec3>> directions;  // away from each end
  for (const lines::Curve& curve : curves) {
    if (curve.points.size() != 2) continue;
    for (const std::size_t i : {0, 1}) {
      const Vec3& end = curve.points[i];
      directions[{end.x(), end.y(), end.z()}].push_back((curve.points[1 - i] - end).normalized());
    }
  }
  const double straight = -std::cos(15.0 * std::numbers::pi / 180.0);
  return static_cast<std::size_t>(
      std::count_if(directions.begin(), directions.end(), [&](const auto& place) {
        const auto& away = place.second;
        return away.size() == 2 && away[0].dot(away[1]) < straight;
      }));
}

/// Some programs write every piece of a polyline as a line of its own.
void warn_of_cut_curves(const fs::path& path, const std::vector<lines::Curve>& curves) {
  const std::size_t joints = count_joints(curves);
  if (2 * joints < curves.size() || curves.empty()) return;
  warn(
      fmt::format("{}: its {} lines are pieces of curves, which go on straight at {} ends: each "
                  "piece counts as a curve in `found`, `pieces` and `corners`",
                  path.string(), curves.size(), joints));
}

eval::LineFrame frame_for(const LineEvaluation& arguments, const std::string& stem,
                          const std::vector<lines::Curve>& truth) {
  if (arguments.cloud.empty()) return eval::frame_of_curves(truth);
  const fs::path cloud = find_cloud(arguments.cloud, stem);
  if (cloud.empty()) {
    throw Error(ErrorKind::kUnreadable, fmt::format("{}: no cloud {}.*", arguments.cloud, stem));
  }
  return eval::frame_of_cloud(formats::read_cloud(cloud).cloud.positions);
}

std::vector<eval::NamedLineScores> score_line_files(const LineEvaluation& arguments) {
  const EndsAtOnce scoring;
  std::vector<eval::NamedLineScores> scores;
  for (const fs::path& input : expand_inputs(arguments.inputs)) {
    const std::string stem = input.stem().string();
    const auto truth = read_truth(arguments.truth, stem);
    if (!truth) {
      warn(fmt::format("{}: no true curves in {}: left out", input.string(), arguments.truth));
      continue;
    }
    warn_of_cut_curves(find_truth(arguments.truth, stem), *truth);
    with_name_in_errors(input, [&] {
      const auto found = read_found(input);
      warn_of_cut_curves(input, found);
      scores.push_back(
          {stem, eval::score_lines(found, *truth, frame_for(arguments, stem, *truth))});
    });
  }
  if (scores.empty()) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: no true curves for any input", arguments.truth));
  }
  return scores;
}

}  // namespace

void evaluate_lines(const LineEvaluation& arguments, const Common& common) {
  check_not_inputs(arguments.json, arguments.inputs);
  check_not_inputs(arguments.json, {arguments.truth, arguments.cloud});
  if (arguments.json != "-") check_writable(arguments.json, common.overwrite());
  const std::vector<eval::NamedLineScores> scores = score_line_files(arguments);
  const std::string json = eval::to_json(scores);
  if (arguments.json == "-") {
    std::cout << json;
    return;
  }
  std::cout << eval::to_table(scores);
  if (!arguments.json.empty()) write_text_file(arguments.json, json, common.overwrite());
}

}  // namespace pcednet::app
