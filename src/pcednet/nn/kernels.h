#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcednet/core/processor.h"
#include "pcednet/nn/plan.h"

/// The inner loops, compiled once per vector instruction set and chosen at run time.
///
/// They work on tables of `lanes` points per row (a multiple of kLaneStep), row after row. Every
/// number is computed by the same operations in the same order whatever the instruction set and
/// wherever the point stands in its row, so the bytes are the same on every processor.
namespace pcednet::nn {

constexpr int kLaneStep = 32;

/// Memory for tables: rows start on cache lines.
struct alignas(64) CacheLine {
  float values[16];
};
class LaneTable {
 public:
  LaneTable(int rows, int lanes)
      : lanes_(lanes),
        lines_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(lanes) / 16) {}
  float* row(int r) { return lines_.data()->values + static_cast<std::ptrdiff_t>(r) * lanes_; }
  int lanes() const { return lanes_; }

 private:
  int lanes_;
  std::vector<CacheLine> lines_;
};

/// How input numbers are brought to the range a network likes.
struct InputScaling {
  const float* mean = nullptr;               ///< per input
  const float* inverse_deviation = nullptr;  ///< per input
  float bound = 0.0f;                        ///< on either side
};

/// Which inputs change sign when every normal is flipped, and those that decide a point's sign.
struct SignPattern {
  const std::uint8_t* odd = nullptr;  ///< per input
  int inputs = 0;
  int first = 0, step = 1;  ///< the deciding inputs: first, first + step, ...
};

struct Kernels {
  /// rows[0, points) point to `inputs` numbers each; they become the first `inputs` rows of
  /// `table`.
  void (*transpose)(const float* const* rows, int inputs, float* table, int lanes, int points);

  /// Scales the first `inputs` rows; numbers that are not finite become 0, and so does -0.
  void (*scale)(const InputScaling& scaling, int inputs, float* table, int lanes);

  /// Makes the second half of every input row the first half with the odd inputs negated.
  void (*mirror)(const SignPattern& signs, float* table, int lanes);

  /// Negates the odd inputs of the points whose deciding inputs sum to less than zero; where the
  /// sum is zero the first odd input that is not decides.
  void (*orient)(const SignPattern& signs, float* table, int lanes);

  void (*forward)(const AffineMap& map, const float* parameters, float* table, int lanes);

  /// The same for inputs that mirror() has made, with three operations in place of four: the
  /// products of the second half are those of the first, or their negatives.
  void (*forward_mirrored)(const AffineMap& map, const SignPattern& signs, const float* parameters,
                           float* table, int lanes);
  void (*activate)(Activation activation, float* rows, int count, int lanes);

  /// Replaces the rows (logits) by class probabilities. With `paired`, the logits are first
  /// averaged over the two halves of the row, and only the first half is written.
  void (*softmax)(float* rows, int classes, int lanes, bool paired);

  /// From logits (left as they are) to the cross-entropy of each lane and its derivative by the
  /// logits, both times the point's `weight`. `targets` has a row per class of the probabilities
  /// wanted, one for each point: half as long as the logits' with `paired`, which is as in softmax.
  void (*cross_entropy)(const float* logits, const float* targets, const float* weights,
                        int classes, int lanes, bool paired, float* losses, float* deltas);

  /// Turns derivatives by a layer's outputs into derivatives by its sums, given the outputs.
  void (*activate_backward)(Activation activation, const float* outputs, float* deltas,
                            std::size_t count);

  /// Adds to `gradient` the derivatives by the map's parameters, summed over the lanes, and, with
  /// `to_inputs`, to the input rows of `deltas` those by its inputs.
  void (*backward)(const AffineMap& map, const float* parameters, const float* table, float* deltas,
                   int lanes, bool to_inputs, float* gradient);
};

/// Of kernels_*.cpp; the last two on x86-64 alone.
extern const Kernels kernels_baseline, kernels_avx2, kernels_avx512;

/// The kernels for instructions that this processor has.
const Kernels& kernels(InstructionSet instructions = instruction_set());

}  // namespace pcednet::nn
