#include "pcednet/nn/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "pcednet/core/error.h"

namespace pcednet::nn {
namespace {

constexpr int kMaxWidth = 4096;

void check(const Architecture& a) {
  const auto refuse = [](const std::string& what) { throw Error(ErrorKind::kUsage, what); };
  if (a.scales < 4 || a.scales > 1024 || !std::has_single_bit(static_cast<unsigned>(a.scales))) {
    refuse(
        fmt::format("a network of {} scales: a power of two from 4 to 1024 is needed", a.scales));
  }
  const int fewest = a.kind == NetworkKind::kCnn ? 2 : 1;
  if (a.features < fewest || a.features > 256) {
    refuse(fmt::format("a network of {} features: {} to 256 are possible", a.features, fewest));
  }
  if (a.classes < 2 || a.classes > 254) {
    refuse(fmt::format("a network of {} classes: 2 to 254 are possible", a.classes));
  }
  if (a.width < 0 || a.width > kMaxWidth || a.hidden < 1 || a.hidden > kMaxWidth) {
    refuse(fmt::format("a network of width {} and {} hidden neurons: at most {} are possible",
                       a.width, a.hidden, kMaxWidth));
  }
}

/// Appends layers, each reading the rows that the one before wrote.
class Builder {
 public:
  explicit Builder(int inputs) : in_rows_(inputs) { plan_.rows = inputs; }

  /// `groups` dense layers side by side, each with its own share of the rows and its own weights.
  void dense(std::string name, int groups, int outputs, Activation activation) {
    const int inputs = in_rows_ / groups;
    const auto g = static_cast<std::size_t>(groups);
    const auto o = static_cast<std::size_t>(outputs);
    const auto i = static_cast<std::size_t>(inputs);
    Layer layer = start(std::move(name), activation, inputs, outputs, groups * outputs);
    layer.weight_shape = groups > 1 ? std::vector{g, o, i} : std::vector{o, i};
    layer.bias_shape = groups > 1 ? std::vector{g, o} : std::vector{o};
    place(layer);
    for (int k = 0; k < groups; ++k) {
      AffineMap map;
      map.outputs = outputs;
      map.length = inputs;
      map.weight = layer.weight + static_cast<std::size_t>(k) * o * i;
      map.weight_output_stride = i;
      map.bias = layer.bias + static_cast<std::size_t>(k) * o;
      map.in_row = in_row_ + k * inputs;
      map.out_row = layer.out_row + k * outputs;
      layer.maps.push_back(map);
    }
    finish(std::move(layer));
  }

  /// A 1D convolution over `channels` signals, with zeros around them.
  void convolution(std::string name, int channels, int filters, int kernel, int padding) {
    const int length = in_rows_ / channels;
    const int out_length = length + 2 * padding - kernel + 1;
    const auto f = static_cast<std::size_t>(filters);
    const auto c = static_cast<std::size_t>(channels);
    const auto k = static_cast<std::size_t>(kernel);
    Layer layer = start(std::move(name), Activation::kRelu, channels * kernel, filters * kernel,
                        filters * out_length);
    layer.weight_shape = {f, c, k};
    layer.bias_shape = {f};
    place(layer);
    for (int x = 0; x < out_length; ++x) {
      const int first = std::max(0, padding - x);  // the part of the kernel that is on the signal
      const int end = std::min(kernel, length + padding - x);
      AffineMap map;
      map.outputs = filters;
      map.segments = channels;
      map.length = end - first;
      map.weight = layer.weight + static_cast<std::size_t>(first);
      map.weight_output_stride = c * k;
      map.weight_segment_stride = k;
      map.bias = layer.bias;
      map.in_row = in_row_ + x - padding + first;
      map.in_segment_rows = length;
      map.out_row = layer.out_row + x;
      map.out_row_stride = out_length;
      layer.maps.push_back(map);
    }
    finish(std::move(layer));
  }

  Plan take() { return std::move(plan_); }

 private:
  Layer start(std::string name, Activation activation, int fan_in, int fan_out, int out_rows) {
    Layer layer;
    layer.name = std::move(name);
    layer.activation = activation;
    layer.fan_in = fan_in;
    layer.fan_out = fan_out;
    layer.out_row = plan_.rows;
    layer.out_rows = out_rows;
    return layer;
  }

  void place(Layer& layer) {
    layer.weight = plan_.parameters;
    layer.bias = layer.weight + count_of(layer.weight_shape);
    plan_.parameters = layer.bias + count_of(layer.bias_shape);
  }

  void finish(Layer layer) {
    in_row_ = layer.out_row;
    in_rows_ = layer.out_rows;
    plan_.rows += layer.out_rows;
    plan_.layers.push_back(std::move(layer));
  }

  Plan plan_;
  int in_row_ = 0;
  int in_rows_ = 0;
};

}  // namespace

std::size_t count_of(const std::vector<std::size_t>& shape) {
  std::size_t count = 1;
  for (const std::size_t n : shape) count *= n;
  return count;
}

Plan make_plan(const Architecture& a) {
  check(a);
  Builder builder(a.inputs());
  if (a.kind == NetworkKind::kCnn) {
    constexpr int kFilters = 15;
    builder.convolution("conv.0", a.scales, kFilters, 6, 2);
    builder.convolution("conv.1", kFilters, kFilters, 5, 2);
    builder.dense("mlp.0", 1, 75, Activation::kSigmoid);
    builder.dense("mlp.1", 1, 15, Activation::kSigmoid);
    builder.dense("mlp.2", 1, 15, Activation::kSigmoid);
    builder.dense("mlp.3", 1, a.classes, Activation::kNone);
    return builder.take();
  }
  const bool tree = a.kind == NetworkKind::kPcednet;
  int level = 0;
  for (int pairs = a.scales / 2; pairs >= 2; pairs /= 2, ++level) {
    if (tree) {
      builder.dense(fmt::format("tree.{}", level), pairs, a.pair_width(), Activation::kSigmoid);
    } else {
      builder.dense(fmt::format("fc.{}", level), 1, pairs * a.pair_width(), Activation::kSigmoid);
    }
  }
  builder.dense("mlp.0", 1, a.hidden, Activation::kSigmoid);
  builder.dense("mlp.1", 1, a.hidden, Activation::kSigmoid);
  builder.dense("mlp.2", 1, a.classes, Activation::kNone);
  return builder.take();
}

std::size_t weight_count(const Architecture& architecture) {
  return make_plan(architecture).parameters;
}

}  // namespace pcednet::nn
