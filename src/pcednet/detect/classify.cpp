#include "pcednet/detect/classify.h"

#include <algorithm>

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

}  // namespace

Classification classify(const PreparedCloud& cloud, const EdgeModel& model,
                        const ClassifyOptions& options, const Progress* progress) {
  const std::size_t points = cloud.positions.size();
  Classification result;
  result.classes.assign(points, kUnlabelled);
  result.p_sharp.assign(points, 0.0f);
  result.p_smooth.assign(points, 0.0f);

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
  std::vector<float> probabilities(std::min(kBlock, order.size()) * model.classes.size());
  const Progress cancel_only = without_report(progress);
  Stage stage(progress, "describe", order.size());
  for (std::size_t first = 0; first < order.size(); first += kBlock) {
    const auto targets = order.subspan(first, std::min(kBlock, order.size() - first));
    const auto rows = std::span(samples).first(targets.size() * inputs);
    matrix.describe(targets, rows, std::span(status).first(targets.size() * scales), &cancel_only);
    result.seconds_describe += watch.lap();
    const auto answers = std::span(probabilities).first(targets.size() * model.classes.size());
    nn::predict_into(model.network, rows, answers);
    for (std::size_t i = 0; i < targets.size(); ++i) {
      decide(answers.subspan(i * model.classes.size(), model.classes.size()), model.classes,
             targets[i], result);
    }
    result.seconds_network += watch.lap();
    stage.advance(targets.size());
  }
  result.counts = count_classes(result.classes);
  return result;
}

}  // namespace pcednet::detect
