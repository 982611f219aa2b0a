#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/random.h"
#include "pcednet/nn/model.h"

/// The networks written down once more from the paper, a number at a time and in double.
namespace pcednet::nn::reference {

using Numbers = std::vector<double>;

inline double sigmoid(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

/// Reads the parameters of one layer after the other.
struct Parameters {
  std::span<const double> rest;

  Numbers take(std::size_t count) {
    Numbers taken(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(count));
    rest = rest.subspan(count);
    return taken;
  }
};

inline Numbers dense(const Numbers& weights, const Numbers& biases, const Numbers& in) {
  Numbers out = biases;
  for (std::size_t o = 0; o < out.size(); ++o) {
    for (std::size_t i = 0; i < in.size(); ++i) out[o] += weights[o * in.size() + i] * in[i];
  }
  return out;
}

inline Numbers dense_sigmoid(Parameters& parameters, const Numbers& in, int neurons) {
  const auto n = static_cast<std::size_t>(neurons);
  const Numbers weights = parameters.take(n * in.size());
  Numbers out = dense(weights, parameters.take(n), in);
  for (double& x : out) x = sigmoid(x);
  return out;
}

inline Numbers dense_linear(Parameters& parameters, const Numbers& in, int neurons) {
  const auto n = static_cast<std::size_t>(neurons);
  const Numbers weights = parameters.take(n * in.size());
  return dense(weights, parameters.take(n), in);
}

/// One step of PCEDNet: neighbouring vectors joined, each pair in a layer of its own.
inline std::vector<Numbers> join_pairs(Parameters& parameters, const std::vector<Numbers>& vectors,
                                       int width) {
  const std::size_t pairs = vectors.size() / 2;
  const auto w = static_cast<std::size_t>(width);
  const std::size_t inputs = 2 * vectors[0].size();
  const Numbers weights = parameters.take(pairs * w * inputs);
  const Numbers biases = parameters.take(pairs * w);
  std::vector<Numbers> joined;
  for (std::size_t k = 0; k < pairs; ++k) {
    Numbers in = vectors[2 * k];
    in.insert(in.end(), vectors[2 * k + 1].begin(), vectors[2 * k + 1].end());
    Numbers out(w);
    for (std::size_t o = 0; o < w; ++o) {
      double sum = biases[k * w + o];
      for (std::size_t i = 0; i < inputs; ++i) sum += weights[(k * w + o) * inputs + i] * in[i];
      out[o] = sigmoid(sum);
    }
    joined.push_back(out);
  }
  return joined;
}

/// `in`: channels x length. Cross-correlation with zeros around, then max(0, x).
inline Numbers convolution_relu(Parameters& parameters, const Numbers& in, int channels,
                                int filters, int kernel, int padding) {
  const int length = static_cast<int>(in.size()) / channels;
  const int out_length = length + 2 * padding - kernel + 1;
  const Numbers weights = parameters.take(static_cast<std::size_t>(filters * channels * kernel));
  const Numbers biases = parameters.take(static_cast<std::size_t>(filters));
  Numbers out;
  for (int f = 0; f < filters; ++f) {
    for (int x = 0; x < out_length; ++x) {
      double sum = biases[static_cast<std::size_t>(f)];
      for (int c = 0; c < channels; ++c) {
        for (int k = 0; k < kernel; ++k) {
          const int at = x + k - padding;
          if (at < 0 || at >= length) continue;
          sum += weights[static_cast<std::size_t>((f * channels + c) * kernel + k)] *
                 in[static_cast<std::size_t>(c * length + at)];
        }
      }
      out.push_back(std::max(0.0, sum));
    }
  }
  return out;
}

/// Logits of one sample.
inline Numbers logits(const Architecture& a, std::span<const double> values,
                      const Numbers& sample) {
  Parameters parameters{values};
  Numbers x = sample;
  if (a.kind == NetworkKind::kCnn) {
    x = convolution_relu(parameters, x, a.scales, 15, 6, 2);
    x = convolution_relu(parameters, x, 15, 15, 5, 2);
    for (const int neurons : {75, 15, 15}) x = dense_sigmoid(parameters, x, neurons);
    return dense_linear(parameters, x, a.classes);
  }
  const int width = a.width ? a.width : a.features;
  if (a.kind == NetworkKind::kFc) {
    for (int scales = a.scales / 2; scales >= 2; scales /= 2) {
      x = dense_sigmoid(parameters, x, scales * width);
    }
  } else {
    std::vector<Numbers> vectors;
    const std::ptrdiff_t f = a.features;
    for (int s = 0; s < a.scales; ++s) {
      vectors.emplace_back(x.begin() + s * f, x.begin() + (s + 1) * f);
    }
    while (vectors.size() > 2) vectors = join_pairs(parameters, vectors, width);
    x = vectors[0];
    x.insert(x.end(), vectors[1].begin(), vectors[1].end());
  }
  x = dense_sigmoid(parameters, x, a.hidden);
  x = dense_sigmoid(parameters, x, a.hidden);
  return dense_linear(parameters, x, a.classes);
}

inline Numbers softmax(const Numbers& logits) {
  const double highest = *std::max_element(logits.begin(), logits.end());
  double total = 0.0;
  for (const double z : logits) total += std::exp(z - highest);
  Numbers p;
  for (const double z : logits) p.push_back(std::exp(z - highest) / total);
  return p;
}

}  // namespace pcednet::nn::reference

namespace pcednet::nn {

/// Numbers of about normal distribution.
inline std::vector<float> random_numbers(std::size_t count, std::uint64_t seed,
                                         double scale = 1.0) {
  Random random(seed);
  std::vector<float> numbers(count);
  for (float& x : numbers) x = static_cast<float>(scale * random.normal());
  return numbers;
}

inline std::vector<double> to_double(std::span<const float> values) {
  return {values.begin(), values.end()};
}

/// Shapes that between them use every path of the code.
inline std::vector<Architecture> various_architectures() {
  using enum NetworkKind;
  return {{kPcednet, 16, 6, 3, 0, 16}, {kPcednet, 16, 6, 2, 12, 32}, {kPcednet, 4, 3, 2, 0, 5},
          {kPcednet, 32, 7, 3, 5, 16}, {kFc, 16, 6, 3, 0, 16},       {kFc, 8, 4, 5, 3, 7},
          {kCnn, 16, 6, 3, 0, 16},     {kCnn, 8, 3, 2, 0, 16}};
}

}  // namespace pcednet::nn
