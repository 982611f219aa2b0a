#include "pcednet/lines/split.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pcednet::lines {
namespace {

constexpr double kSegmentPrice = 12.0;
constexpr double kArcPrice = 18.0;
constexpr double kFreePrice = 4.0, kFreeNodePrice = 5.0;
constexpr double kMostSqDeviation = 9.0;
constexpr std::size_t kLongestRun = 600;  ///< nodes; longer edges are joined afterwards

double price_of(CurveKind kind) {
  return kind == CurveKind::kSegment ? kSegmentPrice : kArcPrice;
}

double cost_of(const Fit& fit, std::span<const ChainNode> nodes, double tolerance) {
  const auto count = static_cast<double>(nodes.size());
  const double sq = std::pow(fit.error / tolerance, 2);
  return price_of(fit.kind) + count * std::min(sq, kMostSqDeviation);
}

struct Priced {
  Fit fit;
  double cost;
};

Priced cheapest(std::span<const ChainNode> nodes, double tolerance) {
  const auto count = static_cast<double>(nodes.size());
  Priced best{{}, kFreePrice + kFreeNodePrice * count};
  if (nodes.size() < 2) return best;
  const Fit segment = fit_segment(nodes);
  const double cost = cost_of(segment, nodes, tolerance);
  if (cost < best.cost) best = {segment, cost};
  if (nodes.size() < 4 || cost <= kArcPrice) return best;
  const Fit arc = fit_arc(nodes);
  if (arc.kind != CurveKind::kArc) return best;
  const double arc_cost = cost_of(arc, nodes, tolerance);
  if (arc_cost < best.cost) best = {arc, arc_cost};
  return best;
}

std::vector<Run> split_open(std::span<const ChainNode> nodes, double tolerance) {
  struct Best {
    double cost;
    std::size_t from;
    Fit fit;
  };
  std::vector<Best> best(nodes.size() + 1, {std::numeric_limits<double>::infinity(), 0, {}});
  best[0].cost = 0.0;
  std::vector<std::size_t> starts;  // that may still be the best
  for (std::size_t end = 1; end <= nodes.size(); ++end) {
    starts.push_back(end - 1);
    std::vector<double> costs(starts.size());
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const std::size_t start = starts[i];
      const Priced run = cheapest(nodes.subspan(start, end - start), tolerance);
      costs[i] = best[start].cost + run.cost;
      if (costs[i] < best[end].cost) best[end] = {costs[i], start, run.fit};
    }
    // A start that is worse now by more than a run costs is never the best again.
    std::size_t kept = 0;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      if (costs[i] <= best[end].cost + kArcPrice && end - starts[i] < kLongestRun) {
        starts[kept++] = starts[i];
      }
    }
    starts.resize(kept);
  }
  std::vector<Run> runs;
  for (std::size_t end = nodes.size(); end > 0; end = best[end].from) {
    runs.push_back({best[end].from, end, best[end].fit});
  }
  std::reverse(runs.begin(), runs.end());
  return runs;
}

/// The node at which a closed chain bends most.
std::size_t sharpest_bend(const std::vector<ChainNode>& nodes) {
  constexpr std::size_t kAside = 2;
  const std::size_t count = nodes.size();
  std::size_t best = 0;
  double least = 2.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 before = nodes[i].at - nodes[(i + count - kAside) % count].at;
    const Vec3 after = nodes[(i + kAside) % count].at - nodes[i].at;
    const double cosine = before.normalized().dot(after.normalized());
    if (cosine < least) {
      least = cosine;
      best = i;
    }
  }
  return best;
}

std::vector<Run> split_closed(const std::vector<ChainNode>& nodes, double tolerance) {
  const Fit circle = fit_arc(nodes);
  const double mean_sq = std::pow(circle.error / tolerance, 2);
  if (circle.kind == CurveKind::kArc && mean_sq < 2.0) return {{0, nodes.size(), circle}};
  const std::size_t start = sharpest_bend(nodes);
  std::vector<ChainNode> opened(nodes.begin() + static_cast<std::ptrdiff_t>(start), nodes.end());
  opened.insert(opened.end(), nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(start));
  std::vector<Run> runs = split_open(opened, tolerance);
  for (Run& run : runs) {
    run.first += start;
    run.last += start;
  }
  return runs;
}

}  // namespace

std::vector<Run> split(const Chain& chain, double tolerance) {
  if (chain.nodes.empty()) return {};
  return chain.closed ? split_closed(chain.nodes, tolerance) : split_open(chain.nodes, tolerance);
}

}  // namespace pcednet::lines
