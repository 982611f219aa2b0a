#include "pcednet/normals/side_votes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "pcednet/core/median.h"
#include "pcednet/core/parallel_loops.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kPartsAtOnce = 256;
constexpr std::int32_t kWeakVote = static_cast<std::int32_t>(SignVotes::kUnanimous * 0.7);

std::int64_t whole(double value) {
  return std::llround(SignVotes::kUnanimous * value);
}

/// The links between two patches, in whole numbers, whose sums do not depend on their order.
struct SideSums {
  std::uint32_t other = 0;
  std::int64_t links = 0, parallel = 0, here = 0, there = 0;
  std::array<std::int64_t, 3> way = {};

  void add(const Vec3& from, const Vec3& normal, const Vec3& to, const Vec3& other_normal) {
    const Vec3 e = (to - from).normalized();
    ++links;
    parallel += whole(normal.dot(other_normal));
    here += whole(e.dot(normal));
    there -= whole(e.dot(other_normal));
    for (int a = 0; a < 3; ++a) way[static_cast<std::size_t>(a)] += whole(e[a]);
  }

  /// The vote of the sides, `noise` as q in the header.
  std::int64_t vote(double noise) const {
    constexpr std::int64_t kLeastLinks = 16;
    constexpr double kFacing = 0.9, kNoise = 2.2, kWeight = 4.0;
    if (links < kLeastLinks) return 0;
    const double unit = SignVotes::kUnanimous * static_cast<double>(links);
    const double on_here = static_cast<double>(here) / unit;
    const double on_there = static_cast<double>(there) / unit;
    const double alike = std::abs(static_cast<double>(parallel)) / unit;
    const double x = static_cast<double>(way[0]) / unit, y = static_cast<double>(way[1]) / unit,
                 z = static_cast<double>(way[2]) / unit;
    const double least = kFacing * 0.5 * (1.0 + alike) * std::sqrt(x * x + y * y + z * z);
    if (std::abs(on_here) < least || std::abs(on_there) < least) return 0;
    const double product = on_here * on_there;
    const double beyond = std::abs(product) - (kNoise * noise) * (kNoise * noise);
    return beyond > 0.0 ? std::llround(std::copysign(kWeight * unit * beyond, product)) : 0;
  }
};

/// The median over some points of the median |e.n| of their links: how far links leave the surface.
double distance_from_surface(const SignVotes& votes) {
  const std::size_t points = votes.points().size(), some = std::min<std::size_t>(points, 2000);
  std::vector<double> of_points(some, 0.0);
  parallel_for_each(some, [&](std::size_t k) {
    const std::size_t i = k * points / some;
    std::vector<double> sines;
    for (const std::uint32_t j : votes.links().of(i)) {
      const Vec3 e = (votes.points()[j] - votes.points()[i]).normalized();
      sines.push_back(std::abs(e.dot(votes.normals()[i])));
    }
    if (!sines.empty()) of_points[k] = upper_median(sines);
  });
  return of_points.empty() ? 0.0 : upper_median(of_points);
}

/// Whether a vote of the point with one of another part is weak.
bool is_contested(const SignVotes& votes, const Signs& joined, std::size_t i) {
  const auto row = votes.links().of(i);
  const auto of_row = votes.of(i);
  for (std::size_t k = 0; k < row.size(); ++k) {
    // kNone is less than -kWeakVote.
    const bool weak = (of_row[k] < kWeakVote) & (of_row[k] > -kWeakVote);
    if (weak && joined.part[row[k]] != joined.part[i]) return true;
  }
  return false;
}

/// The contested points, by part.
struct ContestedPoints {
  std::vector<std::uint8_t> is_one;
  std::vector<std::size_t> first;  ///< per part, and the end
  std::vector<std::uint32_t> point;
};

ContestedPoints contested_points(const SignVotes& votes, const Signs& joined) {
  ContestedPoints contested;
  contested.is_one.resize(joined.part.size());
  parallel_for_each(joined.part.size(),
                    [&](std::size_t i) { contested.is_one[i] = is_contested(votes, joined, i); });
  std::vector<std::uint32_t> in_order;
  for (std::uint32_t i = 0; i < joined.part.size(); ++i) {
    if (contested.is_one[i]) in_order.push_back(i);
  }
  contested.first.assign(joined.parts + 1, 0);
  for (const std::uint32_t i : in_order) ++contested.first[joined.part[i] + 1];
  std::partial_sum(contested.first.begin(), contested.first.end(), contested.first.begin());
  std::vector<std::size_t> next(contested.first.begin(), contested.first.end() - 1);
  contested.point.resize(in_order.size());
  for (const std::uint32_t i : in_order) contested.point[next[joined.part[i]]++] = i;
  return contested;
}

/// The sums of one part with each other part.
void sum_sides(const SignVotes& votes, const Signs& joined, const ContestedPoints& contested,
               std::size_t part, std::vector<SideSums>& sums) {
  sums.clear();
  for (std::size_t at = contested.first[part]; at < contested.first[part + 1]; ++at) {
    const std::uint32_t i = contested.point[at];
    const auto row = votes.links().of(i);
    for (std::size_t k = 0; k < row.size(); ++k) {
      const std::uint32_t j = row[k], other = joined.part[j];
      if (other == part || !contested.is_one[j] || votes.of(i)[k] == SignVotes::kNone) continue;
      auto found = std::find_if(sums.begin(), sums.end(),
                                [&](const SideSums& sum) { return sum.other == other; });
      if (found == sums.end()) found = sums.insert(found, SideSums{.other = other});
      found->add(votes.points()[i], joined.sign[i] * votes.normals()[i], votes.points()[j],
                 joined.sign[j] * votes.normals()[j]);
    }
  }
}

}  // namespace

std::vector<PartVote> votes_of_sides(const SignVotes& votes, const Signs& joined) {
  const ContestedPoints contested = contested_points(votes, joined);
  if (contested.point.empty()) return {};
  const double noise = distance_from_surface(votes);
  std::vector<std::vector<PartVote>> of_blocks((joined.parts + kPartsAtOnce - 1) / kPartsAtOnce);
  parallel_blocks(joined.parts, kPartsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<SideSums> sums;
    for (std::size_t part = begin; part < end; ++part) {
      sum_sides(votes, joined, contested, part, sums);
      for (const SideSums& sum : sums) {
        const std::int64_t vote = sum.vote(noise);
        if (vote == 0) continue;
        of_blocks[begin / kPartsAtOnce].push_back(
            {static_cast<std::uint32_t>(part), sum.other, vote});
      }
    }
  });
  std::vector<PartVote> all;
  for (const auto& some : of_blocks) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace pcednet::normals
