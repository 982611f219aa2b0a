#include "pcednet/normals/sign_votes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "pcednet/core/parallel_loops.h"
#include "pcednet/core/sort_unique.h"
#include "pcednet/core/vector_clones.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kPointsAtOnce = 1024;

[[gnu::always_inline]] inline std::int32_t vote_of(const double* p, const double* n,
                                                   const double* q, const double* m) {
  constexpr double kReflection = 1.8;
  const double x = q[0] - p[0], y = q[1] - p[1], z = q[2] - p[2];
  const double crossing =
      (x * n[0] + y * n[1] + z * n[2]) * (x * m[0] + y * m[1] + z * m[2]) / (x * x + y * y + z * z);
  const double parallel = n[0] * m[0] + n[1] * m[1] + n[2] * m[2];
  const double vote = SignVotes::kUnanimous * (parallel - kReflection * crossing);
  return static_cast<std::int32_t>(vote + std::copysign(0.5, vote));
}

constexpr std::size_t kVector = 8;  ///< doubles of the widest

/// The votes of point `i` with `others`. Fills whole vectors: up to kVector - 1 votes more.
PCEDNET_VECTOR_CLONES
void vote_in_lanes(const Vec3* points, const Vec3* normals, std::size_t i,
                   std::span<const std::uint32_t> others, std::int32_t* __restrict votes) {
  alignas(64) double q[3][SignVotes::kAtOnce], m[3][SignVotes::kAtOnce];
  const std::size_t lanes = (others.size() + kVector - 1) / kVector * kVector;
  for (std::size_t k = 0; k < lanes; ++k) {
    const std::uint32_t j = others[std::min(k, others.size() - 1)];
    for (std::size_t a = 0; a < 3; ++a) {
      q[a][k] = points[j].data()[a];
      m[a][k] = normals[j].data()[a];
    }
  }
  const double* const p = points[i].data();
  const double* const n = normals[i].data();
  const double at[3] = {p[0], p[1], p[2]}, along[3] = {n[0], n[1], n[2]};
  for (std::size_t k = 0; k < lanes; ++k) {
    const double there[3] = {q[0][k], q[1][k], q[2][k]}, its[3] = {m[0][k], m[1][k], m[2][k]};
    votes[k] = vote_of(at, along, there, its);
  }
}

/// Sums of votes between the parts of one round, as compressed rows in blocks of kPointsAtOnce;
/// both directions are there.
struct Links {
  struct Block {
    std::vector<std::size_t> first = {0};
    std::vector<std::uint32_t> target = {};
    std::vector<std::int64_t> vote = {};
  };
  std::size_t rows = 0;
  std::vector<Block> blocks = {};

  bool empty() const {
    return std::all_of(blocks.begin(), blocks.end(),
                       [](const Block& block) { return block.target.empty(); });
  }
};

/// The votes of a later round, as SignVotes are those of the first.
struct PartVotes {
  const Links& links;
  std::size_t size() const { return links.rows; }
  std::size_t degree(std::size_t i) const {
    const auto first = links.blocks[i / kPointsAtOnce].first.begin() +
                       static_cast<std::ptrdiff_t>(i % kPointsAtOnce);
    return first[1] - first[0];
  }
  template <typename Visit, typename Wanted = Every>
  void visit(std::size_t i, const Visit& visit, const Wanted& wanted = {}) const {
    const Links::Block& block = links.blocks[i / kPointsAtOnce];
    for (std::size_t k = block.first[i % kPointsAtOnce]; k < block.first[i % kPointsAtOnce + 1];
         ++k) {
      if (wanted(block.target[k])) visit(block.target[k], block.vote[k]);
    }
  }
};

/// Every row's link to the target of its strongest vote (the smallest of equals).
template <typename Votes>
std::vector<Join> strongest_links(const Votes& votes, const Progress* progress) {
  std::vector<Join> strongest(votes.size());
  parallel_blocks(votes.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    throw_if_cancelled(progress);
    for (std::size_t i = begin; i < end; ++i) {
      std::int64_t best = 0, size = -1;
      auto to = static_cast<std::uint32_t>(i);
      votes.visit(i, [&](std::uint32_t target, std::int64_t vote) {
        const std::int64_t its_size = std::abs(vote);
        // Branch-free: the strongest is unpredictable.
        const bool better = (its_size > size) | ((its_size == size) & (target < to));
        best = better ? vote : best;
        size = better ? its_size : size;
        to = better ? target : to;
      });
      strongest[i] = {to, static_cast<std::int8_t>(best >= 0 ? 1 : -1)};
    }
  });
  return strongest;
}

/// The rows that belong to each part, in any order.
struct Members {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> member;
};

Members members_of_parts(const Signs& joined) {
  const std::vector<std::uint32_t>& part = joined.part;
  const auto take = [](std::size_t& counter) {
    return std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed);
  };
  Members members;
  members.first.assign(joined.parts + 1, 0);
  parallel_for_each(part.size(), [&](std::size_t i) { take(members.first[part[i] + 1]); });
  std::partial_sum(members.first.begin(), members.first.end(), members.first.begin());
  members.member.resize(part.size());
  std::vector<std::size_t> next(members.first.begin(), members.first.end() - 1);
  parallel_for_each(part.size(), [&](std::size_t i) {
    members.member[take(next[part[i]])] = static_cast<std::uint32_t>(i);
  });
  return members;
}

/// Sums up the votes of a part by their targets, in a hash table of places in the block's lists.
class RowSums {
 public:
  explicit RowSums(Links::Block& block) : block_(block) {}

  /// Begins a row of at most `most` votes.
  void start(std::size_t most) {
    const std::size_t size = std::bit_ceil(2 * most + 1);
    places_.assign(size, kNoPoint);
    shift_ = 64 - std::countr_zero(size);
  }

  void add(std::uint32_t target, std::int64_t vote) {
    const std::size_t mask = places_.size() - 1;
    for (std::size_t h = target * 0x9e3779b97f4a7c15u >> shift_;; h = (h + 1) & mask) {
      if (places_[h] == kNoPoint) {
        places_[h] = static_cast<std::uint32_t>(block_.target.size());
        block_.target.push_back(target);
        block_.vote.push_back(vote);
        return;
      }
      if (block_.target[places_[h]] == target) {
        block_.vote[places_[h]] += vote;
        return;
      }
    }
  }

  void finish() { block_.first.push_back(block_.target.size()); }

 private:
  Links::Block& block_;
  std::vector<std::uint32_t> places_;
  int shift_ = 0;
};

/// The sums of votes between the parts.
template <typename Votes>
Links links_between_parts(const Votes& votes, const Signs& joined, const Progress* progress) {
  const Members members = members_of_parts(joined);
  Links links = {.rows = joined.parts};
  links.blocks.resize((joined.parts + kPointsAtOnce - 1) / kPointsAtOnce);
  parallel_blocks(joined.parts, kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    throw_if_cancelled(progress);
    RowSums sums(links.blocks[begin / kPointsAtOnce]);
    for (std::size_t part = begin; part < end; ++part) {
      const auto of_part =
          std::span(members.member)
              .subspan(members.first[part], members.first[part + 1] - members.first[part]);
      std::size_t most = 0;
      for (const std::uint32_t i : of_part) most += votes.degree(i);
      sums.start(most);
      for (const std::uint32_t i : of_part) {
        const auto elsewhere = [&](std::uint32_t j) { return joined.part[j] != part; };
        const auto add = [&](std::uint32_t j, std::int64_t vote) {
          sums.add(joined.part[j], vote * joined.sign[i] * joined.sign[j]);
        };
        votes.visit(i, add, elsewhere);
      }
      sums.finish();
    }
  });
  return links;
}

}  // namespace

void SignVotes::cast(std::size_t point, std::span<const std::uint32_t> others,
                     std::array<std::int32_t, kAtOnce>& votes) const {
  static_assert(kAtOnce % kVector == 0);
  vote_in_lanes(points_.data(), normals_.data(), point, others, votes.data());
  for (std::size_t k = 0; k < others.size(); ++k) {
    const bool may_be_none = votes[k] == 0;
    if (may_be_none && (normals_[point].isZero(0.0) || normals_[others[k]].isZero(0.0))) {
      votes[k] = kNone;
    }
  }
}

Signs contract(const SignVotes& votes, const Progress* progress) {
  std::vector<Signs> rounds = {follow_joins(strongest_links(votes, progress))};
  Links links = links_between_parts(votes, rounds.back(), progress);
  while (!links.empty()) {
    rounds.push_back(follow_joins(strongest_links(PartVotes{links}, progress)));
    links = links_between_parts(PartVotes{links}, rounds.back(), progress);
  }
  for (std::size_t k = rounds.size() - 1; k > 0; --k) join_again(rounds[k - 1], rounds[k]);
  return std::move(rounds.front());
}

void turn_outvoted_points(const SignVotes& votes, std::vector<std::int8_t>& sign) {
  const auto outvoted = [&](std::size_t i) {
    std::int64_t sum = 0;
    votes.visit(i, [&](std::uint32_t j, std::int64_t vote) { sum += vote * sign[j]; });
    return sum * sign[i] < 0;
  };
  std::vector<std::uint8_t> flagged(sign.size());
  parallel_blocks(sign.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) flagged[i] = outvoted(i);
  });
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t i = 0; i < sign.size(); ++i) {
    if (flagged[i]) waiting.push_back(i);
  }
  // Each flip raises the sum of all agreeing votes, a bounded whole number, so this terminates. The
  // limit on rounds bounds the cost of rare long chains.
  for (int round = 0; round < 20 && !waiting.empty(); ++round) {
    std::vector<std::uint32_t> touched;
    for (const std::uint32_t i : waiting) {
      if (!outvoted(i)) continue;
      sign[i] = static_cast<std::int8_t>(-sign[i]);
      for (const auto& row : votes.links().of(i)) {
        touched.insert(touched.end(), row.begin(), row.end());
      }
    }
    sort_unique(touched);
    waiting = std::move(touched);
  }
}

}  // namespace pcednet::normals
