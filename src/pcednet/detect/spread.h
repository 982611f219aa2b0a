#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/detect/part_of_cloud.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::detect {

// What lies along lines is found without a look at every place: some are tried, then those around
// the ones found.

/// The places to be tried first, ascending: all of a cloud of at most 131,072 points, otherwise a
/// quarter, by position alone. `part` is that of the cloud, or null.
std::vector<std::uint32_t> first_places(std::span<const Vec3> positions, const PartOfCloud* part);

/// The results of try_place(place, others) at the places `todo` (ascending), in their order, where
/// there is one; `others` are the `neighbours` nearest. Runs on all threads and advances `stage`.
template <typename Found, typename TryPlace>
std::vector<Found> found_at(const spatial::NeighbourSearch& search,
                            std::span<const std::uint32_t> todo, std::size_t neighbours,
                            Stage& stage, const TryPlace& try_place) {
  std::vector<std::vector<Found>> of_blocks(todo.size() / search.kAtOnce + 1);
  const auto visit = [&](std::size_t i, std::span<const spatial::Neighbour> others) {
    if (auto found = try_place(todo[i], others)) {
      of_blocks[i / search.kAtOnce].push_back(std::move(*found));
    }
  };
  search.for_each_neighbourhood(todo, neighbours, visit, &stage);
  std::vector<Found> all;
  for (const auto& some : of_blocks) all.insert(all.end(), some.begin(), some.end());
  return all;
}

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
