#pragma once

#include <span>

#include "pcednet/core/vec3.h"
#include "pcednet/detect/classify.h"

namespace pcednet::detect {

struct CleanUpOptions {
  int neighbours = 8;   ///< nearest points that have a say, at least 1
  double weight = 0.5;  ///< of each of their opinions, that of the point itself being 1
};

/// Lets neighbours vote: every point's probabilities become the weighted mean of its own and its
/// nearest neighbours', and the class follows. Lone false edges go, gaps close, lines of a single
/// point fade. `positions` are those that were classified; unlabelled points stay so and have no
/// say. The result does not depend on threads or on the order of the points.
/// Throws Error(kUsage) for less than one neighbour or sizes that differ.
void clean_up(std::span<const Vec3> positions, Classification& result,
              const CleanUpOptions& options = {}, const Progress* progress = nullptr);

}  // namespace pcednet::detect
