#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "pcednet/gls/engine/fast_scale_space.h"
#include "pcednet/gls/exact_scale_space.h"

namespace pcednet::gls {

/// The scale-space matrix of a cloud from the engine that the options name. Reconstructions with
/// planes are always evaluated by the exact engine.
class ScaleSpace {
 public:
  /// Throws as the engines' constructors do.
  ScaleSpace(OrientedPoints points, const ScaleSpaceOptions& options,
             const Progress* progress = nullptr);

  /// The options as given, with `engine` the one in use.
  const ScaleSpaceOptions& options() const { return options_; }
  const std::vector<double>& scales() const;
  const ScaleRange& range() const;

  /// See FastScaleSpace::take_octave().
  void take_octave(std::size_t octave, const PyramidPlan* whole = nullptr,
                   const Progress* progress = nullptr);

  std::span<const std::uint32_t> order() const;

  /// See ExactScaleSpace::describe() and FastScaleSpace::describe().
  void describe(std::span<const std::uint32_t> targets, std::span<float> out,
                std::span<FitStatus> status, const Progress* progress = nullptr) const;

 private:
  ScaleSpaceOptions options_;
  std::variant<FastScaleSpace, ExactScaleSpace> engine_;
};

}  // namespace pcednet::gls
