#pragma once

#include <cstddef>
#include <cstdint>

namespace pcednet::spatial {

/// The inner loops of NeighbourSearch, compiled for several instruction sets, with the same bytes
/// in all of them.

/// Eight boxes, one per vector lane.
struct EightBoxes {
  double min[3][8], max[3][8];
};

/// Squared distances between each of the boxes and one box.
void sq_gaps(const EightBoxes& boxes, const double min[3], const double max[3],
             double* __restrict out);

/// Points near a run, in its local frame: (p - centre) * scale.
struct Candidates {
  static constexpr std::size_t kStep = 16;    ///< per step
  static constexpr std::size_t kMost = 2048;  ///< above, a search of the tree is faster
  static constexpr std::size_t kRoom = kMost + 2 * kStep;
  static constexpr float kError = 1.0f / (1 << 19);  ///< bound of the rounding error of a distance

  double centre[3], scale;
  float half[3];    ///< half the side lengths of the run's box
  float sq_radius;  ///< candidates are within this distance of the box
  std::size_t count = 0;
  alignas(64) float x[kRoom], y[kRoom], z[kRoom];
  alignas(64) float sq[kRoom];  ///< room for squared distances
  std::uint32_t index[kRoom];
};

/// Appends those of the positions [begin, begin + count), kStep at most, that are within the
/// radius. Reads kStep positions.
void add_near(const double* const positions[3], std::size_t begin, std::size_t count,
              Candidates& candidates);

/// Finds all candidates within a radius of q that holds at least `wanted` of them: slightly more
/// than that of `sq_guess` if that suffices. Writes their indices, ascending if those of the
/// candidates are, and returns their number; 0 if fewer than `wanted` are within the radius of the
/// candidates.
std::size_t pick_nearest(Candidates& candidates, const float q[3], std::size_t wanted,
                         float sq_guess, std::uint32_t* picked);

/// Squared distances (dx^2 + dy^2) + dz^2 of the positions at `index` to that at `query`. Room for
/// kStep values must follow; they are set to infinity.
void sq_distances(const double* const positions[3], std::uint32_t query, const std::uint32_t* index,
                  std::size_t count, double* out);

}  // namespace pcednet::spatial
