#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "pcednet/gls/fast_scale_space.h"
#include "pcednet/gls/scale_space.h"

namespace pcednet::gls {

/// The scale-space matrix of a cloud from the engine that the options name. Reconstructions with
/// planes are evaluated exactly whatever they name.
class ScaleSpace {
 public:
  /// Throws what the engines' constructors throw.
  ScaleSpace(OrientedPoints points, const ScaleSpaceOptions& options,
             const Progress* progress = nullptr);

  /// As given, but for `engine`, which is the one in use.
  const ScaleSpaceOptions& options() const { return options_; }
  const std::vector<double>& scales() const;
  std::span<const std::uint32_t> order() const;

  /// As the engines do it.
  void describe(std::span<const std::uint32_t> targets, std::span<float> out,
                std::span<FitStatus> status, const Progress* progress = nullptr) const;

 private:
  ScaleSpaceOptions options_;
  std::variant<FastScaleSpace, ExactScaleSpace> engine_;
};

}  // namespace pcednet::gls
