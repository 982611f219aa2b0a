#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>

#include "batch.h"
#include "classify_cloud.h"
#include "commands.h"
#include "common.h"
#include "las_codes.h"
#include "methods.h"
#include "models.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/result_cloud.h"
#include "pcednet/detect/result_truth.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/gls/scales.h"
#include "result_plan.h"
#include "stage_clock.h"
#include "tiled_cloud.h"
#include "view_options.h"
#include "workbench/render/preview.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

struct ClassifyArguments {
  std::vector<std::string> inputs;
  ResultArguments results;
  std::string las_classification, memory;
  LasCodes codes;  ///< those of las_classification
  ModelArguments model{.name = kDefaultModel};
  MethodArguments method;
  detect::PrepareOptions preparation;
  std::vector<double> viewpoint;
  bool class_colours = false, ascii = false;
};

render::PreviewOptions preview_options(const ClassifyArguments& arguments,
                                       const detect::EdgeModel& model, const Common& common) {
  return {.view_direction = arguments.results.preview.direction,
          .overwrite = common.overwrite(),
          .table = model.table};
}

double percent(std::size_t count, std::size_t points) {
  return 100.0 * static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(points, 1));
}

std::string edge_counts(const detect::ClassCounts& counts, std::size_t points) {
  return fmt::format("{} sharp-edge ({:.1f} %), {} smooth-edge ({:.1f} %), {}{} non-edge",
                     counts.sharp, percent(counts.sharp, points), counts.smooth,
                     percent(counts.smooth, points),
                     counts.boundary == 0 ? std::string()
                                          : fmt::format("{} boundary ({:.1f} %), ", counts.boundary,
                                                        percent(counts.boundary, points)),
                     counts.non_edge);
}

/// Points of every class.
using Counts = std::array<std::size_t, 256>;

void count(const std::vector<std::uint8_t>& classes, Counts& counts) {
  for (const std::uint8_t id : classes) ++counts[id];
}

/// The counts of all classes of a model with own classes.
std::string own_counts(const Counts& counts, const ClassTable& table, std::size_t points) {
  std::string text;
  for (std::size_t id = 0; id < table.size(); ++id) {
    if (counts[id] == 0) continue;
    text += fmt::format("{}{} {} ({:.1f} %)", text.empty() ? "" : ", ", counts[id], table[id].name,
                        percent(counts[id], points));
  }
  return text;
}

/// Such as "fewer than 4000 distinct points, estimated normals".
std::string in_words(const detect::CloudKind& kind) {
  std::vector<std::string> words;
  if (kind.below > 0) words.push_back(fmt::format("fewer than {} distinct points", kind.below));
  if (kind.estimated) words.emplace_back(*kind.estimated ? "estimated normals" : "given normals");
  if (kind.exact) words.emplace_back("exact points");
  if (kind.noisy) words.emplace_back("noisy points");
  return fmt::format("{}", fmt::join(words, ", "));
}

void report(const Job& job, const detect::Classification& result, const Counts& counts,
            const detect::EdgeModel& model, const std::string& seconds) {
  const std::size_t points = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  say(fmt::format("{}: {} points: {}{}", job.input.string(), points,
                  has_own_classes(model.table) ? own_counts(counts, model.table, points)
                                               : edge_counts(result.counts, points),
                  result.counts.unlabelled == 0
                      ? std::string()
                      : fmt::format(", {} unlabelled", result.counts.unlabelled)));
  if (result.s_max > 0.0) {  // a method has none
    gls::ScaleRange range = model.descriptor.range;
    range.s_min = result.s_min, range.s_max = result.s_max;
    say(fmt::format(
        "  scales: {:.9g} to {:.9g}{}", range.s_min, range.s_max,
        gls::octave_count(range) > 1 ? ", the larger ones where points are sparser" : ""));
  }
  if (result.expert) {
    say(fmt::format("  decided by the networks for clouds of this kind: {}",
                    in_words(*result.expert)));
  }
  say("  seconds: " + seconds);
  say(fmt::format("  -> {}", job.output.string()));
  if (!job.preview.empty()) say(fmt::format("  -> {}", job.preview.string()));
}

void say_kept(const std::filesystem::path& input, const detect::KeptInput& kept) {
  if (kept.labels) say(fmt::format("  the input's labels are kept as {}", detect::kInputLabels));
  if (kept.colours) say("  the input's colours are kept; --class-colours replaces them");
  warn_of_replaced(input.string(), kept.replaced);
}

/// Adds the result to the cloud, with the user's options.
detect::KeptInput add_found(std::span<const Vec3> made, const detect::Classification& found,
                            const ClassifyArguments& arguments, const detect::EdgeModel& model,
                            PointCloud& cloud) {
  const detect::KeptInput kept =
      detect::add_result(cloud, made, found, model, {.class_colours = arguments.class_colours});
  set_las_codes(arguments.codes, found.classes, cloud);
  return kept;
}

/// Appends every n-th point of a part, about four million in total, which suffice for a picture.
void draw_some(const PointCloud& part, std::size_t before, std::size_t all, PointCloud& drawn) {
  constexpr std::size_t kMost = 4'000'000;
  const std::size_t step = all / kMost + 1;
  for (std::size_t i = (step - before % step) % step; i < part.size(); i += step) {
    drawn.positions.push_back(part.positions[i]);
    drawn.labels.push_back(part.labels[i]);
    if (part.has_normals()) drawn.normals.push_back(part.normals[i]);
  }
}

void classify_large_file(const Job& job, const ClassifyArguments& arguments,
                         const TilesNeeded& needed, const detect::EdgeModel& model,
                         const Common& common) {
  say(needed.reason + ": classified in tiles");
  StageClock clock(console_progress(common));
  const TiledCloud cloud({.input = job.input,
                          .output = job.output,
                          .model = arguments.model,
                          .preparation = arguments.preparation,
                          .viewpoint = place_in(arguments.viewpoint),
                          .memory = needed.memory},
                         model, clock.progress());
  const detect::Classification& result = cloud.found();
  std::optional<detect::KeptInput> kept;  // of the first part
  PointCloud drawn;
  Counts counts = {};
  const auto add_result = [&](PointCloud& part, const tiles::TileFindings& findings) {
    detect::Classification found = findings.found;
    found.s_min = result.s_min, found.s_max = result.s_max;
    auto kept_now = add_found(findings.made, found, arguments, model, part);
    if (!kept) kept = std::move(kept_now);
  };
  const auto see = [&](const PointCloud& part, std::size_t before) {
    count(part.labels, counts);
    if (!job.preview.empty()) draw_some(part, before, cloud.plan().points(), drawn);
  };
  const auto losses =
      write_tiled(job.output, cloud,
                  {.write = {.overwrite = common.overwrite(), .ascii = arguments.ascii},
                   .add_result = add_result,
                   .see = see},
                  clock.progress());
  if (kept) say_kept(job.input, *kept);
  warn_of_losses(job.output.string(), losses);
  if (!job.preview.empty()) {
    clock.begin("preview");
    render::write_preview(job.preview, drawn, drawn.labels,
                          preview_options(arguments, model, common));
  }
  report(job, result, counts, model, clock.seconds());
}

std::optional<TilesNeeded> tiles_for(const Job& job, const ClassifyArguments& arguments) {
  if (!arguments.method.name.empty()) return std::nullopt;
  return tiles_needed(job.input, job.output, memory_limit(arguments.memory));
}

void classify_file(const Job& job, const ClassifyArguments& arguments,
                   const detect::EdgeModel& model, const Common& common) {
  if (const auto needed = tiles_for(job, arguments)) {
    return classify_large_file(job, arguments, *needed, model, common);
  }
  StageClock clock(console_progress(common));
  const Progress& progress = clock.progress();
  clock.begin("read");
  PointCloud cloud = read_cloud(job.input, &progress);
  warn_of_withheld(job.input, cloud);
  set_viewpoint(job.input, arguments.viewpoint, cloud);
  check_codes_fit(arguments.codes, job, cloud);
  formats::check_positions(job.output, cloud);
  throw_if_cancelled(&progress);
  const bool by_method = !arguments.method.name.empty();
  clock.begin(by_method ? arguments.method.name : "normals");
  const auto [made, result] = all_points(classify_cloud(job.input, cloud,
                                                        {.model = by_method ? nullptr : &model,
                                                         .method = arguments.method,
                                                         .preparation = arguments.preparation,
                                                         .boundary = !arguments.model.no_boundary},
                                                        progress));
  clock.begin("write");
  say_kept(job.input, add_found(made, result, arguments, model, cloud));
  warn_of_losses(job.output.string(), formats::losses(job.output, cloud));
  formats::write_cloud(job.output, cloud,
                       {.overwrite = common.overwrite(),
                        .ascii = arguments.ascii,
                        .new_normals = made.empty(),
                        .progress = &progress});
  if (!job.preview.empty()) {
    clock.begin("preview");
    render::write_preview(job.preview, cloud, result.classes,
                          preview_options(arguments, model, common));
  }
  Counts counts = {};
  count(result.classes, counts);
  report(job, result, counts, model, clock.seconds());
}

/// Says that what is cut at the edge of a file looks like the end of a surface.
void warn_of_seams(const std::vector<fs::path>& inputs) {
  const auto adjoining = find_adjoining(inputs);
  if (!adjoining) return;
  warn(
      fmt::format("{} and {} adjoin: each file is classified by itself, which gives false edges "
                  "where it ends; pcednet tiles plan takes such files as one cloud",
                  adjoining->first.string(), adjoining->second.string()));
}

void classify(ClassifyArguments arguments, const Common& common) {
  detect::EdgeModel model;
  if (arguments.method.name.empty()) {
    model = load_model(arguments.model);
  } else {
    model.name = "none, method " + arguments.method.name;
  }
  arguments.codes = las_codes(arguments.las_classification, model.table.size());
  const Inputs inputs = find_inputs(arguments.inputs);
  Batch batch(inputs);
  MadeFolder folder(arguments.results.folder);
  const auto [jobs, skipped] = plan_results(inputs, arguments.results, common);
  std::vector<fs::path> used_inputs, outputs;
  for (const Job& job : jobs) {
    used_inputs.push_back(job.input);
    outputs.push_back(job.output);
  }
  check_ascii(arguments.ascii, outputs);
  check_codes_fit(arguments.codes, jobs);
  const fs::path used = model_file(arguments.model);
  for (const Job& job : jobs) {
    for (const auto& file : {job.output, job.preview}) check_not_input(file, used);
  }
  folder.keep();
  if (arguments.method.name.empty()) warn_of_seams(used_inputs);
  std::size_t done = 0;
  for (const Job& job : jobs) {
    done += batch.run(job.input, [&] { classify_file(job, arguments, model, common); }) ? 1 : 0;
  }
  if (inputs.count() > 1 || skipped > 0) {
    say(fmt::format("{} classified, {} skipped because their results exist, {} failed", done,
                    skipped, batch.failures().size()));
  }
  batch.finish();
}

}  // namespace

void add_classify(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<ClassifyArguments>();
  CLI::App* command = add_command(
      app, common, "classify", "Label every point: non-edge, smooth-edge, sharp-edge or boundary",
      "pcednet classify scan.ply                       writes scan_edges.ply\n"
      "pcednet classify scan.ply -o out.ply --preview out.png\n"
      "pcednet classify folder/ --out-dir results/     every point file in a folder\n"
      "pcednet classify folder/ --out-dir results/ --skip-existing    the rest, after a stop\n"
      "pcednet classify small.ply --s-min 0.02 --s-max 0.2     scales in the unit of the cloud\n"
      "pcednet classify part.ply --model my.safetensors");
  command->add_option("inputs", arguments->inputs, "Point files or folders of point files")
      ->required();
  command->add_option(
      "-o,--output", arguments->results.output,
      "Output file (default: <stem>_edges.ply beside the input, .las for LAS, .laz for LAZ)");
  command->add_option("--las-classification", arguments->las_classification,
                      "Set the LAS field Classification of some classes, as class=code,...: 2=31 "
                      "sets sharp edges to 31. Codes above 31 are for point formats 6 to 10");
  command->add_option("--out-dir", arguments->results.folder,
                      "Folder for the results, created if missing");
  CLI::Option* overwrite = command->get_option("--overwrite");
  command
      ->add_flag("--skip-existing", arguments->results.skip_existing,
                 "Leave out inputs whose result exists, as after a stop")
      ->excludes(overwrite);
  add_model_options(*command, arguments->model);
  add_memory_option(*command, arguments->memory);
  add_preview_options(*command, arguments->results.preview,
                      "Draw the labelled cloud to this PNG file");
  command->add_flag("--class-colours", arguments->class_colours,
                    "Colour the points by class even if the input has colours");
  command->add_flag("--ascii", arguments->ascii, "Write .ply and .pcd as text");
  add_method_options(*command, arguments->method);
  add_prepare_options(*command, arguments->preparation);
  add_viewpoint_option(*command, arguments->viewpoint);
  for (const char* of_a_model : {"--model", "--no-context", "--no-boundary", "--exact", "--s-min",
                                 "--s-max", "--keep-orientation", "--viewpoint", "--max-memory"}) {
    command->get_option(of_a_model)->excludes("--method");
  }
  command->callback([arguments, &common] { classify(*arguments, common); });
}

}  // namespace pcednet::app
