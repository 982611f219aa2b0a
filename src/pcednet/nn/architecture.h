#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pcednet::nn {

enum class NetworkKind {
  kPcednet,  ///< scales are joined pair by pair, each pair in a dense layer of its own
  kFc,       ///< the same neurons, every layer connected to all of the one before
  kCnn,      ///< two 1D convolutions over the features, with the scales as channels
};

/// The shape of a network: everything but its weights.
///
/// With 16 scales, 6 features, 3 classes and the default widths: PCEDNet has 1623 weights, FC 6663,
/// CNN 9723.
struct Architecture {
  NetworkKind kind = NetworkKind::kPcednet;
  int scales = 16;   ///< a power of two, at least 4
  int features = 6;  ///< numbers per scale
  int classes = 3;   ///< at least 2
  int width = 0;     ///< neurons per pair of scales; 0: as many as features. CNN: not used
  int hidden = 16;   ///< neurons of the classifier's two hidden layers. CNN: not used

  int inputs() const { return scales * features; }
  int pair_width() const { return width > 0 ? width : features; }
  bool operator==(const Architecture&) const = default;
};

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

/// Throws Error(kUsage) for a shape that cannot be built.
Plan make_plan(const Architecture& architecture);

/// The number of parameters, biases included.
std::size_t weight_count(const Architecture& architecture);

}  // namespace pcednet::nn
