#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/unset_array.h"
#include "pcednet/core/vec3.h"
#include "pcednet/normals/joined_parts.h"
#include "pcednet/normals/neighbour_graph.h"

namespace pcednet::normals {

/// The votes of linked points for equal signs of their normals, see orient.h. Functions that take a
/// `progress` throw Error(kCancelled) when it asks to cancel.
class SignVotes {
 public:
  static constexpr double kUnanimous = 1 << 20;
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::min();

  /// A unit normal (or zero) for each point; `links` must outlive the votes.
  SignVotes(std::span<const Vec3> points, std::span<const Vec3> normals, const Adjacency& links,
            const Progress* progress = nullptr);

  const Adjacency& links() const { return *links_; }

  /// The votes with links().of(point): negative for opposite signs, kNone if a normal is zero.
  /// Whole numbers of magnitude at most kUnanimous * 2.8, so sums of votes do not depend on their
  /// order.
  std::span<const std::int32_t> of(std::size_t point) const {
    return {votes_.data() + links_->first[point], links_->of(point).size()};
  }

 private:
  const Adjacency* links_;
  UnsetArray<std::int32_t> votes_;
};

/// Contracts the graph along the strongest sums of votes (Boruvka's rounds). Points with a zero
/// normal form parts of their own.
Signs contract(const SignVotes& votes, const Progress* progress = nullptr);

/// Flips single points as long as their neighbours outvote them.
void turn_outvoted_points(const SignVotes& votes, std::vector<std::int8_t>& sign);

}  // namespace pcednet::normals
