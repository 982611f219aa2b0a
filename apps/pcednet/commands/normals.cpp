#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "batch.h"
#include "classify_cloud.h"
#include "commands.h"
#include "number_options.h"
#include "pcednet/core/counted.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/normals/neighbour_count.h"
#include "pcednet/normals/prepare.h"
#include "view_options.h"

namespace pcednet::app {
namespace {

struct NormalsRequest {
  std::string input;
  std::string output;
  int neighbours = 0;
  std::vector<double> viewpoint;
  bool keep = false;
  bool flip = false;
};

/// New normals, or those of the cloud with new signs.
normals::PreparedNormals make_normals(const NormalsRequest& request, const PointCloud& cloud,
                                      const Progress& progress) {
  if (request.keep && !cloud.has_normals()) {
    throw Error(
        ErrorKind::kInsufficient,
        fmt::format("{}: has no normals to keep; estimate them without --keep", request.input));
  }
  normals::PreparedNormals prepared;
  with_name_in_errors(request.input, [&] {
    const normals::OrientedNormalsOptions options = {normals::given_neighbours(request.neighbours),
                                                     place_in(request.viewpoint)};
    prepared = request.keep
                   ? normals::complete_and_orient_normals(cloud.positions, cloud.normals, options,
                                                          &progress)
                   : normals::estimate_oriented_normals(cloud.positions, options, &progress);
    if (prepared.unusable == cloud.size()) {
      throw Error(ErrorKind::kInsufficient,
                  "no point has a normal: all are on a line, or not finite");
    }
  });
  return prepared;
}

void report(const NormalsRequest& request, const normals::PreparedNormals& prepared) {
  const normals::Orientation& orientation = prepared.orientation;
  std::string line =
      fmt::format("{}: {} normals", request.output, prepared.normals.size() - prepared.unusable);
  if (prepared.estimated > 0) {
    line += fmt::format(", {} estimated from {} neighbours each", prepared.estimated,
                        normals::number_of(prepared.choice));
  }
  if (orientation.components > 0) {
    line += "; " + counted(orientation.components, "connected part");
    if (orientation.undecided > 0) {
      line += orientation.components == 1
                  ? ", open, turned upwards"
                  : fmt::format(", {} of them open, turned upwards", orientation.undecided);
    }
  }
  say(line);
  if (prepared.unusable > 0) {
    warn(fmt::format("{}: {} points without a normal: not finite, or on a line of points",
                     request.output, prepared.unusable));
  }
}

void run(const NormalsRequest& request, const Common& common) {
  // Fails before a long read if the output cannot be written.
  formats::format_for(request.output);
  check_one_cloud("normals", request.input);
  check_writable(request.output, common.overwrite());
  PointCloud cloud = read_cloud(request.input);
  if (cloud.empty()) {
    throw Error(ErrorKind::kInsufficient, request.input + ": has no points");
  }
  formats::check_positions(request.output, cloud);
  const Progress progress = console_progress(common);
  normals::PreparedNormals prepared = make_normals(request, cloud, progress);
  if (const auto scanners = scanner_of_points(cloud);
      !request.keep && request.viewpoint.empty() && !scanners.empty()) {
    const std::size_t faced = normals::face_scanners(cloud.positions, prepared.normals, scanners);
    say(fmt::format("{}: {} points turned towards their scanner", request.input, faced));
  }
  cloud.normals = prepared.normals;
  // With another number of neighbours, they are the user's choice.
  if (!request.keep) detect::set_estimated_normals(cloud, request.neighbours == 0);
  if (request.flip) {
    for (Vec3& normal : cloud.normals) normal = Vec3::Zero() - normal;
  }
  warn_of_losses(request.output, formats::losses(request.output, cloud));
  formats::write_cloud(request.output, cloud,
                       {.overwrite = common.overwrite(), .progress = &progress});
  report(request, prepared);
}

}  // namespace

void add_normals(CLI::App& app, Common& common) {
  CLI::App* command =
      add_command(app, common, "normals", "Estimate normals and orient them consistently",
                  "pcednet normals scan.ply -o with_normals.ply\n"
                  "pcednet normals scan.ply -o with_normals.ply --viewpoint 0 0 1.7\n"
                  "pcednet normals inward.ply -o outward.ply --keep");
  auto request = std::make_shared<NormalsRequest>();
  command->add_option("input", request->input, "Input file")->required();
  command->add_option("-o,--output", request->output, "Output file")->required();
  command
      ->add_option("--neighbours", request->neighbours,
                   "Neighbours of each point (0: 12, more on noisy clouds)")
      ->capture_default_str()
      ->transform(whole_number(0, 1000));
  command->add_flag(
      "--keep", request->keep,
      "Keep the normals of the file except for their signs; estimate only missing ones");
  command->add_flag("--flip", request->flip, "Flip all normals at the end, to point inwards");
  add_viewpoint_option(*command, request->viewpoint,
                       "Turn every normal to face this position (X Y Z) instead of outwards");
  command->callback([request, &common] { run(*request, common); });
}

}  // namespace pcednet::app
