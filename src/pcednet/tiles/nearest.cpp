#include "pcednet/tiles/nearest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pcednet/core/parallel.h"
#include "pcednet/tiles/grid.h"

namespace pcednet::tiles {
namespace {

/// Places too far from the origin for their number are in one cell.
std::int64_t cell_along(double coordinate, int size) {
  constexpr double kMost = 0x1p62;
  const double cell = std::floor(std::ldexp(coordinate, -size));
  return static_cast<std::int64_t>(std::clamp(cell, -kMost, kMost));
}

double sq_distance(const Vec3& a, const Vec3& b) {
  const Vec3 d = a - b;
  return d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
}

}  // namespace

NearestInStream::NearestInStream(std::vector<Vec3> places, std::span<const double> reach)
    : places_(std::move(places)) {
  Row none;
  none.fill(std::numeric_limits<double>::infinity());
  nearest_.assign(places_.size(), none);
  points_.resize(places_.size());
  for (std::uint32_t p = 0; p < places_.size(); ++p) {
    const double far = std::max(reach[p], 1e-100);
    sq_reach_.push_back(reach[p] * reach[p]);
    const int size = std::ilogb(far) + 1;
    if (std::find(sizes_.begin(), sizes_.end(), size) == sizes_.end()) sizes_.push_back(size);
    std::array<std::int64_t, 3> low, high;
    for (std::size_t a = 0; a < 3; ++a) {
      const double at = places_[p][static_cast<int>(a)];
      low[a] = cell_along(at - far, size), high[a] = cell_along(at + far, size);
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          cells_[{size, {x, y, z}}].push_back(p);
        }
      }
    }
  }
}

std::size_t NearestInStream::CellHash::operator()(const Cell& cell) const {
  std::uint64_t key = 0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(cell.size + 4096);
  for (const std::int64_t c : cell.place) {
    key = (key ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15u;
    key ^= key >> 29;
  }
  return key;
}

void NearestInStream::look_around(const Vec3& point, std::vector<Found>& found) const {
  if (!has_place(point)) return;
  for (const int size : sizes_) {
    const auto cell = cells_.find(
        {size,
         {cell_along(point.x(), size), cell_along(point.y(), size), cell_along(point.z(), size)}});
    if (cell == cells_.end()) continue;
    for (const std::uint32_t place : cell->second) {
      const double sq = sq_distance(point, places_[place]);
      if (sq <= sq_reach_[place] && sq < nearest_[place].back())
        found.push_back({place, sq, point});
    }
  }
}

void NearestInStream::add(std::span<const Vec3> points) {
  constexpr std::size_t kTogether = 4096;
  std::vector<std::vector<Found>> found((points.size() + kTogether - 1) / kTogether);
  parallel_blocks(points.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) look_around(points[i], found[begin / kTogether]);
  });
  for (const std::vector<Found>& some : found) {
    for (const Found& one : some) insert(one);
  }
}

void NearestInStream::insert(const Found& found) {
  Row& row = nearest_[found.place];
  auto& points = points_[found.place];
  if (!(found.sq_distance < row.back())) return;
  const auto [first, last] = std::equal_range(row.begin(), row.end(), found.sq_distance);
  const auto begin = points.begin() + (first - row.begin()),
             at = points.begin() + (last - row.begin());
  if (std::find(begin, at, found.point) != at) return;
  std::copy_backward(last, row.end() - 1, row.end());
  std::copy_backward(at, points.end() - 1, points.end());
  *last = found.sq_distance;
  *at = found.point;
}

}  // namespace pcednet::tiles
