#include "workbench/shapes/true_curves.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "pcednet/spatial/kd_tree.h"
#include "workbench/shapes/curve_fit.h"
#include "workbench/shapes/edge_walk.h"

namespace pcednet::shapes {
namespace {

using lines::Curve;

/// Adds points between `from` and `to` until the chords are exact.
void add_between(const EdgeWalk& walk, const WalkedEdge& edge, const Vec3& from, const Vec3& to,
                 std::vector<Vec3>& points) {
  constexpr double kShortest = 1e-4;
  const Vec3 middle = 0.5 * (from + to);
  const auto exact = walk.onto_edge(edge, middle);
  if (!exact || (to - from).norm() < kShortest) return;
  const double away = (*exact - middle).norm();
  if (away < kExactFit || away > 0.1 * (to - from).norm()) return;
  add_between(walk, edge, from, *exact, points);
  points.push_back(*exact);
  add_between(walk, edge, *exact, to, points);
}

Curve as_polyline(const EdgeWalk& walk, const WalkedEdge& edge) {
  Curve curve;
  curve.closed = edge.closed;
  for (std::size_t i = 0; i < edge.points.size(); ++i) {
    curve.points.push_back(edge.points[i]);
    if (i + 1 < edge.points.size() || edge.closed) {
      add_between(walk, edge, edge.points[i], edge.points[(i + 1) % edge.points.size()],
                  curve.points);
    }
  }
  return curve;
}

}  // namespace

std::vector<Curve> true_curves(const Solid& solid, std::span<const BorderPoint> borders) {
  const EdgeWalk walk(solid, borders);
  std::vector<Curve> curves;
  std::vector<Vec3> corners;
  for (WalkedEdge edge : walk.edges()) {
    if (!edge.closed) {
      for (Vec3* end : {&edge.points.front(), &edge.points.back()}) {
        const auto same = std::find_if(corners.begin(), corners.end(), [&](const Vec3& corner) {
          return (corner - *end).norm() < kExactFit;
        });
        if (same == corners.end())
          corners.push_back(*end);
        else
          *end = *same;
      }
    }
    if (!edge.closed && edge.points.front() == edge.points.back()) {
      edge.closed = true;
      edge.points.pop_back();
    }
    auto curve = fit_exact(edge.points, edge.closed);
    if (!curve) curve = as_polyline(walk, edge);
    curve->confidence = 1.0;
    curve->dihedral_angle = edge.turn;
    curves.push_back(*std::move(curve));
  }
  return curves;
}

std::vector<Curve> rotated(std::vector<Curve> curves, const Mat3& rotation) {
  for (Curve& curve : curves) {
    for (Vec3& p : curve.points) p = rotation * p;
    curve.centre = rotation * curve.centre;
    curve.axis = rotation * curve.axis;
  }
  return curves;
}

void drop_unseen(std::vector<lines::Curve>& curves, std::span<const Vec3> positions, double reach) {
  const spatial::KdTree tree(positions);
  std::vector<spatial::Neighbour> near;
  std::erase_if(curves, [&](const lines::Curve& curve) {
    std::size_t seen = 0, all = 0;
    const std::vector<Vec3> vertices = lines::sampled(curve, 0.1 * reach);
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      const Vec3 along = vertices[i] - vertices[i - 1];
      const int pieces = static_cast<int>(std::ceil(along.norm() / (0.5 * reach)));
      for (int k = 0; k < pieces; ++k, ++all) {
        tree.nearest(vertices[i - 1] + (k + 0.5) / pieces * along, 1, near);
        seen += !near.empty() && near.front().sq_distance < reach * reach;
      }
    }
    return 2 * seen < all;
  });
}

}  // namespace pcednet::shapes
