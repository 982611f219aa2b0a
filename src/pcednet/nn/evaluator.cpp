#include "pcednet/nn/evaluator.h"

#include "pcednet/nn/plan.h"

namespace pcednet::nn {

Evaluator::Evaluator(const Model& model, InstructionSet instructions)
    : model_(&model),
      plan_(make_plan(model.network.architecture)),
      kernels_(&nn::kernels(instructions)),
      odd_inputs_(static_cast<std::size_t>(inputs()), 0) {
  check_consistent(model);
  const std::vector<std::uint8_t>& odd = model.sign_rule.odd_features;
  if (odd.empty()) return;
  for (std::size_t u = 0; u < odd_inputs_.size(); ++u) odd_inputs_[u] = odd[u % odd.size()];
}

void Evaluator::run(const float* const* rows, LaneTable& table) const {
  const Standardisation& s = model_->standardisation;
  const SignRule& rule = model_->sign_rule;
  float* data = table.row(0);
  const int lanes = table.lanes();
  const SignPattern signs = {odd_inputs_.data(), inputs(), rule.deciding_feature,
                             model_->network.architecture.features};
  kernels_->transpose(rows, inputs(), data, lanes, paired() ? lanes / 2 : lanes);
  kernels_->scale({s.mean.data(), s.inverse_deviation.data(), s.bound}, inputs(), data, lanes);
  if (rule.symmetry == Symmetry::kAverage) kernels_->mirror(signs, data, lanes);
  if (rule.symmetry == Symmetry::kCanonical) kernels_->orient(signs, data, lanes);
  const float* parameters = model_->network.parameters.data();
  for (const Layer& layer : plan_.layers) {
    const bool mirrored = paired() && &layer == &plan_.layers.front();
    for (const AffineMap& map : layer.maps) {
      if (mirrored) {
        kernels_->forward_mirrored(map, signs, parameters, data, lanes);
      } else {
        kernels_->forward(map, parameters, data, lanes);
      }
    }
    kernels_->activate(layer.activation, table.row(layer.out_row), layer.out_rows, lanes);
  }
}

}  // namespace pcednet::nn
