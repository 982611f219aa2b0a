#include "pcednet/spatial/neighbour_search.h"

#include "pcednet/core/parallel.h"
#include "pcednet/spatial/run_search.h"

namespace pcednet::spatial {

NeighbourSearch::NeighbourSearch(std::span<const Vec3> points) {
  const auto twins = std::adjacent_find(points.begin(), points.end());
  if (twins == points.end()) {
    tree_ = RunTree(points);
    return;
  }
  std::vector<Vec3> distinct;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && points[i] == points[i - 1]) continue;
    copies_.push_back(static_cast<std::uint32_t>(i));
    distinct.push_back(points[i]);
  }
  copies_.push_back(static_cast<std::uint32_t>(points.size()));
  tree_ = RunTree(distinct);
}

std::uint32_t NeighbourSearch::place_of(std::uint32_t point) const {
  if (copies_.empty()) return point;
  const auto next = std::upper_bound(copies_.begin(), copies_.end(), point);
  return static_cast<std::uint32_t>(next - copies_.begin() - 1);
}

void NeighbourSearch::nearest_others(std::span<const std::uint32_t> points, std::size_t count,
                                     std::span<Neighbour> found) const {
  count = available(count);
  if (count == 0 || points.empty()) return;
  const std::size_t wanted = std::min(count, tree_.size() - 1);  // places
  std::vector<std::uint32_t> places;
  std::vector<Neighbour> rows;
  std::unique_ptr<RunSearch> search;
  if (wanted > 0) search = std::make_unique<RunSearch>(tree_, wanted);
  for (std::size_t begin = 0; begin < points.size();) {
    const std::uint32_t first = place_of(points[begin]);
    const auto after = std::upper_bound(tree_.first.begin(), tree_.first.end(), first);
    const auto run = static_cast<std::size_t>(after - tree_.first.begin()) - 1;
    places.clear();
    std::size_t end = begin;
    for (; end < points.size(); ++end) {
      const std::uint32_t place = place_of(points[end]);
      if (place >= *after) break;
      if (places.empty() || places.back() != place) places.push_back(place);
    }
    rows.resize(places.size() * wanted);
    Neighbour* const out = found.data() + begin * count;
    if (wanted > 0) search->find(run, places, copies_.empty() ? out : rows.data());
    for (std::size_t i = begin, row = 0; !copies_.empty() && i < end; ++i) {
      if (place_of(points[i]) != places[row]) ++row;
      add_copies(points[i], count, std::span(rows).subspan(row * wanted, wanted),
                 found.data() + i * count);
    }
    begin = end;
  }
}

void NeighbourSearch::for_each_neighbourhood(std::span<const std::uint32_t> points,
                                             std::size_t count, const Visit& visit,
                                             Stage* stage) const {
  count = available(count);
  parallel_blocks(points.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> found((end - begin) * count);
    nearest_others(points.subspan(begin, end - begin), count, found);
    for (std::size_t k = begin; k < end; ++k) {
      visit(k, std::span(found).subspan((k - begin) * count, count));
    }
    if (stage) stage->advance(end - begin);
  });
}

void NeighbourSearch::within(const Vec3& at, double radius, std::vector<Neighbour>& found) const {
  tree_.within(at, radius, found);
  if (copies_.empty()) return;
  std::vector<Neighbour> places;
  places.swap(found);
  for (const Neighbour& place : places) {
    for (std::uint32_t i = copies_[place.index]; i < copies_[place.index + 1]; ++i) {
      found.push_back({i, place.sq_distance});
    }
  }
}

/// Writes the points at the point's own place, and then those at the places near it.
void NeighbourSearch::add_copies(std::uint32_t point, std::size_t count,
                                 std::span<const Neighbour> places, Neighbour* found) const {
  const Neighbour* const end = found + count;
  const auto add_place = [&](std::uint32_t place, double sq_distance) {
    for (std::uint32_t i = copies_[place]; i < copies_[place + 1] && found != end; ++i) {
      if (i != point) *found++ = {i, sq_distance};
    }
  };
  add_place(place_of(point), 0.0);
  for (const Neighbour& near : places) add_place(near.index, near.sq_distance);
}

}  // namespace pcednet::spatial
