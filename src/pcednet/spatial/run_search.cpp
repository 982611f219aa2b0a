#include "pcednet/spatial/run_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "pcednet/core/rank.h"

namespace pcednet::spatial {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNone = 0xffffffff;
constexpr std::size_t kFanOut = RunTree::kFanOut;
constexpr std::size_t kRanked = 64;      // more are sorted
constexpr std::size_t kMoreAtOnce = 16;  // points of a search of the tree
constexpr int kAttempts = 3;

bool is_nearer(const Neighbour& a, const Neighbour& b) {
  return a.sq_distance < b.sq_distance || (a.sq_distance == b.sq_distance && a.index < b.index);
}

/// Sorts the many neighbours of a point, `from`, into `to`, nearest first. On a surface their
/// squared distances are spread evenly: hardly more than one is in each of as many equal steps.
void sort_by_distance(std::span<const Neighbour> from, std::vector<std::uint32_t>& ends,
                      std::vector<Neighbour>& to) {
  constexpr std::uint32_t kMostOfStep = 16;
  to.assign(from.begin(), from.end());
  double most = 0.0;
  for (const Neighbour& near : from) most = std::max(most, near.sq_distance);
  const double scale = 0.999 * static_cast<double>(from.size()) / most;
  const bool can_be = scale > 0.0 && scale < kInfinity;
  if (!can_be) return std::sort(to.begin(), to.end(), is_nearer);
  const auto step_of = [&](const Neighbour& near) {
    return static_cast<std::size_t>(near.sq_distance * scale);
  };
  ends.assign(from.size(), 0);
  for (const Neighbour& near : from) ++ends[step_of(near)];
  const bool is_even = *std::max_element(ends.begin(), ends.end()) <= kMostOfStep;
  if (!is_even) return std::sort(to.begin(), to.end(), is_nearer);
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  for (const Neighbour& near : from) to[--ends[step_of(near)]] = near;
  for (std::size_t i = 1; i < to.size(); ++i) {
    const Neighbour near = to[i];
    std::size_t place = i;
    for (; place > 0 && is_nearer(near, to[place - 1]); --place) to[place] = to[place - 1];
    to[place] = near;
  }
}

struct Box {
  double min[3], max[3];
};

Box box_of(const RunTree& tree, std::size_t run) {
  const EightBoxes& node = tree.rows.front()[run / kFanOut];
  Box box;
  for (int a = 0; a < 3; ++a) {
    box.min[a] = node.min[a][run % kFanOut];
    box.max[a] = node.max[a][run % kFanOut];
  }
  return box;
}

}  // namespace

RunSearch::RunSearch(const RunTree& tree, std::size_t count)
    : tree_(tree),
      count_(count),
      near_(std::make_unique<Candidates>()),
      picked_(Candidates::kRoom),
      sq_distances_(Candidates::kRoom + Candidates::kStep),
      ranks_(kRanked + Candidates::kStep) {}

void RunSearch::find(std::size_t run, std::span<const std::uint32_t> points, Neighbour* found) {
  open_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) open_.push_back({points[i], found + i * count_});
  sq_radius_ = guess(run);
  sq_needed_ = 0.0;
  for (int attempt = 0; attempt < kAttempts && !open_.empty(); ++attempt) {
    const bool can_be = sq_radius_ > 0.0 && sq_radius_ < kInfinity;
    if (!can_be || !gather(run)) break;
    std::erase_if(open_, [&](const Query& query) { return select(query); });
    sq_radius_ = std::max(4.0 * sq_radius_, sq_needed_);
  }
  for (const Query& query : open_) descend(query);
  sq_needed_ = 0.0;
  for (std::size_t i = 1; i <= points.size(); ++i) {
    sq_needed_ = std::max(sq_needed_, found[i * count_ - 1].sq_distance);
  }
}

/// Slightly more than the preceding run needed, if possible.
double RunSearch::guess(std::size_t run) const {
  const Box box = box_of(tree_, run);
  double sq_diagonal = 0.0;
  for (int a = 0; a < 3; ++a) {
    sq_diagonal += (box.max[a] - box.min[a]) * (box.max[a] - box.min[a]);
  }
  const double sq_before = 1.3 * sq_needed_;
  const bool can_be = sq_before > 0.01 * sq_diagonal && sq_before < 25.0 * sq_diagonal;
  return can_be ? sq_before : 0.25 * sq_diagonal;
}

/// Finds the candidates: all points within the radius of the run's box. False if they are too many.
bool RunSearch::gather(std::size_t run) {
  const Box box = box_of(tree_, run);
  const double radius = std::sqrt(sq_radius_);
  double most = 0.0;
  for (int a = 0; a < 3; ++a) {
    near_->centre[a] = 0.5 * box.min[a] + 0.5 * box.max[a];
    most = std::max(most, box.max[a] - near_->centre[a]);
  }
  near_->scale = 1.0 / (most + radius);
  for (int a = 0; a < 3; ++a) {
    near_->half[a] =
        static_cast<float>((box.max[a] - near_->centre[a]) * near_->scale) + Candidates::kError;
  }
  const float local_radius = static_cast<float>(radius * near_->scale) + Candidates::kError;
  near_->sq_radius = local_radius * local_radius;
  near_->count = 0;
  sq_guess_ = near_->sq_radius;
  return tree_.visit_runs(box.min, box.max, sq_radius_, [&](std::size_t near_run) {
    if (near_->count > Candidates::kMost) return false;
    const std::size_t begin = tree_.first[near_run];
    add_near(tree_.axes().data(), begin, tree_.first[near_run + 1] - begin, *near_);
    return true;
  });
}

/// Writes the nearest points, and returns whether all of them are among the candidates.
bool RunSearch::select(const Query& query) {
  const auto axes = tree_.axes();
  float at[3];
  for (std::size_t a = 0; a < 3; ++a) {
    at[a] = static_cast<float>((axes[a][query.point] - near_->centre[a]) * near_->scale);
  }
  // The point itself is one of them.
  const std::size_t picked = pick_nearest(*near_, at, count_ + 1, sq_guess_, picked_.data());
  if (picked == 0) return false;
  sq_distances(axes.data(), query.point, picked_.data(), picked, sq_distances_.data());
  put_in_order(query, picked);
  const double sq_last = query.found[count_ - 1].sq_distance;
  sq_needed_ = std::max(sq_needed_, sq_last);
  sq_guess_ = static_cast<float>(1.15 * sq_last * near_->scale * near_->scale);
  return sq_last <= sq_radius_;
}

void RunSearch::put_in_order(const Query& query, std::size_t picked) {
  if (picked > kRanked) {
    many_.clear();
    for (std::size_t i = 0; i < picked; ++i) {
      if (picked_[i] != query.point) many_.push_back({picked_[i], sq_distances_[i]});
    }
    sort_by_distance(many_, ends_, sorted_);
    std::copy_n(sorted_.begin(), count_, query.found);
    return;
  }
  rank(sq_distances_.data(), picked, ranks_.data());
  const auto last_rank = static_cast<std::int64_t>(picked) - 1;
  const auto sum = std::accumulate(ranks_.begin(), ranks_.begin() + last_rank + 1, std::int64_t{0});
  if (sum == last_rank * (last_rank + 1) / 2) {  // none are equal, and the point is the first
    std::array<Neighbour, kRanked> by_rank;
    for (std::size_t i = 0; i < picked; ++i) {
      by_rank[static_cast<std::size_t>(ranks_[i])] = {picked_[i], sq_distances_[i]};
    }
    std::copy_n(by_rank.begin() + 1, count_, query.found);
    return;
  }
  for (std::size_t i = 0; i < count_; ++i) query.found[i].index = kNone;
  for (std::size_t i = 0; i < picked; ++i) {
    if (picked_[i] == query.point) continue;
    // The point itself is nearer than all except its copies. Points with equal distances have equal
    // ranks and take the places from there in order.
    auto place = static_cast<std::size_t>(ranks_[i]) - (sq_distances_[i] > 0.0 ? 1 : 0);
    while (place < count_ && query.found[place].index != kNone) ++place;
    if (place < count_) query.found[place] = {picked_[i], sq_distances_[i]};
  }
}

double RunSearch::sq_distance(std::uint32_t p, std::uint32_t q) const {
  const double dx = tree_.x[q] - tree_.x[p], dy = tree_.y[q] - tree_.y[p],
               dz = tree_.z[q] - tree_.z[p];
  return dx * dx + dy * dy + dz * dz;
}

/// Finds the neighbours of one point from the root down, nearest boxes first.
void RunSearch::descend(const Query& query) {
  const double at[3] = {tree_.x[query.point], tree_.y[query.point], tree_.z[query.point]};
  const auto last = static_cast<std::ptrdiff_t>(count_) - 1;
  Neighbour bound = {kNone, kInfinity};  // the last of those found when it was set
  const auto keep_nearest = [&] {
    std::nth_element(many_.begin(), many_.begin() + last, many_.end(), is_nearer);
    many_.resize(count_);
    bound = many_.back();
  };
  many_.clear();
  branches_.clear();
  push_branches(tree_.rows.size() - 1, 0, at, bound.sq_distance);
  while (!branches_.empty()) {
    const Branch branch = branches_.back();
    branches_.pop_back();
    if (branch.sq_gap > bound.sq_distance) continue;
    if (branch.row > 0) {
      push_branches(branch.row - 1, branch.box, at, bound.sq_distance);
      continue;
    }
    for (std::uint32_t i = tree_.first[branch.box]; i < tree_.first[branch.box + 1]; ++i) {
      const Neighbour other = {i, sq_distance(query.point, i)};
      if (i != query.point && is_nearer(other, bound)) many_.push_back(other);
    }
    if (many_.size() >= count_ + std::max(kMoreAtOnce, count_ / 4)) keep_nearest();
  }
  keep_nearest();
  sort_by_distance(many_, ends_, sorted_);
  std::copy(sorted_.begin(), sorted_.end(), query.found);
}

void RunSearch::push_branches(std::size_t row, std::size_t node, const double at[3], double bound) {
  const EightBoxes& boxes = tree_.rows[row][node];
  double gaps[kFanOut];
  sq_gaps(boxes, at, at, gaps);
  const std::size_t first = branches_.size();
  for (std::size_t b = kFanOut; b-- > 0;) {
    if (!(gaps[b] <= bound) || boxes.min[0][b] > boxes.max[0][b]) continue;
    branches_.push_back({gaps[b], row, node * kFanOut + b});
    for (std::size_t i = branches_.size() - 1;
         i > first && branches_[i - 1].sq_gap < branches_[i].sq_gap; --i) {
      std::swap(branches_[i - 1], branches_[i]);
    }
  }
}

}  // namespace pcednet::spatial
