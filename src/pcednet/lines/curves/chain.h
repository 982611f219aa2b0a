#pragma once

#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/lines/creases/crease.h"

namespace pcednet::lines {

/// The mean of creases that lie side by side.
struct ChainNode {
  Vec3 at;
  Vec3 along;  ///< unit, towards the next node
  Vec3 side_a, side_b;
  double spacing = 0.0;
  double edge_points = 0.0;  ///< number of its points of an edge class
  double probability = 0.0;  ///< their mean; that of all its points if there are none
  double bend = 0.0;         ///< mean
  double rounded = 0.0;      ///< share of rounded creases
  double sharp = 0.0;        ///< share of sharp-edge points
  double boundary = 0.0;     ///< share of boundary points
};

/// Creases in their order along an edge, about one spacing apart.
struct Chain {
  std::vector<ChainNode> nodes;
  bool closed = false;
};

/// The similarity of two wedges: the smaller cosine between their sides, in the better of the two
/// matchings.
struct WedgeMatch {
  double cosine;
  bool crossed;  ///< side a of one is side b of the other
};
WedgeMatch match(const Vec3& side_a, const Vec3& side_b, const Vec3& other_a, const Vec3& other_b);

/// Every crease averaged with those nearer than `reach` (in spacings) that continue it; rounded if
/// most of them are. Advances `stage` by a step per crease.
std::vector<Crease> smoothed(std::span<const Crease> creases, double reach, Stage& stage);

/// Chains from end to end, those of the densest creases first. They cross gaps up to `gap` where
/// creases beyond continue them. Advances `stage` by a step per crease.
std::vector<Chain> trace(std::span<const Crease> creases, double gap, double noise, Stage& stage);

}  // namespace pcednet::lines
