#pragma once

#include <cstddef>
#include <cstdint>

namespace pcednet::spatial {

/// The inner loops of NeighbourSearch, compiled for several instruction sets; each gives the same
/// bytes with all of them.

/// Eight boxes side by side.
struct EightBoxes {
  double min[3][8], max[3][8];
};

/// Squared distances between each of the boxes and one box.
void sq_gaps(const EightBoxes& boxes, const double min[3], const double max[3],
             double* __restrict out);

/// Points near a run, in its local frame: (p - centre) * scale.
struct Candidates {
  static constexpr std::size_t kStep = 16;    ///< at a time
  static constexpr std::size_t kMost = 2048;  ///< more are not worth their distances
  static constexpr std::size_t kRoom = kMost + 2 * kStep;
  static constexpr float kError = 1.0f / (1 << 19);  ///< more than rounding does to a distance

  double centre[3], scale;
  float half[3];    ///< of the sides of the run's box
  float sq_radius;  ///< around the box, within which candidates are
  std::size_t count = 0;
  alignas(64) float x[kRoom], y[kRoom], z[kRoom];
  alignas(64) float sq[kRoom];  ///< room for squared distances
  std::uint32_t index[kRoom];
};

/// Appends of the positions [begin, begin + count), kStep at most, those within the radius. kStep
/// positions are read.
void add_near(const double* const positions[3], std::size_t begin, std::size_t count,
              Candidates& candidates);

/// Finds at least `wanted` candidates, all that are within some radius of q: a little more than
/// that of `sq_guess` if there are enough. Writes their indices, ascending if the candidates' are,
/// and returns how many there are; 0 if fewer than wanted are within the candidates' radius.
std::size_t pick_nearest(Candidates& candidates, const float q[3], std::size_t wanted,
                         float sq_guess, std::uint32_t* picked);

/// Squared distances (dx^2 + dy^2) + dz^2 of the positions at `index` to that at `query`. Room for
/// kStep values must follow; they are set to infinity.
void sq_distances(const double* const positions[3], std::uint32_t query, const std::uint32_t* index,
                  std::size_t count, double* out);

/// The rank of each of `count` values followed by kStep infinite ones: how many are smaller.
void rank(const double* __restrict values, std::size_t count, std::int64_t* __restrict ranks);

}  // namespace pcednet::spatial
