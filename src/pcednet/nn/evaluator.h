#pragma once

#include <cstdint>
#include <vector>

#include "pcednet/nn/kernels.h"
#include "pcednet/nn/model.h"

namespace pcednet::nn {

/// A model prepared for blocks of points. The model must outlive it; its parameters may change
/// between runs.
class Evaluator {
 public:
  /// Throws Error(kUsage) if the model's parts do not fit each other.
  explicit Evaluator(const Model& model, InstructionSet instructions = instruction_set());

  const Model& model() const { return *model_; }
  const Plan& plan() const { return plan_; }
  const Kernels& kernels() const { return *kernels_; }
  int classes() const { return model_->network.architecture.classes; }
  int inputs() const { return model_->network.architecture.inputs(); }

  /// True if every point takes two lanes, with its flipped twin in the second half of the row.
  bool paired() const { return model_->sign_rule.symmetry == Symmetry::kAverage; }

  /// The lanes of a table for `points` points (a multiple of kLaneStep).
  int lanes_for(int points) const { return paired() ? 2 * points : points; }

  /// A table for `points` points, with a row for every number of the plan.
  LaneTable make_table(int points) const { return {plan_.rows, lanes_for(points)}; }

  /// Fills all rows of `table` from the samples that `rows` point to, one per point of the table.
  void run(const float* const* rows, LaneTable& table) const;

  /// The first of the rows that hold the logits.
  int logits_row() const { return plan_.rows - classes(); }

 private:
  const Model* model_;
  Plan plan_;
  const Kernels* kernels_;
  std::vector<std::uint8_t> odd_inputs_;
};

}  // namespace pcednet::nn
