#include "pcednet/lines/find_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "batch.h"
#include "classify_cloud.h"
#include "commands.h"
#include "lines_arguments.h"
#include "lines_labels.h"
#include "lines_report.h"
#include "lines_tiles.h"
#include "models.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/averages.h"
#include "pcednet/formats/labels.h"
#include "pcednet/io/drawing/drawing.h"
#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/projection.h"
#include "pcednet/tiles/inputs.h"
#include "stage_clock.h"
#include "view_options.h"
#include "workbench/render/preview.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;
using lines::Curve;

/// The arguments of find_lines(), and the data behind them.
struct LabelledCloud {
  PointCloud cloud;
  detect::PreparedCloud prepared;
  detect::Classification found;
  std::vector<std::uint8_t> partial = {};
  bool given = false;  ///< the labels are those of the file, which was read whole
};

/// Lines that were drawn before are no points of a surface.
void warn_of_lines(const std::string& file, const PointCloud& cloud) {
  const auto is_edge = [](const ForeignElement& element) {
    return element.header.starts_with("element edge ");
  };
  if (std::none_of(cloud.foreign_elements.begin(), cloud.foreign_elements.end(), is_edge)) return;
  warn(file + ": has lines: their vertices are taken for points");
}

/// Throws before any work if the output could not be written after it.
void check_outputs(const LinesArguments& arguments) {
  const fs::path model = model_file(arguments.model);
  std::vector<fs::path> outputs(arguments.outputs.begin(), arguments.outputs.end());
  for (const fs::path& output : outputs) io::drawing_format_for(output);
  check_format_options(arguments);
  if (!arguments.preview.path.empty()) outputs.push_back(arguments.preview.path);
  for (const fs::path& output : outputs) {
    check_not_input(output, arguments.input);
    check_not_input(output, model);
    check_writable(output, arguments.drawing.overwrite);
  }
  check_distinct(outputs);
}

/// Throws for classes other than edge classes.
void check_edges(const std::string& whose, const ClassTable& table) {
  if (has_edges(table)) return;
  throw Error(ErrorKind::kUsage, fmt::format("{}: its classes are {}; lines are of edge classes",
                                             whose, pcednet::names_of(table)));
}

void add_given_labels(const LinesArguments& arguments, std::vector<std::uint8_t> classes,
                      LabelledCloud& labelled, const Progress& progress) {
  tell_labels(arguments.input, classes);
  const PointCloud& cloud = labelled.cloud;
  detect::Classification found = with_probabilities(arguments, cloud, std::move(classes));
  detect::PrepareOptions preparation = arguments.preparation;
  preparation.average_noise = true;
  labelled.prepared = prepare(arguments.input, cloud, preparation, progress);
  labelled.given = true;
  labelled.found = of_averages(labelled.prepared, std::move(found));
}

/// Reads the whole cloud, and classifies it if needed.
void read_labelled(const LinesArguments& arguments, StageClock& clock, LabelledCloud& labelled) {
  clock.begin("read");
  PointCloud& cloud = labelled.cloud;
  cloud = read_cloud(arguments.input, &clock.progress());
  set_viewpoint(arguments.input, arguments.viewpoint, cloud);
  warn_of_withheld(arguments.input, cloud);
  warn_of_lines(arguments.input, cloud);
  throw_if_cancelled(&clock.progress());
  std::vector<std::uint8_t> given = labels_to_draw(arguments, cloud);
  if (!arguments.classify) check_edges(arguments.input, classes_of(cloud.comments));
  clock.begin("normals");
  const bool labelled_before = formats::have_labels(given);
  if (labelled_before && !arguments.classify) {
    return add_given_labels(arguments, std::move(given), labelled, clock.progress());
  }
  const detect::EdgeModel model = load_model(arguments.model);
  check_edges(arguments.model.name, model.table);
  const char* const why = labelled_before ? "its labels are not used"
                          : given.empty() ? "no labels"
                                          : "all points are unlabelled (255)";
  say(fmt::format("{}: {}: classified by model {}", arguments.input, why, model.name));
  const Classifier classifier = {.model = &model,
                                 .preparation = arguments.preparation,
                                 .boundary = !arguments.model.no_boundary};
  ClassifiedCloud classified;
  with_name_in_errors(arguments.input, [&] {
    classified = classify_cloud(arguments.input, cloud, classifier, clock.progress());
  });
  labelled.prepared = std::move(classified.prepared);
  labelled.found = std::move(classified.found);
}

/// Whether a point of the file has a label: reads up to the first that has. What the numbers of a
/// column of edges mean, only all of them tell, so that it is passed over here, with a warning.
bool has_labels(const LinesArguments& arguments, const Progress& progress) {
  if (!arguments.codes.empty()) return true;
  const auto reader = tiles::open_chunks(arguments.input);
  for (std::size_t chunk = 0; chunk < reader->parts(); ++chunk) {
    throw_if_cancelled(&progress);
    const PointCloud part = tiles::read_finished(*reader, chunk);
    const auto given = formats::labels_of(part, arguments.input);
    const auto column = given.empty() ? formats::edge_column_of(part) : std::nullopt;
    if (column) {
      warn(fmt::format("{}: its column {} is read as labels only of a cloud that fits into memory",
                       arguments.input, column->column));
    }
    if (given.empty() || formats::have_labels(given)) return !given.empty();
  }
  return false;
}

/// The same for a cloud larger than memory: its points near edges.
void read_labelled_in_tiles(const LinesArguments& arguments, const TilesNeeded& needed,
                            StageClock& clock, LabelledCloud& labelled) {
  TiledRequest request{.input = arguments.input,
                       .output = arguments.outputs.front(),
                       .model = arguments.model,
                       .preparation = arguments.preparation,
                       .viewpoint = place_in(arguments.viewpoint),
                       .memory = needed.memory};
  if (!arguments.classify && has_labels(arguments, clock.progress())) {
    request.given = [&](const PointCloud& part) { return labels_of_part(arguments, part); };
    request.look_first = [&](const TiledCloud& cloud) {
      check_near_edges(cloud, memory_limit(arguments.memory), clock.progress());
    };
  }
  const bool are_given = request.given != nullptr;
  say(needed.reason +
      (are_given ? ": read in tiles; its labels are kept" : ": classified in tiles"));
  const TiledCloud cloud(std::move(request), load_model(arguments.model), clock.progress());
  PointsNearEdges near = read_near_edges(cloud, memory_limit(arguments.memory), clock.progress());
  say(fmt::format("  lines are found from the {} of {} points that are near edges",
                  near.cloud.size(), cloud.plan().points()));
  labelled.cloud = std::move(near.cloud);
  labelled.prepared.positions = labelled.cloud.positions;
  labelled.prepared.normals = labelled.cloud.normals;
  labelled.found = std::move(near.found);
  labelled.partial = std::move(near.partial);
  const std::vector<std::uint8_t>& classes = labelled.found.classes;
  if (are_given) tell_labels(arguments.input, classes);
  if (arguments.lines.boundaries && std::ranges::count(classes, kBoundary) == 0) {
    warn(
        fmt::format("{}: no point is of class boundary (3); in tiles, boundaries are found only "
                    "around such points",
                    arguments.input));
  }
}

std::vector<Curve> find_curves(const LinesArguments& arguments, const LabelledCloud& labelled,
                               const Progress& progress, lines::LineScale& scale) {
  std::vector<Curve> curves;
  std::vector<Vec3> scanners;
  if (arguments.lines.boundaries) {
    scanners = labelled.prepared.is_averaged() ? labelled.prepared.scanners
                                               : scanner_of_points(labelled.cloud);
  }
  with_name_in_errors(arguments.input, [&] {
    curves = lines::find_lines({.positions = labelled.prepared.positions,
                                .normals = labelled.prepared.normals,
                                .classes = labelled.found.classes,
                                .p_sharp = labelled.found.p_sharp,
                                .p_smooth = labelled.found.p_smooth,
                                .partial = labelled.partial,
                                .scanners = scanners,
                                .curve = labelled.prepared.curve},
                               arguments.lines, &progress, &scale);
  });
  return curves;
}

/// Leaves in the cloud what a preview needs: through thick noise no curve could be seen.
void show_described(LabelledCloud& labelled) {
  PointCloud& cloud = labelled.cloud;
  if (labelled.prepared.is_averaged()) {
    cloud = {};
    cloud.positions.assign(labelled.prepared.positions.begin(), labelled.prepared.positions.end());
  }
  if (cloud.has_normals()) return;
  const auto& normals = labelled.prepared.normals;
  cloud.normals.assign(normals.begin(), normals.end());
}

/// Lengths in degrees mean nothing; coordinates beyond a turn are none.
void warn_of_degrees(const LinesArguments& arguments, const PointCloud& cloud) {
  double most = 0.0;
  for (const Vec3& p : cloud.positions) {
    if (p.allFinite()) most = std::max({most, std::abs(p.x()), std::abs(p.y())});
  }
  warn(most > 360.0
           ? fmt::format("{}: coordinates up to {:g} are no degrees, which --crs EPSG:{} has",
                         arguments.input, most, arguments.crs->epsg)
           : fmt::format(
                 "{}: by --crs EPSG:{} its coordinates are in degrees: lengths across and up "
                 "differ; project the cloud first",
                 arguments.input, arguments.crs->epsg));
}

/// That of --crs, otherwise of the file.
io::CoordinateSystem coordinate_system(const LinesArguments& arguments, const PointCloud& cloud) {
  io::CoordinateSystem own = io::las_coordinate_system(cloud);
  if (!arguments.crs) return own;
  const bool is_named = !own.wkt.empty() && !io::is_of_heights_alone(own);
  const bool has_other =
      own.epsg > 0 ? own.epsg != arguments.crs->epsg : is_named || own.geographic;
  if (has_other) {
    warn(fmt::format("{}: names another coordinate system{}: that of --crs is used",
                     arguments.input, own.epsg > 0 ? fmt::format(", EPSG:{}", own.epsg) : ""));
  }
  if (arguments.crs->geographic && !own.geographic) warn_of_degrees(arguments, cloud);
  return *arguments.crs;
}

void run(LinesArguments arguments, const Common& common) {
  arguments.codes = label_codes(arguments.las_classification);
  arguments.drawing.overwrite = common.overwrite();
  check_one_cloud("lines", arguments.input);
  check_outputs(arguments);
  find_model(arguments.model.name);  // throws before the work
  StageClock clock(console_progress(common));
  LabelledCloud labelled;
  const auto needed = tiles_needed(arguments.input, {}, memory_limit(arguments.memory));
  if (needed) {
    read_labelled_in_tiles(arguments, *needed, clock, labelled);
  } else {
    read_labelled(arguments, clock, labelled);
  }
  const PointCloud& cloud = labelled.cloud;
  clock.begin("lines");
  lines::LineScale scale;
  std::vector<Curve> curves = find_curves(arguments, labelled, clock.progress(), scale);
  if (labelled.given) {  // otherwise the classification has warned
    warn_of_rounding(arguments.input, cloud.position_type, labelled.prepared, {},
                     [&] { return scale.spacing; });
  }
  warn_of_tolerance(arguments, scale);
  const std::string left_out = filter_lines(arguments, scale, curves);
  clock.begin("write");
  arguments.drawing.tolerance = arguments.lines.tolerance;
  arguments.drawing.fit_tolerance = scale.tolerance;
  arguments.drawing.coordinate_system = coordinate_system(arguments, cloud);
  for (const std::string& output : arguments.outputs) {
    warn_of_losses(output, io::drawing_losses(output, arguments.drawing));
    io::write_drawing(output, curves, arguments.drawing);
  }
  if (!arguments.preview.path.empty()) {
    clock.begin("preview");
    show_described(labelled);
    render::write_preview(
        arguments.preview.path, cloud, {},
        {.view_direction = arguments.preview.direction, .overwrite = common.overwrite()}, curves);
  }
  report_lines(arguments, scale, curves, left_out, labelled.found.classes);
  say("  seconds: " + clock.seconds());
  report_outputs(arguments, curves);
  if (!arguments.preview.path.empty()) say("  -> " + arguments.preview.path);
}

}  // namespace

void add_lines(CLI::App& app, Common& common) {
  CLI::App* command = add_command(
      app, common, "lines", "Draw the edges as curves: segments, arcs, circles and polylines",
      "pcednet lines scan_edges.ply -o edges.dxf       of a cloud that was classified\n"
      "pcednet lines scan.ply -o edges.dxf --model cad     classifies it first\n"
      "pcednet lines scan_edges.ply -o edges.dxf --preview edges.png\n"
      "pcednet lines roof.las -o roof.gpkg -o roof.svg --boundaries --min-length 0.5\n"
      "pcednet lines part.ply -o part.obj --class sharp --kind segment,arc --regularise");
  auto arguments = std::make_shared<LinesArguments>();
  command->add_option("input", arguments->input, "Point file")->required();
  command
      ->add_option(
          "-o,--output", arguments->outputs,
          "Output file: " + io::drawing_extensions(" or ") + "; may be given several times")
      ->required()
      ->allow_extra_args(false);
  add_preview_options(*command, arguments->preview,
                      "Draw the curves over the shaded cloud to this PNG file");
  add_line_options(*command, arguments->lines);
  add_drawing_options(*command, *arguments);
  command->add_flag("--classify", arguments->classify,
                    "Classify first even if the points have labels");
  add_label_codes_option(*command, arguments->las_classification);
  add_model_options(*command, arguments->model);
  add_memory_option(*command, arguments->memory);
  add_prepare_options(*command, arguments->preparation);
  add_viewpoint_option(*command, arguments->viewpoint);
  CLI::Option* codes = command->get_option("--las-classification");
  codes->excludes("--classify");
  for (const char* of_a_model :
       {"--model", "--no-context", "--no-boundary", "--exact", "--s-min", "--s-max"}) {
    codes->excludes(of_a_model);
    command->get_option(of_a_model)->each([arguments](const std::string&) {
      arguments->classify = true;
    });
  }
  command->callback([arguments, &common] { run(*arguments, common); });
}

}  // namespace pcednet::app
