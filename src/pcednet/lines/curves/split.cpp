#include "pcednet/lines/curves/split.h"

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
constexpr double kSure = 0.8;             ///< of a cost: fits to a sample of the nodes vary
constexpr std::size_t kNodesAtOnce = 64;  ///< between two looks at the progress

double cost_of(const Fit& fit, std::size_t count, double tolerance) {
  const double price = fit.kind == CurveKind::kSegment ? kSegmentPrice : kArcPrice;
  const double sq = std::pow(fit.error / tolerance, 2);
  return price + static_cast<double>(count) * std::min(sq, kMostSqDeviation);
}

/// The runs of least cost up to one node after the other.
class Splitter {
 public:
  Splitter(std::span<const ChainNode> nodes, double tolerance)
      : nodes_(nodes), tolerance_(tolerance), best_(nodes.size() + 1) {
    best_[0].cost = 0.0;
  }

  /// The best last run up to `end`; those up to every node before are known.
  void advance_to(std::size_t end);
  std::vector<Run> runs() const;

 private:
  struct Best {
    double cost = std::numeric_limits<double>::infinity();
    std::size_t from = 0;
    Fit fit = {};
  };

  /// A node at which the last run may begin. More nodes do not bring a segment or an arc nearer to
  /// the others, so that the last cost that was computed is a bound: few runs need a fit.
  struct Start {
    std::size_t at;
    double segment = kSegmentPrice, arc = kArcPrice;  ///< least costs
  };

  void consider(Start& start, std::size_t end);
  bool may_win(double cost, std::size_t end) const { return cost <= best_[end].cost; }
  void offer(std::size_t end, double cost, std::size_t from, const Fit& fit);
  double bound(const Start& start, std::size_t end) const;

  std::span<const ChainNode> nodes_;
  double tolerance_;
  std::vector<Best> best_;     ///< up to each node
  std::vector<Start> starts_;  ///< in order
};

double free_cost(std::size_t count) {
  return kFreePrice + kFreeNodePrice * static_cast<double>(count);
}

/// Takes the cheaper of two ways to an end: of equal ones, that with the longer last run.
void Splitter::offer(std::size_t end, double cost, std::size_t from, const Fit& fit) {
  Best& best = best_[end];
  if (cost < best.cost || (cost == best.cost && from < best.from)) best = {cost, from, fit};
}

void Splitter::consider(Start& start, std::size_t end) {
  const std::size_t count = end - start.at;
  const double before = best_[start.at].cost;
  const auto nodes = nodes_.subspan(start.at, count);
  offer(end, before + free_cost(count), start.at, {});
  if (count >= 2 && may_win(before + start.segment, end)) {
    const Fit segment = fit_segment(nodes);
    const double cost = cost_of(segment, count, tolerance_);
    start.segment = kSegmentPrice + kSure * (cost - kSegmentPrice);
    offer(end, before + cost, start.at, segment);
  }
  if (count >= 4 && may_win(before + start.arc, end)) {
    const Fit arc = fit_arc(nodes);
    if (arc.kind != CurveKind::kArc) return;
    const double cost = cost_of(arc, count, tolerance_);
    start.arc = kArcPrice + kSure * (cost - kArcPrice);
    offer(end, before + cost, start.at, arc);
  }
}

double Splitter::bound(const Start& start, std::size_t end) const {
  return best_[start.at].cost + std::min({free_cost(end - start.at), start.segment, start.arc});
}

void Splitter::advance_to(std::size_t end) {
  starts_.push_back({end - 1});
  // The start that was the best is likely to stay it: its cost spares the others their fits.
  const std::size_t last = best_[end - 1].from;
  const auto likely =
      std::lower_bound(starts_.begin(), starts_.end(), last,
                       [](const Start& start, std::size_t node) { return start.at < node; });
  if (likely != starts_.end()) consider(*likely, end);
  for (auto start = starts_.begin(); start != starts_.end(); ++start) {
    if (start != likely) consider(*start, end);
  }
  // A start that is worse now by more than a run costs is never the best again.
  const double most = best_[end].cost + kArcPrice;
  std::erase_if(starts_, [&](const Start& start) {
    return bound(start, end) > most || end - start.at >= kLongestRun;
  });
}

std::vector<Run> Splitter::runs() const {
  std::vector<Run> runs;
  for (std::size_t end = nodes_.size(); end > 0; end = best_[end].from) {
    runs.push_back({best_[end].from, end, best_[end].fit});
  }
  std::reverse(runs.begin(), runs.end());
  return runs;
}

std::vector<Run> split_open(std::span<const ChainNode> nodes, double tolerance,
                            const Progress* progress) {
  Splitter splitter(nodes, tolerance);
  for (std::size_t end = 1; end <= nodes.size(); ++end) {
    if (end % kNodesAtOnce == 1) throw_if_cancelled(progress);
    splitter.advance_to(end);
  }
  return splitter.runs();
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

std::vector<Run> split_closed(const std::vector<ChainNode>& nodes, double tolerance,
                              const Progress* progress) {
  const Fit circle = fit_arc(nodes);
  const double mean_sq = std::pow(circle.error / tolerance, 2);
  if (circle.kind == CurveKind::kArc && mean_sq < 2.0) return {{0, nodes.size(), circle}};
  const std::size_t start = sharpest_bend(nodes);
  std::vector<ChainNode> opened(nodes.begin() + static_cast<std::ptrdiff_t>(start), nodes.end());
  opened.insert(opened.end(), nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(start));
  std::vector<Run> runs = split_open(opened, tolerance, progress);
  for (Run& run : runs) {
    run.first += start;
    run.last += start;
  }
  return runs;
}

}  // namespace

std::vector<Run> split(const Chain& chain, double tolerance, const Progress* progress) {
  if (chain.nodes.empty()) return {};
  return chain.closed ? split_closed(chain.nodes, tolerance, progress)
                      : split_open(chain.nodes, tolerance, progress);
}

}  // namespace pcednet::lines
