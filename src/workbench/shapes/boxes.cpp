#include "workbench/shapes/boxes.h"

#include <algorithm>
#include <array>
#include <vector>

#include "pcednet/core/sort_unique.h"
#include "workbench/shapes/patches.h"

namespace pcednet::shapes {
namespace {

using Cell = std::array<int, 3>;

/// Space cut into cells by every plane of every box.
struct CellGrid {
  std::array<std::vector<double>, 3> planes;
  std::vector<bool> filled;

  int cells(int axis) const { return static_cast<int>(planes[axis].size()) - 1; }
  std::size_t index(const Cell& c) const {
    return (static_cast<std::size_t>(c[2]) * cells(1) + c[1]) * cells(0) + c[0];
  }
  bool is_filled(const Cell& c) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (c[axis] < 0 || c[axis] >= cells(axis)) return false;
    }
    return filled[index(c)];
  }
  Vec3 corner(const Cell& c) const { return {planes[0][c[0]], planes[1][c[1]], planes[2][c[2]]}; }
};

CellGrid make_grid(std::span<const Box> boxes) {
  CellGrid grid;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double>& planes = grid.planes[axis];
    for (const Box& box : boxes) planes.insert(planes.end(), {box.low[axis], box.high[axis]});
    sort_unique(planes);
  }
  grid.filled.resize(static_cast<std::size_t>(grid.cells(0)) * grid.cells(1) * grid.cells(2));
  Cell c;
  for (c[2] = 0; c[2] < grid.cells(2); ++c[2]) {
    for (c[1] = 0; c[1] < grid.cells(1); ++c[1]) {
      for (c[0] = 0; c[0] < grid.cells(0); ++c[0]) {
        const Vec3 low = grid.corner(c);
        for (const Box& box : boxes) {
          if ((low.array() >= box.low.array()).all() && (low.array() < box.high.array()).all()) {
            grid.filled[grid.index(c)] = box.filled;
          }
        }
      }
    }
  }
  return grid;
}

/// Calls `action(corner)` for every corner of the grid.
template <typename Action>
void for_each_corner(const CellGrid& grid, const Action& action) {
  Cell c;
  for (c[2] = 0; c[2] <= grid.cells(2); ++c[2]) {
    for (c[1] = 0; c[1] <= grid.cells(1); ++c[1]) {
      for (c[0] = 0; c[0] <= grid.cells(0); ++c[0]) action(c);
    }
  }
}

Cell stepped(Cell c, int axis, int steps = 1) {
  c[axis] += steps;
  return c;
}

/// The face of cell `c` towards lower `axis`, if just one side of it is filled.
void add_face(Shape& shape, const CellGrid& grid, const Cell& c, int axis) {
  const int a = (axis + 1) % 3;
  const int b = (axis + 2) % 3;
  if (c[a] >= grid.cells(a) || c[b] >= grid.cells(b)) return;
  const bool above = grid.is_filled(c);
  if (above == grid.is_filled(stepped(c, axis, -1))) return;
  const Vec3 origin = grid.corner(c);
  const Vec3 along = grid.corner(stepped(c, a)) - origin;
  const Vec3 across = grid.corner(stepped(c, b)) - origin;
  shape.patches.push_back(above ? parallelogram(origin, across, along)
                                : parallelogram(origin, along, across));
}

/// The line from corner `c` along `axis`, if the surface turns at it: unless the four cells around
/// it are filled in equal pairs side by side.
void add_edge(Shape& shape, const CellGrid& grid, const Cell& c, int axis) {
  if (c[axis] >= grid.cells(axis)) return;
  const Cell left = stepped(c, (axis + 1) % 3, -1);
  const int b = (axis + 2) % 3;
  const bool right_up = grid.is_filled(c);
  const bool right_down = grid.is_filled(stepped(c, b, -1));
  const bool left_up = grid.is_filled(left);
  const bool left_down = grid.is_filled(stepped(left, b, -1));
  const bool flat = (right_up == right_down && left_up == left_down) ||
                    (right_up == left_up && right_down == left_down);
  if (flat) return;
  shape.edges.push_back({Segment{grid.corner(c), grid.corner(stepped(c, axis))}});
}

}  // namespace

Shape make_shape(std::span<const Box> boxes) {
  const CellGrid grid = make_grid(boxes);
  Shape shape;
  for_each_corner(grid, [&](const Cell& c) {
    for (int axis = 0; axis < 3; ++axis) {
      add_face(shape, grid, c, axis);
      add_edge(shape, grid, c, axis);
    }
  });
  return shape;
}

}  // namespace pcednet::shapes
