#include "pcednet/lines/exact/vertices.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

namespace pcednet::lines {
namespace {

constexpr double kLeastVolume = 0.1;  ///< of the box of three normals

// In spacings.
constexpr double kFromContacts = 1.5;  ///< of a vertex, from the box of the pair's points
constexpr double kAtVertex = 2.5;      ///< of the nearest point of each plane

/// Where three planes meet, seen from a place nearby.
std::optional<Vec3> vertex_of(const PlanePatch& a, const PlanePatch& b, const PlanePatch& c,
                              const Vec3& near) {
  Mat3 normals;
  normals << a.normal.transpose(), b.normal.transpose(), c.normal.transpose();
  if (!(std::abs(normals.determinant()) > kLeastVolume)) return std::nullopt;
  const Vec3 heights(a.height(near), b.height(near), c.height(near));
  return near - normals.partialPivLu().solve(heights);
}

}  // namespace

PlaneNeighbours::PlaneNeighbours(std::size_t planes,
                                 std::span<const std::span<const PlaneContact>> pairs)
    : of_planes_(planes) {
  for (const auto& contacts : pairs) {
    const auto [a, b, point] = contacts.front();
    of_planes_[a].push_back(b);
    of_planes_[b].push_back(a);
  }
  for (auto& neighbours : of_planes_) std::sort(neighbours.begin(), neighbours.end());
}

std::vector<std::uint32_t> PlaneNeighbours::of_both(std::uint32_t a, std::uint32_t b) const {
  std::vector<std::uint32_t> both;
  std::set_intersection(of_planes_[a].begin(), of_planes_[a].end(), of_planes_[b].begin(),
                        of_planes_[b].end(), std::back_inserter(both));
  return both;
}

std::vector<Vec3> vertices_of(const OrderedPoints& cloud, const std::vector<PlanePatch>& planes,
                              std::span<const PlaneContact> pair,
                              std::span<const std::uint32_t> others, double spacing) {
  std::vector<Vec3> vertices;
  if (others.size() < 2) return vertices;
  const auto [a, b, first] = pair.front();
  const Vec3& origin = cloud.position(first);
  Eigen::AlignedBox3d box;
  for (const PlaneContact& contact : pair) box.extend(cloud.position(contact.point));
  std::vector<spatial::Neighbour> near;
  for (const std::uint32_t c : others) {
    const auto vertex = vertex_of(planes[a], planes[b], planes[c], origin);
    if (!vertex || box.exteriorDistance(*vertex) > kFromContacts * spacing) continue;
    cloud.within(*vertex, kAtVertex * spacing, near);
    const std::array<std::uint32_t, 3> meeting = {a, b, c};
    const bool is_seen = std::ranges::all_of(meeting, [&](std::uint32_t p) {
      return std::ranges::any_of(
          near, [&](const auto& point) { return planes[p].is_on(cloud.position(point.index)); });
    });
    if (is_seen) vertices.push_back(*vertex);
  }
  return vertices;
}

}  // namespace pcednet::lines
