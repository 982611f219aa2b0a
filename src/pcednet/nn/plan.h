#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pcednet/nn/model.h"

namespace pcednet::nn {

enum class Activation { kSigmoid, kRelu, kNone };

/// An affine map from some rows of a table to others: output o is
///   bias[o] + sum over segments s, k < length of weight[o,s,k] row[in_row + s in_segment_rows +
///   k].
/// A dense layer is one map with one segment; PCEDNet's pairs are one map each; a convolution is
/// one map per output position, with one segment per input channel.
struct AffineMap {
  int outputs = 0, segments = 1, length = 0;
  std::size_t weight = 0, weight_output_stride = 0, weight_segment_stride = 0, bias = 0;
  int in_row = 0, in_segment_rows = 0;
  int out_row = 0, out_row_stride = 1;
};

/// A layer: its maps, the rows that it writes, and its two tensors in the flat parameters.
struct Layer {
  std::string name;  ///< "tree.0", "mlp.2", ...; the tensors are name.weight and name.bias
  std::vector<AffineMap> maps;
  Activation activation = Activation::kSigmoid;
  int out_row = 0, out_rows = 0;
  int fan_in = 0, fan_out = 0;  ///< of one neuron group, for the initialisation
  std::size_t weight = 0, bias = 0;
  std::vector<std::size_t> weight_shape, bias_shape;
};

/// A network unrolled to a table with a row per number that it computes: the inputs first (scale by
/// scale), then the outputs of each layer; the last `classes` rows are the logits.
struct Plan {
  std::vector<Layer> layers;
  int rows = 0;
  std::size_t parameters = 0;
};

/// The number of values of a tensor of this shape.
std::size_t count_of(const std::vector<std::size_t>& shape);

/// Throws Error(kUsage) for a shape that cannot be built.
Plan make_plan(const Architecture& architecture);

}  // namespace pcednet::nn
