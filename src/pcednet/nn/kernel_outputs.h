#pragma once

#include "pcednet/nn/kernel_math.h"
#include "pcednet/nn/kernels.h"

/// Activations, probabilities and losses: see kernels.h.
namespace pcednet::nn {
namespace {  // each unit has its own copy, see simd.h

/// Two rows at once, which share one division.
template <int W>
[[gnu::always_inline]] inline void sigmoid_pair(float* a, float* b, int lanes) {
  for (int p = 0; p < lanes; p += W) {
    const Floats<W> u = sigmoid_denominator(load<W>(a + p));
    const Floats<W> v = sigmoid_denominator(load<W>(b + p));
    const Floats<W> inverse = 1.0f / (u * v);
    store(a + p, v * inverse);
    store(b + p, u * inverse);
  }
}

template <int W>
void activate(Activation activation, float* rows, int count, int lanes) {
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(count) * lanes;
  if (activation == Activation::kSigmoid) {
    float* row = rows;
    for (; row + lanes < rows + size; row += 2 * lanes) sigmoid_pair<W>(row, row + lanes, lanes);
    if (row == rows + size) return;
    for (int p = 0; p < lanes; p += W) {
      store(row + p, 1.0f / sigmoid_denominator(load<W>(row + p)));
    }
  } else if (activation == Activation::kRelu) {
    for (std::ptrdiff_t i = 0; i < size; i += W) {
      store(rows + i, at_least(load<W>(rows + i), 0.0f));
    }
  }
}

template <int W>
[[gnu::always_inline]] inline Floats<W> logit(const float* rows, int c, int p, int lanes,
                                              bool paired) {
  const float* at = rows + static_cast<std::ptrdiff_t>(c) * lanes + p;
  return paired ? 0.5f * (load<W>(at) + load<W>(at + lanes / 2)) : load<W>(at);
}

/// Over the classes, of W points from p on.
template <int W>
[[gnu::always_inline]] inline Floats<W> highest_logit(const float* rows, int classes, int p,
                                                      int lanes, bool paired) {
  Floats<W> highest = logit<W>(rows, 0, p, lanes, paired);
  for (int c = 1; c < classes; ++c) {
    const Floats<W> z = logit<W>(rows, c, p, lanes, paired);
    highest = z > highest ? z : highest;
  }
  return highest;
}

template <int W>
void softmax(float* rows, int classes, int lanes, bool paired) {
  const int used = paired ? lanes / 2 : lanes;
  for (int p = 0; p < used; p += W) {
    const Floats<W> highest = highest_logit<W>(rows, classes, p, lanes, paired);
    Floats<W> total = splat<W>(0.0f);
    for (int c = 0; c < classes; ++c) {
      const Floats<W> power = exponential(logit<W>(rows, c, p, lanes, paired) - highest);
      store(rows + static_cast<std::ptrdiff_t>(c) * lanes + p, power);
      total += power;
    }
    for (int c = 0; c < classes; ++c) {
      float* at = rows + static_cast<std::ptrdiff_t>(c) * lanes + p;
      store(at, load<W>(at) / total);
    }
  }
}

template <int W>
void cross_entropy(const float* logits, const float* targets, const float* weights, int classes,
                   int lanes, bool paired, float* losses, float* deltas) {
  const int used = paired ? lanes / 2 : lanes;
  for (int p = 0; p < used; p += W) {
    const Floats<W> highest = highest_logit<W>(logits, classes, p, lanes, paired);
    Floats<W> total = splat<W>(0.0f);
    for (int c = 0; c < classes; ++c) {
      total += exponential(logit<W>(logits, c, p, lanes, paired) - highest);
    }
    const Floats<W> log_total = logarithm(total);
    const Floats<W> weight = load<W>(weights + p);
    Floats<W> loss = splat<W>(0.0f);
    for (int c = 0; c < classes; ++c) {
      const Floats<W> z = logit<W>(logits, c, p, lanes, paired) - highest;
      const Floats<W> target = load<W>(targets + static_cast<std::ptrdiff_t>(c) * used + p);
      loss += target * (log_total - z);
      const Floats<W> delta = weight * (exponential(z) / total - target);
      float* at = deltas + static_cast<std::ptrdiff_t>(c) * lanes + p;
      store(at, paired ? 0.5f * delta : delta);
      if (paired) store(at + used, 0.5f * delta);
    }
    store(losses + p, weight * loss);
  }
}

template <int W>
void activate_backward(Activation activation, const float* outputs, float* deltas,
                       std::size_t count) {
  if (activation == Activation::kSigmoid) {
    for (std::size_t i = 0; i < count; i += W) {
      const Floats<W> y = load<W>(outputs + i);
      store(deltas + i, load<W>(deltas + i) * (y * (1.0f - y)));
    }
  } else if (activation == Activation::kRelu) {
    for (std::size_t i = 0; i < count; i += W) {
      store(deltas + i, load<W>(outputs + i) > 0.0f ? load<W>(deltas + i) : splat<W>(0.0f));
    }
  }
}

}  // namespace
}  // namespace pcednet::nn
