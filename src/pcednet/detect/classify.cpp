#include "pcednet/detect/classify.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "pcednet/core/stopwatch.h"
#include "pcednet/detect/context.h"
#include "pcednet/detect/decide.h"
#include "pcednet/gls/engine.h"

namespace pcednet::detect {
namespace {

/// Points described and classified at a time: enough to keep every thread busy, few enough for the
/// matrix to stay in the cache.
constexpr std::size_t kBlock = 16 * 1024;

Classification nothing_found(std::size_t points) {
  Classification result;
  result.classes.assign(points, kUnlabelled);
  result.p_sharp.assign(points, 0.0f);
  result.p_smooth.assign(points, 0.0f);
  return result;
}

/// Describes the points block by block and lets the model's network decide.
void describe_and_decide(const PreparedCloud& cloud, const EdgeModel& model,
                         const ClassifyOptions& options, const Progress* progress,
                         Classification& result) {
  Stopwatch watch;
  gls::ScaleSpaceOptions descriptor = model.descriptor;
  descriptor.engine = options.exact ? gls::Engine::kExact : gls::Engine::kFast;
  const gls::ScaleSpace matrix({cloud.positions, cloud.normals}, descriptor, progress);
  const std::span<const std::uint32_t> order = matrix.order();
  result.seconds_prepare = watch.lap();
  result.note = gls::note_on(descriptor, matrix.scales(), cloud.positions);

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
    decide(model.network, model.classes, rows, targets, probabilities, result);
    result.seconds_network += watch.lap();
    stage.advance(targets.size());
  }
}

/// What follows the first network's answers.
void finish(std::span<const Vec3> positions, const EdgeModel& model, const Progress* progress,
            Classification& result) {
  Stopwatch watch;
  if (model.context) apply_context(*model.context, model.classes, positions, result, progress);
  result.seconds_context = watch.lap();
  result.counts = count_classes(result.classes);
}

}  // namespace

Classification classify(const PreparedCloud& cloud, const EdgeModel& model,
                        const ClassifyOptions& options, const Progress* progress) {
  Classification result = nothing_found(cloud.positions.size());
  describe_and_decide(cloud, model, options, progress, result);
  finish(cloud.positions, model, progress, result);
  return result;
}

DescribedCloud describe(const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor,
                        const Progress* progress) {
  Stopwatch watch;
  const Progress cancel_only = without_report(progress);
  const gls::ScaleSpace matrix({cloud.positions, cloud.normals}, descriptor, &cancel_only);
  const std::span<const std::uint32_t> order = matrix.order();
  const auto scales = static_cast<std::size_t>(descriptor.scales);
  const auto width = scales * static_cast<std::size_t>(gls::column_count(descriptor));
  DescribedCloud described{.points = cloud.positions.size(), .order = {order.begin(), order.end()}};
  described.values.resize(order.size() * width);
  std::vector<gls::FitStatus> status(order.size() * scales);
  matrix.describe(order, described.values, status, progress);
  described.seconds = watch.lap();
  return described;
}

Classification classify(const DescribedCloud& cloud, std::span<const Vec3> positions,
                        const EdgeModel& model) {
  const auto inputs = static_cast<std::size_t>(model.network.network.architecture.inputs());
  if (cloud.values.size() != cloud.order.size() * inputs || positions.size() != cloud.points) {
    throw Error(ErrorKind::kModelMismatch,
                fmt::format("{} numbers describe {} of {} points; the model wants {} for each",
                            cloud.values.size(), cloud.points, positions.size(), inputs));
  }
  Classification result = nothing_found(cloud.points);
  result.seconds_describe = cloud.seconds;
  Stopwatch watch;
  std::vector<float> probabilities;
  for (std::size_t first = 0; first < cloud.order.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, cloud.order.size() - first);
    decide(model.network, model.classes,
           std::span(cloud.values).subspan(first * inputs, count * inputs),
           std::span(cloud.order).subspan(first, count), probabilities, result);
  }
  result.seconds_network = watch.lap();
  finish(positions, model, nullptr, result);
  return result;
}

}  // namespace pcednet::detect
