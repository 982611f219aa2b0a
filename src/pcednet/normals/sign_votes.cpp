#include "pcednet/normals/sign_votes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "pcednet/core/parallel.h"
#include "pcednet/core/vector_clones.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kBlock = 1024;

/// Sums of votes between the parts of one round, as compressed rows; both directions are there.
struct Links {
  std::vector<std::size_t> first = {0};
  std::vector<std::uint32_t> target;
  std::vector<std::int64_t> vote;
};

/// Sets of parts with the sign of each relative to its root.
class SignedSets {
 public:
  explicit SignedSets(std::size_t size) : parent_(size), sign_(size, 1) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  std::pair<std::uint32_t, std::int8_t> find(std::uint32_t i) {
    std::int8_t sign = 1;
    std::uint32_t root = i;
    for (; parent_[root] != root; root = parent_[root]) sign = times(sign, sign_[root]);
    std::int8_t rest = sign;
    while (parent_[i] != i) {
      const std::uint32_t next = std::exchange(parent_[i], root);
      rest = times(rest, std::exchange(sign_[i], rest));
      i = next;
    }
    return {root, sign};
  }

  /// The smaller root stays, so that a set is named by its first member.
  void join(std::uint32_t i, std::uint32_t j, bool same_sign) {
    auto [a, sign_a] = find(i);
    auto [b, sign_b] = find(j);
    if (a == b) return;
    if (a > b) std::swap(a, b);
    parent_[b] = a;
    sign_[b] = times(times(sign_a, sign_b), same_sign ? 1 : -1);
  }

 private:
  static std::int8_t times(std::int8_t a, std::int8_t b) { return static_cast<std::int8_t>(a * b); }

  std::vector<std::uint32_t> parent_;
  std::vector<std::int8_t> sign_;
};

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

/// The votes of point `i` with each of `targets`.
PCEDNET_VECTOR_CLONES
void vote_all(const Vec3* points, const Vec3* normals, std::size_t i,
              std::span<const std::uint32_t> targets, std::int32_t* votes) {
  const double *const all_points = points->data(), *const all_normals = normals->data();
  const double* const p = all_points + 3 * i;
  const double* const n = all_normals + 3 * i;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const std::size_t j = 3 * std::size_t{targets[k]};
    votes[k] = vote_of(p, n, all_points + j, all_normals + j);
  }
}

/// The links of the first round: every vote of the points.
struct PointRows {
  const SignVotes& votes;
  std::size_t size() const { return votes.links.size(); }
  template <typename Visit>
  void visit(std::size_t i, const Visit& visit) const {
    if (votes.normals[i].isZero(0.0)) return;
    const auto row = votes.links.of(i);
    thread_local std::vector<std::int32_t> of_row;
    of_row.resize(row.size());
    vote_all(votes.points.data(), votes.normals.data(), i, row, of_row.data());
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (of_row[k] != 0 || !votes.normals[row[k]].isZero(0.0)) visit(row[k], of_row[k]);
    }
  }
};

/// The links of a later round.
struct PartRows {
  const Links& links;
  std::size_t size() const { return links.first.size() - 1; }
  template <typename Visit>
  void visit(std::size_t i, const Visit& visit) const {
    for (std::size_t k = links.first[i]; k < links.first[i + 1]; ++k) {
      visit(links.target[k], links.vote[k]);
    }
  }
};

/// For every row the target of its strongest link (the smallest of equals) and whether the two
/// should have the same sign; itself if it has no link.
template <typename Rows>
std::vector<std::pair<std::uint32_t, bool>> strongest_links(const Rows& rows) {
  std::vector<std::pair<std::uint32_t, bool>> strongest(rows.size());
  parallel_blocks(rows.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::int64_t best = -1;
      strongest[i] = {static_cast<std::uint32_t>(i), true};
      rows.visit(i, [&](std::uint32_t target, std::int64_t vote) {
        if (std::abs(vote) < best || (std::abs(vote) == best && target > strongest[i].first))
          return;
        best = std::abs(vote);
        strongest[i] = {target, vote >= 0};
      });
    }
  });
  return strongest;
}

/// Joins every row with the target of its strongest link and numbers the resulting parts.
template <typename Rows>
Signs join_strongest(const Rows& rows) {
  const auto strongest = strongest_links(rows);
  SignedSets sets(rows.size());
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    sets.join(i, strongest[i].first, strongest[i].second);
  }
  Signs joined;
  joined.part.resize(rows.size());
  joined.sign.resize(rows.size());
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    const auto [root, sign] = sets.find(i);
    joined.sign[i] = sign;
    joined.part[i] = root == i ? static_cast<std::uint32_t>(joined.parts++) : joined.part[root];
  }
  return joined;
}

/// The rows that belong to each part, part after part.
struct Members {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> member;
};

Members members_of_parts(const Signs& joined) {
  Members members;
  members.first.assign(joined.parts + 1, 0);
  for (const std::uint32_t part : joined.part) ++members.first[part + 1];
  std::partial_sum(members.first.begin(), members.first.end(), members.first.begin());
  members.member.resize(joined.part.size());
  std::vector<std::size_t> next(members.first.begin(), members.first.end() - 1);
  for (std::uint32_t i = 0; i < joined.part.size(); ++i) members.member[next[joined.part[i]]++] = i;
  return members;
}

using Vote = std::pair<std::uint32_t, std::int64_t>;

void append_summed(std::vector<Vote>& votes, Links& links) {
  std::sort(votes.begin(), votes.end(),
            [](const Vote& a, const Vote& b) { return a.first < b.first; });
  for (std::size_t k = 0; k < votes.size();) {
    const std::uint32_t target = votes[k].first;
    std::int64_t sum = 0;
    for (; k < votes.size() && votes[k].first == target; ++k) sum += votes[k].second;
    links.target.push_back(target);
    links.vote.push_back(sum);
  }
  links.first.push_back(links.target.size());
}

/// The sums of votes between the parts.
template <typename Rows>
Links links_between_parts(const Rows& rows, const Signs& joined) {
  const Members members = members_of_parts(joined);
  std::vector<Links> blocks((joined.parts + kBlock - 1) / kBlock);
  parallel_blocks(joined.parts, kBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<Vote> votes;
    for (std::size_t part = begin; part < end; ++part) {
      votes.clear();
      for (std::size_t k = members.first[part]; k < members.first[part + 1]; ++k) {
        const std::uint32_t i = members.member[k];
        rows.visit(i, [&](std::uint32_t j, std::int64_t vote) {
          if (joined.part[j] == part) return;
          votes.emplace_back(joined.part[j], vote * joined.sign[i] * joined.sign[j]);
        });
      }
      append_summed(votes, blocks[begin / kBlock]);
    }
  });
  Links links;
  links.first.reserve(joined.parts + 1);
  for (Links& block : blocks) {
    const std::size_t offset = links.target.size();
    for (std::size_t k = 1; k < block.first.size(); ++k) {
      links.first.push_back(offset + block.first[k]);
    }
    links.target.insert(links.target.end(), block.target.begin(), block.target.end());
    links.vote.insert(links.vote.end(), block.vote.begin(), block.vote.end());
    block = {};
  }
  return links;
}

}  // namespace

std::int64_t SignVotes::vote(std::size_t i, std::size_t j) const {
  return vote_of(points[i].data(), normals[i].data(), points[j].data(), normals[j].data());
}

Signs contract(const SignVotes& votes) {
  Signs signs = join_strongest(PointRows{votes});
  Links links = links_between_parts(PointRows{votes}, signs);
  while (!links.target.empty()) {
    const Signs joined = join_strongest(PartRows{links});
    links = links_between_parts(PartRows{links}, joined);
    for (std::size_t i = 0; i < signs.part.size(); ++i) {
      const std::uint32_t part = signs.part[i];
      signs.sign[i] = static_cast<std::int8_t>(signs.sign[i] * joined.sign[part]);
      signs.part[i] = joined.part[part];
    }
    signs.parts = joined.parts;
  }
  return signs;
}

void turn_outvoted_points(const SignVotes& votes, std::vector<std::int8_t>& sign) {
  const auto outvoted = [&](std::size_t i) {
    std::int64_t sum = 0;
    PointRows{votes}.visit(i, [&](std::uint32_t j, std::int64_t vote) { sum += vote * sign[j]; });
    return sum * sign[i] < 0;
  };
  std::vector<std::uint8_t> flagged(sign.size());
  parallel_blocks(sign.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) flagged[i] = outvoted(i);
  });
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t i = 0; i < sign.size(); ++i) {
    if (flagged[i]) waiting.push_back(i);
  }
  // Each turn raises the sum of all agreeing votes, a bounded whole number: this ends. The bound
  // keeps the rare long chain from taking long.
  for (int round = 0; round < 20 && !waiting.empty(); ++round) {
    std::vector<std::uint32_t> touched;
    for (const std::uint32_t i : waiting) {
      if (!outvoted(i)) continue;
      sign[i] = static_cast<std::int8_t>(-sign[i]);
      const auto row = votes.links.of(i);
      touched.insert(touched.end(), row.begin(), row.end());
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    waiting = std::move(touched);
  }
}

}  // namespace pcednet::normals
