#include "pcednet/nn/distil.h"

#include <algorithm>
#include <cmath>

#include "pcednet/core/random.h"
#include "pcednet/nn/predict.h"

namespace pcednet::nn {
namespace {

constexpr std::uint64_t kTeacherStream = 4;  // of the caller's seed
constexpr double kLeast = 1e-9;              // probability that has a logarithm

void add_logarithms(const std::vector<float>& probabilities, std::vector<double>& sums) {
  sums.resize(probabilities.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i] += std::log(std::max(kLeast, static_cast<double>(probabilities[i])));
  }
}

/// The probabilities whose logarithms are the means of `teachers` that were summed.
std::vector<float> probabilities_of(const std::vector<double>& sums, std::size_t classes,
                                    int teachers) {
  std::vector<float> probabilities(sums.size());
  for (std::size_t row = 0; row < sums.size(); row += classes) {
    double total = 0.0;
    for (std::size_t i = row; i < row + classes; ++i) total += std::exp(sums[i] / teachers);
    for (std::size_t i = row; i < row + classes; ++i) {
      probabilities[i] = static_cast<float>(std::exp(sums[i] / teachers) / total);
    }
  }
  return probabilities;
}

}  // namespace

TrainResult distil(const Architecture& architecture, const TrainingSet& set,
                   const TrainOptions& options, int teachers,
                   const std::function<void(const EpochReport&)>& on_epoch,
                   const Progress* progress) {
  std::vector<double> sums;
  Random seeds(options.seed, kTeacherStream);
  for (int t = 0; t < teachers; ++t) {
    TrainOptions of_teacher = options;
    of_teacher.seed = seeds.next();
    TrainResult teacher = train(architecture, set, of_teacher, on_epoch, progress);
    if (teacher.cancelled) return teacher;
    add_logarithms(predict(teacher.best, set.samples), sums);
  }
  if (teachers == 0) return train(architecture, set, options, on_epoch, progress);
  const auto targets =
      probabilities_of(sums, static_cast<std::size_t>(architecture.classes), teachers);
  return train(architecture, {set.samples, set.labels, targets}, options, on_epoch, progress);
}

}  // namespace pcednet::nn
