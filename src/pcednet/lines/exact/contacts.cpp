#include "pcednet/lines/exact/contacts.h"

#include <algorithm>
#include <cmath>

#include "pcednet/core/parallel.h"
#include "pcednet/core/sort_unique.h"
#include "pcednet/lines/exact/density.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kMembersAtOnce = 512;

// In spacings: of points of other planes, and of free ones, which may be beyond a chamfer.
constexpr double kToPlanePoint = 2.5, kToFreePoint = 3.5;
/// So many are near only where most of them are too dense.
constexpr std::size_t kTooMany = 2000;

/// Appends the contacts of a point of a plane, with repetitions.
void add_contacts(std::uint32_t point, std::span<const std::uint32_t> plane_at,
                  std::span<const spatial::Neighbour> near, double spacing,
                  std::vector<PlaneContact>& found) {
  const std::uint32_t own = plane_at[point];
  const double sq_plane_reach = std::pow(kToPlanePoint * spacing, 2);
  for (const auto& other : near) {
    const std::uint32_t plane = plane_at[other.index];
    if (plane == own) continue;
    if (plane == kNoPlane) {
      found.push_back({own, kNoPlane, other.index});
    } else if (other.sq_distance < sq_plane_reach) {
      found.push_back({std::min(own, plane), std::max(own, plane), point});
    }
  }
}

/// Removes the contacts with free points that are too dense.
void erase_dense(const OrderedPoints& cloud, double spacing, const Progress* progress,
                 std::vector<PlaneContact>& contacts) {
  if (cloud.available(kNearby) < kNearby) return;
  std::vector<std::uint32_t> free_points;
  for (const PlaneContact& contact : contacts) {
    if (contact.b == kNoPlane) free_points.push_back(contact.point);
  }
  sort_unique(free_points);
  std::vector<std::uint8_t> dense(cloud.size(), 0);
  Stage stage(progress, "exact contacts", free_points.size());
  cloud.for_each_neighbourhood(
      free_points, kNearby, stage, [&](std::size_t k, std::span<const spatial::Neighbour> others) {
        dense[free_points[k]] = is_too_dense(others.back().sq_distance, spacing) ? 1 : 0;
      });
  std::erase_if(contacts, [&](const PlaneContact& contact) {
    return contact.b == kNoPlane && dense[contact.point];
  });
}

}  // namespace

std::vector<PlaneContact> contacts_of(const OrderedPoints& cloud,
                                      const std::vector<PlanePatch>& planes, double spacing,
                                      const Progress* progress) {
  std::vector<std::uint32_t> plane_at(cloud.size(), kNoPlane), points;
  for (std::uint32_t p = 0; p < planes.size(); ++p) {
    for (const std::uint32_t i : planes[p].members) plane_at[i] = p;
  }
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (plane_at[i] != kNoPlane) points.push_back(i);
  }
  std::vector<std::vector<PlaneContact>> of_blocks((points.size() + kMembersAtOnce - 1) /
                                                   kMembersAtOnce);
  parallel_blocks(points.size(), kMembersAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<PlaneContact>& found = of_blocks[begin / kMembersAtOnce];
    std::vector<spatial::Neighbour> near;
    for (std::size_t k = begin; k < end; ++k) {
      cloud.within(cloud.position(points[k]), kToFreePoint * spacing, near);
      if (near.size() < kTooMany) add_contacts(points[k], plane_at, near, spacing, found);
    }
    sort_unique(found);
  });
  std::vector<PlaneContact> contacts;
  for (const auto& block : of_blocks) contacts.insert(contacts.end(), block.begin(), block.end());
  sort_unique(contacts);
  erase_dense(cloud, spacing, progress, contacts);
  return contacts;
}

ContactPairs by_planes(const std::vector<PlaneContact>& contacts) {
  ContactPairs pairs;
  for (std::size_t begin = 0, end = 0; begin < contacts.size(); begin = end) {
    while (end < contacts.size() && contacts[end].planes() == contacts[begin].planes()) ++end;
    auto& of_kind = contacts[begin].b == kNoPlane ? pairs.of_free_points : pairs.of_planes;
    of_kind.push_back(std::span(contacts).subspan(begin, end - begin));
  }
  return pairs;
}

}  // namespace pcednet::lines
