#include "pcednet/nn/validate.h"

#include <algorithm>
#include <array>
#include <vector>

#include "pcednet/core/parallel.h"
#include "pcednet/nn/targets.h"

namespace pcednet::nn {
namespace {

constexpr std::size_t kLanes = kLaneStep;
constexpr std::size_t kSamplesAtOnce = 64 * kLanes;

struct ClassSums {
  double loss = 0.0;
  std::size_t right = 0, count = 0;
};

std::uint8_t most_probable(LaneTable& table, int first_row, int classes, std::size_t lane) {
  int best = 0;
  for (int c = 1; c < classes; ++c) {
    if (table.row(first_row + c)[lane] > table.row(first_row + best)[lane]) best = c;
  }
  return static_cast<std::uint8_t>(best);
}

/// Adds up the samples of one task, class by class.
void judge(const Evaluator& evaluator, const TrainingSet& set,
           std::span<const std::uint32_t> chosen, ClassSums* sums, std::size_t* confusion) {
  LaneTable table = evaluator.make_table(kLanes);
  const int classes = evaluator.classes();
  const int logits = evaluator.logits_row();
  LaneTable deltas(classes, table.lanes());
  std::array<const float*, kLanes> rows;
  std::array<std::uint8_t, kLanes> labels;
  LaneTable targets(classes, kLanes);
  std::array<float, kLanes> weights, losses;
  weights.fill(1.0f);
  for (std::size_t begin = 0; begin < chosen.size(); begin += kLanes) {
    const std::size_t points = std::min(kLanes, chosen.size() - begin);
    for (std::size_t p = 0; p < kLanes; ++p) {
      const std::size_t sample = chosen[begin + std::min(p, points - 1)];
      rows[p] = set.samples.data() + sample * static_cast<std::size_t>(evaluator.inputs());
      labels[p] = set.labels[sample];
    }
    // Validation is against the labels, whatever the training targets.
    fill_targets({set.samples, set.labels}, chosen.subspan(begin, points), classes, targets);
    evaluator.run(rows.data(), table);
    const Kernels& kernels = evaluator.kernels();
    kernels.cross_entropy(table.row(logits), targets.row(0), weights.data(), classes, table.lanes(),
                          evaluator.paired(), losses.data(), deltas.row(0));
    kernels.softmax(table.row(logits), classes, table.lanes(), evaluator.paired());
    for (std::size_t p = 0; p < points; ++p) {
      ClassSums& sum = sums[labels[p]];
      sum.loss += losses[p];
      const std::uint8_t found = most_probable(table, logits, classes, p);
      sum.right += found == labels[p];
      ++confusion[static_cast<std::size_t>(labels[p] * classes + found)];
      ++sum.count;
    }
  }
}

}  // namespace

Validation validate(const Model& model, const TrainingSet& set,
                    std::span<const std::uint32_t> chosen, std::span<const double> weights) {
  const Evaluator evaluator(model);
  const auto classes = static_cast<std::size_t>(evaluator.classes());
  const std::size_t tasks = (chosen.size() + kSamplesAtOnce - 1) / kSamplesAtOnce;
  std::vector<ClassSums> sums(tasks * classes);
  std::vector<std::size_t> confusion(tasks * classes * classes);
  parallel_blocks(chosen.size(), kSamplesAtOnce, [&](std::size_t begin, std::size_t end) {
    judge(evaluator, set, chosen.subspan(begin, end - begin),
          sums.data() + begin / kSamplesAtOnce * classes,
          confusion.data() + begin / kSamplesAtOnce * classes * classes);
  });
  Validation result;
  result.confusion.resize(classes * classes);
  for (std::size_t i = 0; i < confusion.size(); ++i) {
    result.confusion[i % result.confusion.size()] += confusion[i];
  }
  std::size_t seen = 0;
  double weight = 0.0;
  for (std::size_t c = 0; c < classes; ++c) {
    ClassSums total;
    for (std::size_t t = 0; t < tasks; ++t) {
      const ClassSums& sum = sums[t * classes + c];
      total.loss += sum.loss;
      total.right += sum.right;
      total.count += sum.count;
    }
    if (total.count == 0) continue;
    const auto count = static_cast<double>(total.count);
    result.loss += weights[c] * total.loss / count;
    weight += weights[c];
    result.accuracy += static_cast<double>(total.right) / count;
    ++seen;
  }
  if (seen > 0) {
    result.loss /= weight;
    result.accuracy /= static_cast<double>(seen);
  }
  return result;
}

}  // namespace pcednet::nn
