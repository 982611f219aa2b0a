#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "pcednet/nn/evaluator.h"
#include "pcednet/nn/train.h"

namespace pcednet::nn {

/// The loss of a model over some samples and its derivative by the parameters.
///
/// The loss is the mean cross-entropy -sum_c target_c log p_c. With Symmetry::kAverage p is the
/// softmax of the averaged logits, so training uses the predicted probabilities.
class GradientMachine {
 public:
  /// `model` must outlive it; its parameters may change between calls.
  explicit GradientMachine(const Model& model, InstructionSet instructions = instruction_set());

  ~GradientMachine();

  /// Returns the mean loss over the samples `chosen` (indices into `set`, none of them ignored) and
  /// writes its derivatives to `gradient`. The batch is cut in chunks of fixed size whose gradients
  /// are added in order: the same bytes for any number of threads.
  double run(const TrainingSet& set, std::span<const std::uint32_t> chosen,
             std::span<float> gradient);

 private:
  struct Workspace;

  std::unique_ptr<Workspace> borrow();
  void give_back(std::unique_ptr<Workspace> workspace);
  double run_chunk(Workspace& workspace, const TrainingSet& set,
                   std::span<const std::uint32_t> chosen, float weight, float* gradient) const;

  Evaluator evaluator_;
  std::vector<float> chunk_gradients_;
  std::vector<double> chunk_losses_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> idle_;  // one per thread that ever worked at once
};

}  // namespace pcednet::nn
