#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/detect/part_of_cloud.h"

namespace pcednet::detect {

// What lies along lines is found without a look at every place: some are tried, then those around
// the ones found.

/// The places to be tried first, ascending: all of a cloud of at most 131,072 points, otherwise a
/// quarter, by position alone. `part` is that of the cloud, or null.
std::vector<std::uint32_t> first_places(std::span<const Vec3> positions, const PartOfCloud* part);

/// Calls try_places(todo), which returns the places around those found, in any order, with `todo`
/// first and then with all that were returned and not tried yet, until there are none. Returns the
/// number of places tried, of `size`.
template <typename TryPlaces>
std::size_t spread(std::size_t size, std::vector<std::uint32_t> todo, const TryPlaces& try_places) {
  std::vector<std::uint8_t> tried(size, 0);
  for (const std::uint32_t place : todo) tried[place] = 1;
  std::size_t count = todo.size();
  while (!todo.empty()) {
    const std::vector<std::uint32_t> around = try_places(std::span<const std::uint32_t>(todo));
    todo.clear();
    for (const std::uint32_t place : around) {
      if (tried[place]) continue;
      tried[place] = 1;
      todo.push_back(place);
    }
    std::sort(todo.begin(), todo.end());
    count += todo.size();
  }
  return count;
}

}  // namespace pcednet::detect
