#include "pcednet/spatial/run_tree.h"

#include <algorithm>
#include <limits>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/parallel.h"
#include "pcednet/spatial/compact_runs.h"

namespace pcednet::spatial {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();
constexpr std::size_t kPointsAtOnce = 1024;

EightBoxes no_boxes() {
  EightBoxes boxes;
  for (int a = 0; a < 3; ++a) {
    std::fill_n(boxes.min[a], RunTree::kFanOut, kNowhere);
    std::fill_n(boxes.max[a], RunTree::kFanOut, -kNowhere);
  }
  return boxes;
}

std::vector<EightBoxes> row_of(std::size_t boxes) {
  return std::vector<EightBoxes>((boxes + RunTree::kFanOut - 1) / RunTree::kFanOut, no_boxes());
}

std::vector<EightBoxes> boxes_of_runs(std::span<const Vec3> points,
                                      const std::vector<std::uint32_t>& first) {
  const std::size_t runs = first.size() - 1;
  std::vector<EightBoxes> row = row_of(runs);
  parallel_blocks(runs, kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t run = begin; run < end; ++run) {
      BoundingBox box;
      for (std::size_t i = first[run]; i < first[run + 1]; ++i) box.add(points[i]);
      EightBoxes& node = row[run / RunTree::kFanOut];
      for (int a = 0; a < 3; ++a) {
        node.min[a][run % RunTree::kFanOut] = box.min[a];
        node.max[a][run % RunTree::kFanOut] = box.max[a];
      }
    }
  });
  return row;
}

std::vector<EightBoxes> boxes_of_nodes(const std::vector<EightBoxes>& finer) {
  std::vector<EightBoxes> row = row_of(finer.size());
  for (std::size_t i = 0; i < finer.size(); ++i) {
    EightBoxes& node = row[i / RunTree::kFanOut];
    for (int a = 0; a < 3; ++a) {
      const auto &min = finer[i].min[a], &max = finer[i].max[a];
      node.min[a][i % RunTree::kFanOut] = *std::min_element(std::begin(min), std::end(min));
      node.max[a][i % RunTree::kFanOut] = *std::max_element(std::begin(max), std::end(max));
    }
  }
  return row;
}

}  // namespace

RunTree::RunTree(std::span<const Vec3> points) {
  if (points.empty()) return;
  for (UnsetArray<double>* const axis : {&x, &y, &z}) {
    *axis = UnsetArray<double>(points.size() + kRun);
    std::fill(axis->end() - kRun, axis->end(), 0.0);
  }
  parallel_blocks(points.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      x[i] = points[i].x(), y[i] = points[i].y(), z[i] = points[i].z();
    }
  });
  first = cut_compact_runs(points, kRun);
  rows.push_back(boxes_of_runs(points, first));
  while (rows.back().size() > 1) rows.push_back(boxes_of_nodes(rows.back()));
}

void RunTree::within(const Vec3& at, double radius, std::vector<Neighbour>& found) const {
  found.clear();
  const double sq_radius = radius * radius, place[3] = {at.x(), at.y(), at.z()};
  const double sq_finite = std::min(sq_radius, std::numeric_limits<double>::max());
  visit_runs(place, place, sq_finite, [&](std::size_t run) {
    std::size_t count = found.size();
    found.resize(count + first[run + 1] - first[run]);
    for (std::uint32_t i = first[run]; i < first[run + 1]; ++i) {
      const double dx = x[i] - place[0], dy = y[i] - place[1], dz = z[i] - place[2];
      const double sq_distance = dx * dx + dy * dy + dz * dz;
      found[count] = {i, sq_distance};
      count += sq_distance < sq_radius;
    }
    found.resize(count);
    return true;
  });
}

}  // namespace pcednet::spatial
