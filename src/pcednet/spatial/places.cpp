#include "pcednet/spatial/places.h"

#include <utility>

#include "pcednet/spatial/curve_order.h"

namespace pcednet::spatial {
namespace {

std::vector<std::uint32_t> starts_of_places(std::span<const Vec3> positions,
                                            std::span<const std::uint32_t> order) {
  std::vector<std::uint32_t> starts;
  starts.reserve(order.size() + 1);
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (i == 0 || positions[order[i]] != positions[order[i - 1]]) starts.push_back(i);
  }
  starts.push_back(static_cast<std::uint32_t>(order.size()));
  return starts;
}

}  // namespace

Places places_of(std::span<const Vec3> positions, std::vector<std::uint32_t> order) {
  Places places{.order = std::move(order)};
  const std::vector<std::uint32_t> firsts = firsts_of_places(positions, places.order);
  places.positions = in_order(positions, firsts);
  if (firsts.size() < places.order.size()) {
    places.starts = starts_of_places(positions, places.order);
  }
  return places;
}

}  // namespace pcednet::spatial
