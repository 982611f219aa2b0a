#include "pcednet/normals/local_counts.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "pcednet/core/parallel.h"
#include "pcednet/normals/plane_fit.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kMostDoublings = 2;
constexpr int kRounds = 2;       ///< of adding up over neighbours
constexpr float kFlat = 0.003f;  ///< thinner is not flatter

/// For each doubling the weight of those who are for it, and the weight of all.
struct Ballot {
  std::array<float, kMostDoublings> in_favour = {};
  float all = 0.0f;
};

/// Points along a line have no plane: they count as a ball, so that more are taken.
double thickness_of(const PlaneFit& plane) {
  return plane.normal.isZero(0.0) ? 1.0 : plane.thickness;
}

Ballot ballot_of(std::span<const double> thickness) {
  const float last = static_cast<float>(thickness.back()) + kFlat;
  Ballot ballot{.all = 1.0f / (last * last)};
  for (std::size_t d = 0; d + 1 < thickness.size(); ++d) {
    const double later = *std::min_element(thickness.begin() + d + 1, thickness.end());
    const bool more = later < thickness[d] || thickness[d] >= kBall;
    if (more) ballot.in_favour[d] = ballot.all;
  }
  return ballot;
}

/// Of every point; `counts` are those that it chooses from.
std::vector<Ballot> ballots(const NeighbourGraph& graph, std::span<const std::size_t> counts,
                            const Progress* progress) {
  std::vector<Ballot> ballots(graph.points.size());
  Stage stage(progress, "surroundings", ballots.size());
  parallel_blocks(ballots.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> some(end - begin);
    std::iota(some.begin(), some.end(), static_cast<std::uint32_t>(begin));
    std::vector<double> thickness(counts.size() * some.size());
    for (std::size_t c = 0; c < counts.size(); ++c) {
      const std::vector<PlaneFit> planes = fit_planes(graph, some, counts[c]);
      for (std::size_t k = 0; k < some.size(); ++k) {
        thickness[k * counts.size() + c] = thickness_of(planes[k]);
      }
    }
    for (std::size_t k = 0; k < some.size(); ++k) {
      ballots[begin + k] =
          ballot_of(std::span(thickness).subspan(k * counts.size(), counts.size()));
    }
    stage.advance(some.size());
  });
  return ballots;
}

/// Each point's ballot and those of its neighbours.
std::vector<Ballot> added_up(const NeighbourGraph& graph, const std::vector<Ballot>& ballots) {
  std::vector<Ballot> sums = ballots;
  parallel_blocks(sums.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (const std::uint32_t j : graph.of(i).first(graph.choice.neighbours)) {
        sums[i].all += ballots[j].all;
        for (std::size_t d = 0; d < kMostDoublings; ++d) {
          sums[i].in_favour[d] += ballots[j].in_favour[d];
        }
      }
    }
  });
  return sums;
}

}  // namespace

std::vector<std::uint32_t> local_counts(const NeighbourGraph& graph, const Progress* progress) {
  const NeighbourChoice& choice = graph.choice;
  std::vector<std::uint32_t> chosen(graph.points.size(),
                                    static_cast<std::uint32_t>(choice.neighbours));
  if (choice.fewest == 0 || choice.fewest >= choice.neighbours) return chosen;
  std::vector<std::size_t> counts = {choice.fewest};
  while (counts.size() <= kMostDoublings && 2 * counts.back() <= choice.neighbours) {
    counts.push_back(2 * counts.back());
  }
  std::vector<Ballot> sums = ballots(graph, counts, progress);
  for (int round = 0; round < kRounds; ++round) sums = added_up(graph, sums);
  std::transform(sums.begin(), sums.end(), chosen.begin(), [&](const Ballot& sum) {
    std::size_t c = 0;
    while (c + 1 < counts.size() && sum.in_favour[c] > 0.5f * sum.all) ++c;
    return static_cast<std::uint32_t>(counts[c]);
  });
  return chosen;
}

}  // namespace pcednet::normals
