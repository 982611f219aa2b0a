#include "methods.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <sstream>
#include <thread>
#include <vector>

#include "number_options.h"
#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/decide.h"
#include "program_folder.h"
#include "workbench/classic/edge_measure.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// An unnamed file, removed on closing.
File temporary_file() {
  File file(std::tmpfile(), std::fclose);
  if (!file) throw Error(ErrorKind::kFailure, "method fee: no temporary file can be made");
  return file;
}

/// Runs the program with files for its input and output; stops it if `progress` is cancelled.
void run(const std::vector<std::string>& words, std::FILE* input, std::FILE* output,
         const Progress* progress) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, fileno(input), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, fileno(output), STDOUT_FILENO);
  pid_t child = 0;
  const int fault =
      posix_spawn(&child, words[0].c_str(), &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (fault != 0) throw Error(ErrorKind::kFailure, fmt::format("{}: cannot be started", words[0]));
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (progress && progress->cancelled && progress->cancelled()) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      throw Error(ErrorKind::kCancelled, "stopped by the user");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw Error(ErrorKind::kFailure, fmt::format("{} failed", words[0]));
  }
}

double positive(double radius, const char* name) {
  if (radius > 0.0 && std::isfinite(radius)) return radius;
  throw Error(ErrorKind::kUsage, fmt::format("method fee: {} of {} is not above 0", name, radius));
}

void check_options(const MethodArguments& arguments) {
  const auto refuse = [&](bool given, const char* option, std::string_view method) {
    if (!given || arguments.name == method) return;
    throw Error(ErrorKind::kUsage, fmt::format("{} is for --method {}", option, method));
  };
  refuse(arguments.neighbours != 0, "--neighbours", "ca");
  refuse(arguments.offset_radius != 0.0, "--offset-radius", "fee");
  refuse(arguments.convolution_radius != 0.0, "--convolution-radius", "fee");
}

classic::EdgeMeasure measure(const PointCloud& cloud, const MethodArguments& arguments,
                             const Progress* progress) {
  check_options(arguments);
  const auto set_threshold = [&](auto& options) {
    if (arguments.threshold >= 0.0) options.threshold = arguments.threshold;
  };
  if (arguments.name == "fee") {
    FeeOptions options;
    set_threshold(options);
    if (arguments.offset_radius != 0.0) options.offset_radius = arguments.offset_radius;
    if (arguments.convolution_radius != 0.0) {
      options.convolution_radius = arguments.convolution_radius;
    }
    return feature_edge_estimation(cloud, options, progress);
  }
  if (arguments.name == "ca") {
    classic::CovarianceAnalysisOptions options;
    if (arguments.neighbours != 0) options.neighbours = arguments.neighbours;
    set_threshold(options);
    return classic::covariance_analysis(cloud.positions, options, progress);
  }
  classic::MultiScaleOptions options;
  set_threshold(options);
  return classic::multi_scale_variation(cloud.positions, options, progress);
}

}  // namespace

fs::path find_fee() {
  std::vector<fs::path> folders = {program_folder()};
  const char* path = std::getenv("PATH");
  std::istringstream list(path ? path : "");
  for (std::string folder; std::getline(list, folder, ':');) folders.emplace_back(folder);
  for (const fs::path& folder : folders) {
    const fs::path program = folder / "pcednet-fee";
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  return {};
}

classic::EdgeMeasure feature_edge_estimation(const PointCloud& cloud, const FeeOptions& options,
                                             const Progress* progress) {
  const fs::path program = find_fee();
  if (program.empty()) {
    throw Error(ErrorKind::kInsufficient,
                "method fee: the program pcednet-fee was not built (it needs CGAL, Debian's "
                "libcgal-dev)");
  }
  const BoundingBox box = bounding_box(cloud.positions);
  if (!(box.diagonal() > 0.0)) {
    throw Error(ErrorKind::kInsufficient,
                "method fee: finite points at two places or more are needed");
  }
  const double offset =
      positive(options.offset_radius.value_or(0.05 * box.diagonal()), "the offset radius");
  const double convolution =
      positive(options.convolution_radius.value_or(offset / 2), "the convolution radius");
  const File input = temporary_file(), output = temporary_file();
  std::vector<std::size_t> sent;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.positions[i].allFinite()) continue;
    const Vec3 local = cloud.positions[i] - box.min;
    std::fwrite(local.data(), sizeof(double), 3, input.get());
    sent.push_back(i);
  }
  if (std::fflush(input.get()) != 0 || std::ferror(input.get())) {
    throw Error(ErrorKind::kFailure, "method fee: the disk is full");
  }
  std::rewind(input.get());
  run({program.string(), fmt::format("{}", offset), fmt::format("{}", convolution)}, input.get(),
      output.get(), progress);
  std::rewind(output.get());
  std::vector<double> ratios(sent.size());
  if (std::fread(ratios.data(), sizeof(double), ratios.size(), output.get()) != ratios.size()) {
    throw Error(ErrorKind::kFailure, fmt::format("{}: gave too few values", program.string()));
  }
  classic::EdgeMeasure measure;
  measure.threshold = options.threshold;
  measure.values.assign(cloud.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < sent.size(); ++i) measure.values[sent[i]] = ratios[i];
  return measure;
}

void add_method_options(CLI::App& command, MethodArguments& arguments) {
  CLI::Option* method =
      command
          .add_option(
              "--method", arguments.name,
              "Use a method without a model: ca (covariance analysis), multi-scale (surface "
              "variation over several neighbourhoods), fee (feature edge estimation, if built)")
          ->check(CLI::IsMember({"ca", "multi-scale", "fee"}));
  command
      .add_option("--neighbours", arguments.neighbours, "Neighbours for --method ca (default: 10)")
      ->transform(whole_number(4, 1'000'000))
      ->needs(method);
  command
      .add_option("--threshold", arguments.threshold,
                  "Threshold for --method (default: ca 0.65, in units of twice the standard "
                  "deviation; multi-scale 0.06; fee 0.16)")
      ->check(number_from_0())
      ->needs(method);
  command
      .add_option("--offset-radius", arguments.offset_radius,
                  "Offset radius for --method fee, in the unit of the cloud (default: 0.05 of the "
                  "diagonal)")
      ->check(length_above_0())
      ->needs(method);
  command
      .add_option("--convolution-radius", arguments.convolution_radius,
                  "Convolution radius for --method fee, in the unit of the cloud (default: half "
                  "the offset radius)")
      ->check(length_above_0())
      ->needs(method);
}

detect::Classification classify_by_method(const PointCloud& cloud, const MethodArguments& arguments,
                                          const Progress* progress) {
  const classic::EdgeMeasure edges = measure(cloud, arguments, progress);
  detect::Classification result = detect::nothing_found(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double value = edges.values[i];
    if (std::isnan(value)) continue;
    result.classes[i] = value > edges.threshold ? kSharpEdge : kNonEdge;
    const double sum = value + edges.threshold;
    result.p_sharp[i] = sum > 0.0 ? static_cast<float>(value / sum) : 0.0f;
  }
  result.counts = detect::count_classes(result.classes);
  return result;
}

}  // namespace pcednet::app
