#include "pcednet/lines/curves/chain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

#include "pcednet/core/half_space.h"
#include "pcednet/core/parallel.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kCreasesAtOnce = 512;
constexpr std::size_t kStepsAtOnce = 64;  ///< between two looks at the progress
constexpr double kSameDirection = 0.78;   ///< cosine of creases that continue each other
constexpr double kSameWedge = 0.76;       ///< cosine of their sides

/// Creases ahead may be that far aside, in their distance: beside the last node, beyond a gap.
constexpr double kCone = 0.4, kNarrowCone = 0.08;

// In spacings.
constexpr double kBeside = 1.5;
constexpr double kReach = 2.6;
constexpr double kLeastStep = 0.25;
constexpr double kNodeLength = 0.9;
constexpr std::size_t kLeastLoop = 5;  ///< nodes

std::vector<Vec3> places_of(std::span<const Crease> creases) {
  std::vector<Vec3> places;
  places.reserve(creases.size());
  for (const Crease& crease : creases) places.push_back(crease.at);
  return places;
}

/// Whether two creases, or a node and a crease, continue each other.
template <typename A, typename B>
bool continues(const A& a, const B& b) {
  return std::abs(a.along.dot(b.along)) > kSameDirection &&
         match(a.side_a, a.side_b, b.side_a, b.side_b).cosine > kSameWedge;
}

/// Follows creases from one to the next and takes them on the way.
class Tracer {
 public:
  Tracer(std::span<const Crease> creases, double gap, double noise, Stage& stage)
      : creases_(creases),
        tree_(places_of(creases)),
        taken_(creases.size(), 0),
        gap_(gap),
        noise_(noise),
        stage_(stage) {}

  std::vector<std::size_t> densest_first();
  Chain trace_from(std::size_t crease);
  bool is_taken(std::size_t crease) const { return taken_[crease] != 0; }

 private:
  /// A crease ahead of a node.
  struct Ahead {
    std::uint32_t index;
    double distance, sq_distance;  ///< along the node's direction, and the square of the whole
  };
  /// Distances along a node's direction.
  struct Stretch {
    double from, to;
  };

  std::optional<ChainNode> next(const ChainNode& node);
  std::optional<ChainNode> next_beside(const ChainNode& node);
  std::optional<ChainNode> next_beyond_gap(const ChainNode& node);
  /// Those of the creases found that continue the node, in the stretch of its cone.
  void add_ahead(const ChainNode& node, const Stretch& stretch, double cone);
  double nearest_ahead() const;
  std::optional<ChainNode> mean_of_nearest(const ChainNode& node);
  void take_beside(const ChainNode& node);
  bool closes(const ChainNode& last, const ChainNode& first) const;
  void extend(std::vector<ChainNode>& nodes, bool& closed);

  std::span<const Crease> creases_;
  spatial::KdTree tree_;
  std::vector<std::uint8_t> taken_;
  double gap_, noise_;
  Stage& stage_;
  std::size_t steps_ = 0;
  std::vector<spatial::Neighbour> found_;
  std::vector<Ahead> ahead_;
};

std::vector<std::size_t> Tracer::densest_first() {
  std::vector<std::uint32_t> beside(creases_.size());
  parallel_blocks(creases_.size(), kCreasesAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> found;
    for (std::size_t i = begin; i < end; ++i) {
      tree_.within_unsorted(creases_[i].at, kBeside * creases_[i].spacing, found);
      beside[i] = static_cast<std::uint32_t>(std::count_if(
          found.begin(), found.end(),
          [&](const auto& near) { return continues(creases_[i], creases_[near.index]); }));
    }
    stage_.advance(end - begin);
  });
  std::vector<std::size_t> order(creases_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return beside[a] > beside[b]; });
  return order;
}

/// The mean of creases, turned as `node` is.
ChainNode mean_of(std::span<const Crease> creases, std::span<const std::uint32_t> members,
                  const ChainNode& node) {
  ChainNode mean{
      .at = Vec3::Zero(), .along = Vec3::Zero(), .side_a = Vec3::Zero(), .side_b = Vec3::Zero()};
  const double count = static_cast<double>(members.size());
  double probability = 0.0;  // of all
  for (const std::uint32_t member : members) {
    const Crease& crease = creases[member];
    mean.at += crease.at / count;
    mean.along += turned_to(crease.along, node.along);
    const bool crossed = match(node.side_a, node.side_b, crease.side_a, crease.side_b).crossed;
    mean.side_a += crossed ? crease.side_b : crease.side_a;
    mean.side_b += crossed ? crease.side_a : crease.side_b;
    mean.spacing += crease.spacing / count;
    probability += crease.probability / count;
    if (crease.edge_class != kNonEdge) {
      mean.edge_points += 1.0;
      mean.probability += crease.probability;
    }
    mean.bend += crease.bend / count;
    mean.rounded += (crease.rounded ? 1.0 : 0.0) / count;
    mean.sharp += (crease.edge_class == kSharpEdge ? 1.0 : 0.0) / count;
    mean.boundary += (crease.edge_class == kBoundary ? 1.0 : 0.0) / count;
  }
  mean.probability = mean.edge_points > 0.0 ? mean.probability / mean.edge_points : probability;
  mean.along.normalize();
  mean.side_a.normalize();
  mean.side_b.normalize();
  return mean;
}

void Tracer::add_ahead(const ChainNode& node, const Stretch& stretch, double cone) {
  for (const auto& near : found_) {
    if (taken_[near.index] || !continues(node, creases_[near.index])) continue;
    const Vec3 offset = creases_[near.index].at - node.at;
    const double distance = offset.dot(node.along);
    const double aside = (offset - distance * node.along).norm();
    if (distance < stretch.from || distance >= stretch.to) continue;
    if (aside > cone * distance + (0.35 + noise_) * node.spacing) continue;
    ahead_.push_back({near.index, distance, offset.squaredNorm()});
  }
}

std::optional<ChainNode> Tracer::mean_of_nearest(const ChainNode& node) {
  if (ahead_.empty()) return std::nullopt;
  const double most = nearest_ahead() + kNodeLength * node.spacing;
  // Sums depend on the order, which must not depend on how the creases were found.
  std::sort(ahead_.begin(), ahead_.end(), [&](const Ahead& a, const Ahead& b) {
    const Vec3 &at_a = creases_[a.index].at, &at_b = creases_[b.index].at;
    return std::tuple(a.sq_distance, at_a.x(), at_a.y(), at_a.z(), a.index) <
           std::tuple(b.sq_distance, at_b.x(), at_b.y(), at_b.z(), b.index);
  });
  std::vector<std::uint32_t> members;
  for (const Ahead& crease : ahead_) {
    if (crease.distance <= most) members.push_back(crease.index);
  }
  return mean_of(creases_, members, node);
}

double Tracer::nearest_ahead() const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Ahead& crease : ahead_) nearest = std::min(nearest, crease.distance);
  return nearest;
}

std::optional<ChainNode> Tracer::next_beside(const ChainNode& node) {
  ahead_.clear();
  tree_.within_unsorted(node.at, kReach * node.spacing, found_);
  add_ahead(node, {kLeastStep * node.spacing, std::numeric_limits<double>::infinity()}, kCone);
  return mean_of_nearest(node);
}

std::optional<ChainNode> Tracer::next_beyond_gap(const ChainNode& node) {
  ahead_.clear();
  const double aside = (0.35 + noise_) * node.spacing;
  Stretch stretch{kLeastStep * node.spacing, 0.0};
  while (stretch.from < gap_ && stretch.from <= nearest_ahead() + kNodeLength * node.spacing) {
    // A ball around as much of the cone as it is wide: one around the node that reaches over a
    // wide gap would hold much of the cloud.
    const double length = std::max(2.0 * (kNarrowCone * stretch.from + aside), node.spacing);
    stretch.to = stretch.from + length;
    const double width = kNarrowCone * stretch.to + aside;
    tree_.within_unsorted(node.at + (stretch.from + 0.5 * length) * node.along,
                          1.01 * std::hypot(0.5 * length, width), found_);
    add_ahead(node, stretch, kNarrowCone);
    std::erase_if(ahead_, [&](const Ahead& crease) { return crease.sq_distance >= gap_ * gap_; });
    stretch.from = stretch.to;
  }
  return mean_of_nearest(node);
}

std::optional<ChainNode> Tracer::next(const ChainNode& node) {
  if (++steps_ % kStepsAtOnce == 0) stage_.advance(0);
  if (auto near = next_beside(node)) return near;
  if (gap_ <= kReach * node.spacing) return std::nullopt;
  return next_beyond_gap(node);
}

void Tracer::take_beside(const ChainNode& node) {
  tree_.within_unsorted(node.at, (1.1 + noise_) * node.spacing, found_);
  for (const auto& near : found_) {
    if (continues(node, creases_[near.index])) taken_[near.index] = 1;
  }
}

bool Tracer::closes(const ChainNode& last, const ChainNode& first) const {
  const Vec3 offset = first.at - last.at;
  const double distance = offset.dot(last.along);
  return distance > 0.0 && distance < kReach * last.spacing &&
         (offset - distance * last.along).norm() <
             kCone * distance + (0.35 + noise_) * last.spacing &&
         last.along.dot(first.along) > kSameDirection &&
         match(last.side_a, last.side_b, first.side_a, first.side_b).cosine > kSameWedge;
}

void Tracer::extend(std::vector<ChainNode>& nodes, bool& closed) {
  while (auto node = next(nodes.back())) {
    // The chord says more about the direction than creases at corners do.
    const Vec3 chord = (node->at - nodes.back().at).normalized();
    node->along = (node->along + 0.5 * chord).normalized();
    take_beside(*node);
    nodes.push_back(*node);
    if (nodes.size() >= kLeastLoop && closes(nodes.back(), nodes.front())) {
      closed = true;
      return;
    }
  }
}

Chain Tracer::trace_from(std::size_t crease) {
  const Crease& seed = creases_[crease];
  const auto member = static_cast<std::uint32_t>(crease);
  const ChainNode turned{
      .at = seed.at, .along = seed.along, .side_a = seed.side_a, .side_b = seed.side_b};
  const ChainNode first = mean_of(creases_, {&member, 1}, turned);
  Chain chain{.nodes = {first}};
  taken_[crease] = 1;
  take_beside(first);
  extend(chain.nodes, chain.closed);
  if (chain.closed) return chain;
  std::reverse(chain.nodes.begin(), chain.nodes.end());
  for (ChainNode& node : chain.nodes) node.along = -node.along;
  extend(chain.nodes, chain.closed);
  return chain;
}

}  // namespace

WedgeMatch match(const Vec3& side_a, const Vec3& side_b, const Vec3& other_a, const Vec3& other_b) {
  const double straight = std::min(side_a.dot(other_a), side_b.dot(other_b));
  const double crossed = std::min(side_a.dot(other_b), side_b.dot(other_a));
  return straight >= crossed ? WedgeMatch{straight, false} : WedgeMatch{crossed, true};
}

std::vector<Crease> smoothed(std::span<const Crease> creases, double reach, Stage& stage) {
  if (creases.empty()) return {};
  const spatial::KdTree tree(places_of(creases));
  std::vector<Crease> result(creases.begin(), creases.end());
  parallel_blocks(creases.size(), kCreasesAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> found;
    std::vector<std::uint32_t> members;
    for (std::size_t i = begin; i < end; ++i) {
      const Crease& crease = creases[i];
      tree.within(crease.at, reach * crease.spacing, found);
      members.clear();
      for (const auto& near : found) {
        if (continues(crease, creases[near.index])) members.push_back(near.index);
      }
      const ChainNode own{
          .at = crease.at, .along = crease.along, .side_a = crease.side_a, .side_b = crease.side_b};
      const ChainNode mean = mean_of(creases, members, own);
      const Vec3 offset = mean.at - crease.at;
      result[i].at += offset - offset.dot(mean.along) * mean.along;
      result[i].along = mean.along;
      result[i].side_a = mean.side_a;
      result[i].side_b = mean.side_b;
      result[i].rounded = mean.rounded > 0.5;
    }
    stage.advance(end - begin);
  });
  return result;
}

std::vector<Chain> trace(std::span<const Crease> creases, double gap, double noise, Stage& stage) {
  if (creases.empty()) return {};
  Tracer tracer(creases, gap, noise, stage);
  std::vector<Chain> chains;
  for (const std::size_t crease : tracer.densest_first()) {
    if (!tracer.is_taken(crease)) chains.push_back(tracer.trace_from(crease));
  }
  return chains;
}

}  // namespace pcednet::lines
