#include "methods.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "fee.h"
#include "number_options.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/decide.h"
#include "workbench/classic/edge_measure.h"

namespace pcednet::app {
namespace {

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
