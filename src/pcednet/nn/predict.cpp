#include "pcednet/nn/predict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/prefetch.h"
#include "pcednet/nn/evaluator.h"

namespace pcednet::nn {
namespace {

// A table of this many points stays in the first-level cache.
constexpr std::size_t kPoints = kLaneStep;
constexpr std::size_t kTask = 128 * kPoints;

}  // namespace

std::vector<float> predict(const Model& model, std::span<const float> samples,
                           const Progress* progress) {
  const auto inputs = static_cast<std::size_t>(model.network.architecture.inputs());
  const auto classes = static_cast<std::size_t>(model.network.architecture.classes);
  std::vector<float> probabilities(inputs ? samples.size() / inputs * classes : 0);
  predict_into(model, samples, probabilities, progress);
  return probabilities;
}

void predict_into(const Model& model, std::span<const float> samples,
                  std::span<float> probabilities, const Progress* progress,
                  InstructionSet instructions) {
  const Evaluator evaluator(model, instructions);
  const auto inputs = static_cast<std::size_t>(evaluator.inputs());
  const auto classes = static_cast<std::size_t>(evaluator.classes());
  const std::size_t count = samples.size() / inputs;
  if (samples.size() % inputs != 0 || probabilities.size() != count * classes) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{} numbers in and {} out for a network of {} inputs and {} classes",
                            samples.size(), probabilities.size(), inputs, classes));
  }
  Stage stage(progress, "classify", count);
  parallel_blocks(count, kTask, [&](std::size_t task_begin, std::size_t task_end) {
    LaneTable table = evaluator.make_table(kPoints);
    std::array<const float*, kPoints> rows;
    for (std::size_t begin = task_begin; begin < task_end; begin += kPoints) {
      const std::size_t points = std::min(kPoints, task_end - begin);
      for (std::size_t p = 0; p < kPoints; ++p) {
        rows[p] = samples.data() + (begin + std::min(p, points - 1)) * inputs;
      }
      const std::size_t next = std::min(begin + kPoints, task_end);
      prefetch_all(samples.subspan(next * inputs, std::min(kPoints, task_end - next) * inputs));
      evaluator.run(rows.data(), table);
      float* out = table.row(evaluator.logits_row());
      evaluator.kernels().softmax(out, evaluator.classes(), table.lanes(), evaluator.paired());
      for (std::size_t c = 0; c < classes; ++c) {
        const float* row = table.row(evaluator.logits_row() + static_cast<int>(c));
        for (std::size_t p = 0; p < points; ++p) probabilities[(begin + p) * classes + c] = row[p];
      }
    }
    stage.advance(task_end - task_begin);
  });
}

}  // namespace pcednet::nn
