#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>

#include "batch.h"
#include "classify_cloud.h"
#include "commands.h"
#include "descriptor_options.h"
#include "number_options.h"
#include "pcednet/core/blocks.h"
#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/core/version.h"
#include "pcednet/gls/engine/scale_space.h"
#include "pcednet/io/npy.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlock = std::size_t{1} << 18;  // points described at a time

struct DescribeArguments {
  std::string input, output;
  gls::ScaleSpaceOptions options;
  detect::PrepareOptions preparation;
};

using StatusCounts = std::array<std::size_t, 3>;

/// Describes every point into `matrix`, a range of the order at a time: neighbours in space share
/// work, regardless of the positions of their rows in the file.
StatusCounts write_matrix(const gls::ScaleSpace& space, std::size_t points, io::NpyWriter& matrix,
                          const Progress& progress) {
  const std::size_t scales = space.scales().size();
  const std::size_t row = scales * static_cast<std::size_t>(gls::column_count(space.options()));
  const std::span<const std::uint32_t> order = space.order();
  StatusCounts counts = {};
  std::vector<char> described(points);
  std::vector<std::uint32_t> targets;
  std::vector<float> features;
  std::vector<gls::FitStatus> status;
  const Progress cancel_only = without_report(&progress);
  Stage stage(&progress, "describe", points);
  const auto put_rows = [&] {  // runs of rows at once
    for (std::size_t i = 0, next = 0; i < targets.size(); i = next) {
      for (next = i + 1; next < targets.size() && targets[next] == targets[next - 1] + 1;) ++next;
      matrix.put(targets[i] * row, std::span(features).subspan(i * row, (next - i) * row));
    }
    stage.advance(targets.size());
  };
  for_each_block(order.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    const auto some = order.subspan(begin, end - begin);
    targets.assign(some.begin(), some.end());
    std::sort(targets.begin(), targets.end());
    features.resize(targets.size() * row);
    status.resize(targets.size() * scales);
    space.describe(targets, std::span(features), status, &cancel_only);
    for (const gls::FitStatus s : status) ++counts[static_cast<std::size_t>(s)];
    for (const std::uint32_t point : targets) described[point] = 1;
    put_rows();
  });
  targets.clear();  // points without a place have zeros
  for (std::uint32_t i = 0; i < points; ++i) {
    if (!described[i]) targets.push_back(i);
  }
  features.assign(targets.size() * row, 0.0f);
  counts[static_cast<std::size_t>(gls::FitStatus::kUndefined)] += targets.size() * scales;
  put_rows();
  return counts;
}

OrderedJson to_json(const DescribeArguments& arguments, const gls::ScaleSpace& space,
                    std::size_t points, const StatusCounts& counts) {
  const gls::ScaleSpaceOptions& options = space.options();
  OrderedJson json = {{"version", kVersion},
                      {"input", fs::path(arguments.input).filename().string()},
                      {"points", points},
                      {"scales", space.scales()},
                      {"features", gls::column_names(options)},
                      {"reconstruction", gls::name_of(options.reconstruction)},
                      {"gate", nullptr},
                      {"engine", options.engine == gls::Engine::kExact ? "exact" : "fast"}};
  if (gls::projects(options.reconstruction)) {
    json["max_projection_steps"] = options.max_projection_steps;
  }
  if (options.side_gate) json["gate"] = *options.side_gate;
  if (options.second_gate) json["second_gate"] = *options.second_gate;
  if (options.engine == gls::Engine::kFast) json["eps"] = options.eps;
  json["status"] = {{"stable", counts[0]}, {"unstable", counts[1]}, {"undefined", counts[2]}};
  return json;
}

void describe(const DescribeArguments& arguments, const Common& common) {
  const fs::path output = arguments.output;
  if (output.extension() != ".npy") {
    throw Error(ErrorKind::kUsage, fmt::format("{}: must end in .npy", output.string()));
  }
  const gls::ScaleSpaceOptions& options = arguments.options;
  // Fails before the work if the output cannot be written.
  const fs::path beside = fs::path(output).replace_extension(".json");
  check_one_cloud("describe", arguments.input);
  for (const fs::path& file : {output, beside}) check_not_input(file, arguments.input);
  for (const fs::path& file : {output, beside}) check_writable(file, common.overwrite());
  const PointCloud cloud = read_cloud(arguments.input);
  const Progress progress = console_progress(common);
  const auto prepared = prepare(arguments.input, cloud, arguments.preparation, progress);
  check_scales(arguments.input, bounding_box(cloud.positions), options);
  std::optional<gls::ScaleSpace> made;
  with_name_in_errors(arguments.input, [&] {
    made.emplace(gls::OrientedPoints{prepared.positions, prepared.normals, prepared.curve}, options,
                 &progress);
  });
  const gls::ScaleSpace& space = *made;
  if (const auto note = gls::note_on(options, space.scales(), cloud.positions); !note.empty()) {
    warn(fmt::format("{}: {}", arguments.input, note));
  }
  warn_of_rounding(arguments.input, cloud.position_type, prepared, options.range,
                   [&] { return space.scales().front(); });
  const auto width = static_cast<std::size_t>(gls::column_count(options));
  io::NpyWriter matrix(output, {cloud.size(), space.scales().size(), width}, ScalarType::kFloat32,
                       common.overwrite());
  OutputFile settings(beside, common.overwrite());
  const StatusCounts counts = write_matrix(space, cloud.size(), matrix, progress);
  matrix.commit();
  settings.write(to_text(to_json(arguments, space, cloud.size(), counts), 2, NotUtf8::kReplace) +
                 "\n");
  settings.commit();
  const std::vector<double>& scales = space.scales();
  say(fmt::format("{}: {} points, {} scales from {:.4g} to {:.4g}, {} numbers at each\n  -> {}, {}",
                  arguments.input, cloud.size(), scales.size(), scales.front(), scales.back(),
                  width, output.string(), beside.string()));
}

}  // namespace

void add_describe(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<DescribeArguments>();
  CLI::App* command = add_command(
      app, common, "describe", "Write the scale-space matrix of a cloud for NumPy",
      "pcednet describe scan.ply -o scan.npy      also writes scan.json: scales, columns\n"
      "pcednet describe part.ply -o part.npy --features 28 --scales 32\n"
      "pcednet describe part.ply -o part.npy --gate -0.2");
  command->add_option("input", arguments->input, "Point file")->required();
  command->add_option("-o,--output", arguments->output, "Output file, .npy")->required();
  add_descriptor_options(*command, arguments->options);
  command
      ->add_option("--eps", arguments->options.eps,
                   "Voxel size over scale; smaller is slower and more accurate")
      ->check(number("a number from 0.01 to 1", [](double v) { return v >= 0.01 && v <= 1.0; }))
      ->capture_default_str()
      ->excludes("--exact");
  add_prepare_options(*command, arguments->preparation);
  command->callback([arguments, &common] { describe(*arguments, common); });
}

}  // namespace pcednet::app
