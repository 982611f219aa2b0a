#pragma once

#include <cstdint>
#include <vector>

#include "pcednet/normals/joined_parts.h"
#include "pcednet/normals/sign_votes.h"

namespace pcednet::normals {

/// A vote of two parts for equal signs, negative for opposite ones.
struct PartVote {
  std::uint32_t part, other;
  std::int64_t vote;
};

/// What the sides say on which two patches of surface lie of each other, of those whose links do
/// not agree: at an edge sharper than a right angle, and through a wall.
///
/// With outward normals each of two faces lies below the other at a convex edge, above it at a
/// concave one. A pair of points shows that only if both are equally far from an edge of less than
/// a right angle; most pairs there vote like those of a smooth sheet. The mean over the links of
/// two patches a, b shows it on either:
///
///     s_a = mean e.n_i,   s_b = mean -e.n_j,   v = 4 (s_a s_b - +(2.2 q)^2) per link
///
/// where e is the direction from point i of a to point j of b, and the last term takes as much from
/// the magnitude, to 0 at most. Noise has no mean, but patches of a noisy sheet lie in layers; q,
/// the median of |e.n| over all links, is what they differ by.
///
/// Patches beside each other at a step of one surface are on such sides of each other, too. The
/// sides of a wedge face each other: the mean e has the length of s_a and s_b but for the cosine of
/// half the angle between the faces. There is no vote where s_a or s_b is less than 0.9 (1 + |c|)/2
/// times that length, c the mean n_i.n_j, or below 16 links.
///
/// Only links of points with a vote across parts of less than 0.7 count. The result
/// has both orders of every pair, by part, and is the same for any number of threads.
std::vector<PartVote> votes_of_sides(const SignVotes& votes, const Signs& joined);

}  // namespace pcednet::normals
