#include "pcednet/spatial/kd_tree.h"

#include <algorithm>
#include <nanoflann.hpp>
#include <utility>

#include "pcednet/spatial/curve_order.h"

namespace pcednet::spatial {
namespace {

/// The points in curve order, with nanoflann's interface.
struct OrderedPoints {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> original;

  std::size_t kdtree_get_point_count() const { return positions.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return positions[i][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Index =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, OrderedPoints>,
                                        OrderedPoints, 3, std::uint32_t>;

OrderedPoints order_points(std::span<const Vec3> positions) {
  OrderedPoints points;
  points.original = curve_order(positions);
  points.positions = in_order(positions, points.original);
  return points;
}

}  // namespace

struct KdTree::Impl {
  explicit Impl(std::span<const Vec3> positions)
      : points(order_points(positions)),
        index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}

  /// Turns places in curve order into the caller's indices, sorted as the header promises.
  void finish(std::vector<Neighbour>& found) const {
    std::sort(found.begin(), found.end(), [&](const Neighbour& a, const Neighbour& b) {
      if (a.sq_distance != b.sq_distance) return a.sq_distance < b.sq_distance;
      const Vec3 &p = points.positions[a.index], &q = points.positions[b.index];
      return p != q ? is_before(p, q) : a.index < b.index;
    });
    renumber(found);
  }

  void renumber(std::vector<Neighbour>& found) const {
    for (Neighbour& neighbour : found) neighbour.index = points.original[neighbour.index];
  }

  /// The places in curve order of the points closer than `radius`, as the tree meets them.
  void search(const Vec3& query, double radius, std::vector<Neighbour>& found) const {
    thread_local std::vector<std::pair<std::uint32_t, double>> matches;
    matches.clear();
    found.clear();
    if (points.positions.empty()) return;
    nanoflann::SearchParams parameters;
    parameters.sorted = false;
    index.radiusSearch(query.data(), radius * radius, matches, parameters);
    for (const auto& [place, sq_distance] : matches) found.push_back({place, sq_distance});
  }

  OrderedPoints points;
  Index index;
};

KdTree::KdTree(std::span<const Vec3> positions) : impl_(std::make_unique<Impl>(positions)) {}
KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

std::size_t KdTree::size() const {
  return impl_->points.positions.size();
}

void KdTree::nearest(const Vec3& query, std::size_t count, std::vector<Neighbour>& found) const {
  count = std::min(count, size());
  found.clear();
  if (count == 0) return;
  thread_local std::vector<std::uint32_t> indices;
  thread_local std::vector<double> sq_distances;
  indices.resize(count);
  sq_distances.resize(count);
  impl_->index.knnSearch(query.data(), count, indices.data(), sq_distances.data());
  for (std::size_t i = 0; i < count; ++i) found.push_back({indices[i], sq_distances[i]});
  impl_->finish(found);
}

std::size_t KdTree::nearest(const Vec3& query, std::span<double> sq_distances) const {
  thread_local std::vector<Neighbour> found;
  nearest(query, sq_distances.size(), found);
  for (std::size_t i = 0; i < found.size(); ++i) sq_distances[i] = found[i].sq_distance;
  return found.size();
}

void KdTree::within(const Vec3& query, double radius, std::vector<Neighbour>& found) const {
  impl_->search(query, radius, found);
  impl_->finish(found);
}

void KdTree::within_unsorted(const Vec3& query, double radius,
                             std::vector<Neighbour>& found) const {
  impl_->search(query, radius, found);
  impl_->renumber(found);
}

}  // namespace pcednet::spatial
