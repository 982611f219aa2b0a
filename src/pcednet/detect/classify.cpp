#include "pcednet/detect/classify.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "pcednet/core/stopwatch.h"
#include "pcednet/gls/engine.h"
#include "pcednet/nn/predict.h"

namespace pcednet::detect {
namespace {

/// Points described and classified at a time: enough to keep every thread busy, few enough for the
/// matrix to stay in the cache.
constexpr std::size_t kBlock = 16 * 1024;

/// Writes the network's answer for one point.
void decide(std::span<const float> probabilities, const std::vector<std::uint8_t>& classes,
            std::size_t point, Classification& result) {
  std::size_t best = 0;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    if (probabilities[c] > probabilities[best]) best = c;
    if (classes[c] == kSharpEdge) result.p_sharp[point] = probabilities[c];
    if (classes[c] == kSmoothEdge) result.p_smooth[point] = probabilities[c];
  }
  result.classes[point] = classes[best];
}

ClassCounts count_classes(const std::vector<std::uint8_t>& classes) {
  const auto count = [&](std::uint8_t wanted) {
    return static_cast<std::size_t>(std::count(classes.begin(), classes.end(), wanted));
  };
  return {count(kNonEdge), count(kSmoothEdge), count(kSharpEdge), count(kUnlabelled)};
}

Classification nothing_found(std::size_t points) {
  Classification result;
  result.classes.assign(points, kUnlabelled);
  result.p_sharp.assign(points, 0.0f);
  result.p_smooth.assign(points, 0.0f);
  return result;
}

/// Lets the network answer for `targets`, whose descriptions are `rows`.
void decide_all(std::span<const float> rows, std::span<const std::uint32_t> targets,
                const EdgeModel& model, std::vector<float>& probabilities, Classification& result) {
  const std::size_t classes = model.classes.size();
  probabilities.resize(targets.size() * classes);
  nn::predict_into(model.network, rows, probabilities);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    decide(std::span(probabilities).subspan(i * classes, classes), model.classes, targets[i],
           result);
  }
}

}  // namespace

Classification classify(const PreparedCloud& cloud, const EdgeModel& model,
                        const ClassifyOptions& options, const Progress* progress) {
  Classification result = nothing_found(cloud.positions.size());
  Stopwatch watch;
  gls::ScaleSpaceOptions descriptor = model.descriptor;
  descriptor.engine = options.exact ? gls::Engine::kExact : gls::Engine::kFast;
  const gls::ScaleSpace matrix({cloud.positions, cloud.normals}, descriptor, progress);
  const std::span<const std::uint32_t> order = matrix.order();
  result.seconds_prepare = watch.lap();

  const auto inputs = static_cast<std::size_t>(model.network.network.architecture.inputs());
  const auto scales = static_cast<std::size_t>(model.descriptor.scales);
  std::vector<float> samples(std::min(kBlock, order.size()) * inputs);
  std::vector<gls::FitStatus> status(std::min(kBlock, order.size()) * scales);
  std::vector<float> probabilities;
  const Progress cancel_only = without_report(progress);
  Stage stage(progress, "describe", order.size());
  for (std::size_t first = 0; first < order.size(); first += kBlock) {
    const auto targets = order.subspan(first, std::min(kBlock, order.size() - first));
    const auto rows = std::span(samples).first(targets.size() * inputs);
    matrix.describe(targets, rows, std::span(status).first(targets.size() * scales), &cancel_only);
    result.seconds_describe += watch.lap();
    decide_all(rows, targets, model, probabilities, result);
    result.seconds_network += watch.lap();
    stage.advance(targets.size());
  }
  result.counts = count_classes(result.classes);
  return result;
}

DescribedCloud describe(const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor,
                        const Progress* progress) {
  Stopwatch watch;
  const Progress cancel_only = without_report(progress);
  const gls::ScaleSpace matrix({cloud.positions, cloud.normals}, descriptor, &cancel_only);
  const std::span<const std::uint32_t> order = matrix.order();
  const auto scales = static_cast<std::size_t>(descriptor.scales);
  const auto width = scales * static_cast<std::size_t>(gls::feature_count(descriptor.features));
  DescribedCloud described{.points = cloud.positions.size(), .order = {order.begin(), order.end()}};
  described.values.resize(order.size() * width);
  std::vector<gls::FitStatus> status(order.size() * scales);
  matrix.describe(order, described.values, status, progress);
  described.seconds = watch.lap();
  return described;
}

Classification classify(const DescribedCloud& cloud, const EdgeModel& model) {
  const auto inputs = static_cast<std::size_t>(model.network.network.architecture.inputs());
  if (cloud.values.size() != cloud.order.size() * inputs) {
    throw Error(ErrorKind::kModelMismatch,
                fmt::format("{} numbers describe {} points; the model wants {} for each",
                            cloud.values.size(), cloud.order.size(), inputs));
  }
  Classification result = nothing_found(cloud.points);
  result.seconds_describe = cloud.seconds;
  Stopwatch watch;
  std::vector<float> probabilities;
  for (std::size_t first = 0; first < cloud.order.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, cloud.order.size() - first);
    decide_all(std::span(cloud.values).subspan(first * inputs, count * inputs),
               std::span(cloud.order).subspan(first, count), model, probabilities, result);
  }
  result.seconds_network = watch.lap();
  result.counts = count_classes(result.classes);
  return result;
}

}  // namespace pcednet::detect
