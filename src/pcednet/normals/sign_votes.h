#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/normals/joined_parts.h"
#include "pcednet/normals/neighbour_graph.h"

namespace pcednet::normals {

/// Wants every point.
struct Every {
  bool operator()(std::uint32_t) const { return true; }
};

/// The votes of linked points for equal signs of their normals, see orient.h. They are computed
/// when they are wanted: kept, they would take more memory than all else.
class SignVotes {
 public:
  static constexpr double kUnanimous = 1 << 20;
  static constexpr std::size_t kAtOnce = 64;  ///< votes

  /// A unit normal (or zero) for each point; all must outlive the votes.
  SignVotes(std::span<const Vec3> points, std::span<const Vec3> normals, const Adjacency& links)
      : points_(points), normals_(normals), links_(&links) {}

  const Adjacency& links() const { return *links_; }
  std::size_t size() const { return links_->size(); }
  std::size_t degree(std::size_t point) const { return links_->degree(point); }

  /// Calls visit(other, vote) for every point linked with one, if wanted(other), unless a normal is
  /// zero. Votes are negative for opposite signs, and whole numbers of magnitude at most kUnanimous
  /// * 2.8, so sums of votes do not depend on their order.
  template <typename Visit, typename Wanted = Every>
  void visit(std::size_t point, const Visit& visit, const Wanted& wanted = {}) const {
    std::array<std::uint32_t, kAtOnce> others;
    std::array<std::int32_t, kAtOnce> votes;
    std::size_t count = 0;
    const auto visit_all = [&] {
      if (count == 0) return;
      cast(point, std::span(others).first(count), votes);
      for (std::size_t k = 0; k < count; ++k) {
        if (votes[k] != kNone) visit(others[k], votes[k]);
      }
      count = 0;
    };
    for (const auto& row : links_->of(point)) {
      for (const std::uint32_t other : row) {
        others[count] = other;
        count += wanted(other) ? 1 : 0;
        if (count == kAtOnce) visit_all();
      }
    }
    visit_all();
  }

 private:
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::min();

  /// The votes of a point with some others, at most kAtOnce; kNone if a normal is zero.
  void cast(std::size_t point, std::span<const std::uint32_t> others,
            std::array<std::int32_t, kAtOnce>& votes) const;

  std::span<const Vec3> points_, normals_;
  const Adjacency* links_;
};

/// Contracts the graph along the strongest sums of votes (Boruvka's rounds). Points with a zero
/// normal form parts of their own. Throws Error(kCancelled) when `progress` asks to cancel.
Signs contract(const SignVotes& votes, const Progress* progress = nullptr);

/// Flips single points as long as their neighbours outvote them.
void turn_outvoted_points(const SignVotes& votes, std::vector<std::int8_t>& sign);

}  // namespace pcednet::normals
