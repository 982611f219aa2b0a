#include "methods.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "pcednet/classic/edge_measure.h"
#include "pcednet/core/error.h"
#include "pcednet/core/stopwatch.h"

namespace pcednet::app {
namespace {

classic::EdgeMeasure measure(const PointCloud& cloud, const MethodArguments& arguments,
                             const Progress* progress) {
  if (arguments.name == "fee") {
    throw Error(ErrorKind::kInsufficient,
                "method fee needs CGAL and is not in this build; its output from elsewhere can be "
                "scored with --predictions");
  }
  if (arguments.name == "ca") {
    classic::CovarianceAnalysisOptions options;
    if (arguments.neighbours > 0) options.neighbours = arguments.neighbours;
    if (arguments.threshold >= 0.0) options.threshold = arguments.threshold;
    return classic::covariance_analysis(cloud.positions, options, progress);
  }
  classic::MultiScaleOptions options;
  if (arguments.neighbours > 0) {
    throw Error(ErrorKind::kUsage, "--neighbours is for --method ca; multi-scale has several");
  }
  if (arguments.threshold >= 0.0) options.threshold = arguments.threshold;
  return classic::multi_scale_variation(cloud.positions, options, progress);
}

}  // namespace

void add_method_options(CLI::App& command, MethodArguments& arguments) {
  command
      .add_option("--method", arguments.name,
                  "Without a model: ca (covariance analysis), multi-scale (surface variation over "
                  "several neighbourhoods), fee (where it is built)")
      ->check(CLI::IsMember({"ca", "multi-scale", "fee"}));
  command.add_option("--neighbours", arguments.neighbours, "Of --method ca (default 10)");
  command.add_option("--threshold", arguments.threshold,
                     "Of --method: ca 0.65, in twice the standard deviation; multi-scale 0.06");
}

detect::Classification classify_by_method(const PointCloud& cloud, const MethodArguments& arguments,
                                          const Progress* progress) {
  Stopwatch watch;
  const classic::EdgeMeasure edges = measure(cloud, arguments, progress);
  detect::Classification result;
  const std::size_t points = cloud.size();
  result.classes.assign(points, kUnlabelled);
  result.p_sharp.assign(points, 0.0f);
  result.p_smooth.assign(points, 0.0f);
  for (std::size_t i = 0; i < points; ++i) {
    const double value = edges.values[i];
    if (std::isnan(value)) {
      ++result.counts.unlabelled;
      continue;
    }
    const bool sharp = value > edges.threshold;
    result.classes[i] = sharp ? kSharpEdge : kNonEdge;
    ++(sharp ? result.counts.sharp : result.counts.non_edge);
    const double sum = value + edges.threshold;
    result.p_sharp[i] = sum > 0.0 ? static_cast<float>(value / sum) : 0.0f;
  }
  result.seconds_describe = watch.lap();
  return result;
}

}  // namespace pcednet::app
