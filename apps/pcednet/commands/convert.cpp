#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

#include "batch.h"
#include "commands.h"
#include "memory_size.h"
#include "number_options.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/parts.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/parts.h"
#include "pcednet/io/ply/faces.h"
#include "point_filter.h"
#include "workbench/shapes/perturb.h"
#include "workbench/shapes/solids/mesh_samples.h"

namespace pcednet::app {
namespace {

struct ConvertRequest {
  std::string input;
  std::string output;
  bool ascii = false;
  double noise = 0.0, spacing = 0.0, fraction = 1.0;
  bool along_normal = false;
  std::uint64_t seed = 1;
  std::size_t samples = 0;
  bool vertex_normals = false;
  PointFilter filter = {};
};

/// Whether points are moved, made, or chosen with regard to others.
bool perturbs(const ConvertRequest& request) {
  return request.samples > 0 || request.noise > 0.0 || request.spacing > 0.0 ||
         request.fraction < 1.0;
}

/// Whether the points of the output are not those of the input.
bool changes_points(const ConvertRequest& request) {
  return perturbs(request) || request.filter.is_on();
}

/// The most points to sample: as many as an index of 32 bits can number.
constexpr std::uint64_t kMostSamples = 0xffffffff;

/// Throws before the work if the points would not fit into the free memory.
void check_sample_fits(const ConvertRequest& request) {
  constexpr std::uint64_t kBytesPerPoint = 2 * sizeof(Vec3) + sizeof(Rgb);
  const std::uint64_t most = free_memory() / kBytesPerPoint;
  if (request.samples <= most) return;
  throw Error(ErrorKind::kUsage, fmt::format("--sample {}: the free memory holds {} points at most",
                                             request.samples, most));
}

void sample(const ConvertRequest& request, const Progress& progress, PointCloud& cloud) {
  const auto triangles = io::triangles_of(cloud);
  if (triangles.empty()) {
    throw Error(ErrorKind::kInsufficient,
                "has no faces to sample; .obj, .off, .ply and .stl files can have faces");
  }
  cloud = shapes::sample_mesh(cloud, triangles,
                              {request.samples, request.vertex_normals, request.seed}, &progress);
}

void perturb(const ConvertRequest& request, const Progress& progress, PointCloud& cloud) {
  // Estimates are of the points before.
  if (perturbs(request)) detect::set_estimated_normals(cloud, false);
  if (request.noise > 0.0) {
    with_name_in_errors(request.input, [&] {
      cloud = shapes::add_gaussian_noise(std::move(cloud),
                                         {request.noise, request.along_normal, request.seed});
    });
  }
  if (request.spacing > 0.0) {
    with_name_in_errors(request.input, [&] {
      cloud = shapes::thin(cloud, {request.spacing, request.seed}, &progress);
    });
  }
  if (request.fraction < 1.0) cloud = shapes::subsample(cloud, {request.fraction, request.seed});
}

/// The parts of a file in order, beginning with one that has been read.
io::EachPart each_part_of(const FilteredParts& parts, const PointCloud& first,
                          const Progress& progress) {
  return [&](const auto& visit) {
    bool more = visit(first);
    for (std::size_t p = 1; p < parts.parts() && more; ++p) {
      throw_if_cancelled(&progress);
      PointCloud part = parts.read(p);
      io::PartTally known;
      io::finish_part(part, known);
      more = visit(part);
    }
  };
}

void say_points(const ConvertRequest& request, std::size_t written, std::size_t read) {
  say(fmt::format("{}: {} points{}", request.output, written,
                  request.filter.is_on() ? fmt::format(" of {}", read) : ""));
}

/// In parts a text is read twice: only where memory may not hold it.
std::unique_ptr<io::PartReader> open_parts(const std::string& input) {
  constexpr std::uint64_t kMostPerByte = 30;  // of memory
  const io::InputFile file(input);
  const bool is_text = formats::format_of(file).is_text();
  if (is_text && file.size() < free_memory() / kMostPerByte) return nullptr;
  const EndsAtOnce reading;
  return formats::open_parts(input);
}

/// Converts in memory that does not grow with the file; false if one of the formats, or another
/// option, needs the whole cloud.
bool convert_in_parts(const ConvertRequest& request, const Common& common) {
  if (perturbs(request) || !formats::format_for(request.output).create_parts) return false;
  const auto reader = open_parts(request.input);
  if (!reader) return false;
  const Progress progress = console_progress(common);
  std::optional<FilteredParts> parts;
  with_name_in_errors(request.input, [&] { parts.emplace(*reader, request.filter, progress); });
  io::PartTally tally;
  PointCloud first = parts->read(0);
  io::finish_part(first, tally);
  const io::PartOutline outline{.points = parts->points(),
                                .first = &first,
                                .each_part = each_part_of(*parts, first, progress),
                                .is_las = reader->is_las()};
  const auto writer = formats::create_parts(
      request.output, outline,
      {.overwrite = common.overwrite(), .ascii = request.ascii, .progress = &progress});
  Stage stage(&progress, "convert", parts->points());
  writer->append(first);
  stage.advance(first.size());
  for (std::size_t p = 1; p < parts->parts(); ++p) {
    PointCloud part = parts->read(p);
    io::finish_part(part, tally);
    writer->append(part);
    stage.advance(part.size());
  }
  writer->commit();
  warn_all(request.input, reader->warnings);
  warn_all(request.input, io::warnings_of(tally));
  warn_of_losses(request.output, writer->losses);
  say_points(request, tally.points, reader->points());
  return true;
}

void convert(const ConvertRequest& request, const Common& common) {
  // Fails before a long read if the output cannot be written.
  formats::format_for(request.output);
  check_one_cloud("convert", request.input);
  check_ascii(request.ascii, {request.output});
  if (changes_points(request)) check_not_input(request.output, request.input);
  check_sample_fits(request);
  check_writable(request.output, common.overwrite());
  if (convert_in_parts(request, common)) return;
  const Progress progress = console_progress(common);
  io::LoadedCloud loaded = read_whole(request.input);
  throw_if_cancelled(&progress);
  warn_all(request.input, loaded.warnings);
  if (request.samples > 0) {
    with_name_in_errors(request.input, [&] { sample(request, progress, loaded.cloud); });
  }
  const std::size_t points = loaded.cloud.size();
  with_name_in_errors(request.input, [&] {
    loaded.cloud = filtered(std::move(loaded.cloud), request.filter);
    check_some_kept(loaded.cloud.size(), request.filter);
  });
  perturb(request, progress, loaded.cloud);
  throw_if_cancelled(&progress);
  warn_of_losses(request.output, formats::losses(request.output, loaded.cloud));
  formats::write_cloud(
      request.output, loaded.cloud,
      {.overwrite = common.overwrite(), .ascii = request.ascii, .progress = &progress});
  say_points(request, loaded.cloud.size(), points);
}

}  // namespace

void add_convert(CLI::App& app, Common& common) {
  CLI::App* command =
      add_command(app, common, "convert", "Convert a point file to another format",
                  "pcednet convert scan.xyz -o scan.ply\n"
                  "pcednet convert scan.ply -o scan.pcd\n"
                  "pcednet convert scan.laz -o scan.copc.laz\n"
                  "pcednet convert scan.ply -o readable.ply --ascii\n"
                  "pcednet convert scan.ptx -o even.ply --spacing 0.005\n"
                  "pcednet convert city.laz -o clean.laz --drop-class 7,18 --drop-flag withheld\n"
                  "pcednet convert city.laz -o roofs.laz --keep-class 6\n"
                  "pcednet convert part.stl -o part.ply --sample 100000\n"
                  "pcednet convert scan.ply -o worse.ply --noise 0.004 --seed 7");
  auto request = std::make_shared<ConvertRequest>();
  command->add_option("input", request->input, "Input file")->required();
  command
      ->add_option("-o,--output", request->output,
                   "Output file: " + formats::extensions_written(" or "))
      ->required();
  command->add_flag("--ascii", request->ascii, "Write .ply and .pcd as text");
  add_filter_options(*command, request->filter);
  CLI::Option* noise = command
                           ->add_option("--noise", request->noise,
                                        "Add Gaussian noise with this standard deviation, as a "
                                        "fraction of the bounding box diagonal")
                           ->check(number("a number from 0 to 1000",
                                          [](double v) { return v >= 0.0 && v <= 1000.0; }));
  command
      ->add_flag("--noise-along-normal", request->along_normal,
                 "Add the noise along the normals only")
      ->needs(noise);
  CLI::Option* spacing =
      command
          ->add_option("--spacing", request->spacing,
                       "Thin to points that are at least this far apart, in the unit of the file")
          ->check(number_above_0());
  CLI::Option* subsample = command
                               ->add_option("--subsample", request->fraction,
                                            "Keep this share of the points, chosen at random")
                               ->check(share());
  CLI::Option* samples =
      command
          ->add_option(
              "--sample", request->samples,
              "Sample this many points on the faces of a mesh instead of reading its vertices")
          ->transform(whole_number(1, kMostSamples));
  command
      ->add_flag("--vertex-normals", request->vertex_normals,
                 "Interpolate the normals of the vertices instead of using those of the faces")
      ->needs(samples);
  CLI::Option* seed =
      command->add_option("--seed", request->seed, "Seed of the noise and of the choice of points")
          ->capture_default_str();
  command->callback([=, &common] {
    if (*seed && !*noise && !*spacing && !*subsample && !*samples) {
      throw Error(ErrorKind::kUsage, "--seed requires --noise, --spacing, --subsample or --sample");
    }
    convert(*request, common);
  });
}

}  // namespace pcednet::app
