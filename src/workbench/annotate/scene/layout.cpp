#include "workbench/annotate/scene/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/cloud/octahedral.h"
#include "pcednet/spatial/morton.h"
#include "pcednet/spatial/radix_sort.h"

namespace pcednet::annotate {
namespace {

constexpr int kLevels = 21;
/// Points of a node that has children: few enough for a first picture to come soon.
constexpr std::size_t kSample = 32768;

using Keys = std::vector<spatial::Keyed>;

/// The cube of the points to show.
struct Cube {
  Vec3 centre;
  double half;

  explicit Cube(const BoundingBox& box)
      : centre(box.centre()),
        half(std::max(0.5 * (box.max - box.min).maxCoeff(), 1e-9) * (1 + 1e-9)) {}
};

/// The keys of these points along the curve through the cube.
Keys sorted_keys(std::span<const Vec3> positions, std::span<const std::uint32_t> points,
                 const Cube& cube) {
  constexpr double kCells = 1u << kLevels;
  const Vec3 low = cube.centre - Vec3::Constant(cube.half);
  const double edge = 2 * cube.half;
  Keys keys;
  keys.reserve(points.size());
  for (const std::uint32_t i : points) {
    std::array<std::uint32_t, 3> cell;
    for (int k = 0; k < 3; ++k) {
      const double place = (positions[i][k] - low[k]) / edge * kCells;
      cell[static_cast<std::size_t>(k)] =
          static_cast<std::uint32_t>(std::clamp(place, 0.0, kCells - 1));
    }
    keys.push_back({spatial::morton_code(cell), i});
  }
  spatial::sort_by_key(keys, 3 * kLevels);
  return keys;
}

/// The numbers below `count` in the order of their reversed bits: every prefix is spread evenly.
std::vector<std::size_t> spread_order(std::size_t count) {
  int bits = 0;
  while ((std::size_t{1} << bits) < count) ++bits;
  std::vector<std::size_t> order;
  order.reserve(count);
  for (std::size_t i = 0; i < std::size_t{1} << bits; ++i) {
    std::size_t reversed = 0;
    for (int b = 0; b < bits; ++b) reversed |= (i >> b & 1) << (bits - 1 - b);
    if (reversed < count) order.push_back(reversed);
  }
  return order;
}

class Builder {
 public:
  Builder(Layout& layout, double spacing) : layout_(layout), spacing_(spacing) {}

  /// Makes the node of `left`, keys along the curve that share their highest 3 x `level` bits, and
  /// those below it. Returns its number.
  std::uint32_t add(Keys left, const Vec3& centre, double half, int level) {
    const auto id = static_cast<std::uint32_t>(layout_.nodes.size());
    const std::size_t all = left.size();
    const std::size_t count = all <= kMostNodePoints ? all : kSample;
    layout_.nodes.push_back({.centre = centre, .half = half, .first = layout_.order.size()});
    take(left, count, id);
    layout_.nodes[id].points = count;
    layout_.nodes[id].spacing =
        spacing_ *
        std::sqrt(static_cast<double>(all) / static_cast<double>(std::max(count, std::size_t{1})));
    for (std::size_t first = 0; first < left.size();) {
      const auto [end, octant] = run_of(left, first, level);
      Keys part(left.begin() + static_cast<std::ptrdiff_t>(first),
                left.begin() + static_cast<std::ptrdiff_t>(end));
      // Below the last level the cube stays: its points are in one place.
      Vec3 towards = Vec3::Zero();
      if (level < kLevels) {
        towards = Vec3(octant & 4 ? 1 : -1, octant & 2 ? 1 : -1, octant & 1 ? 1 : -1) * 0.5 * half;
      }
      const std::uint32_t child =
          add(std::move(part), centre + towards, level < kLevels ? 0.5 * half : half, level + 1);
      layout_.nodes[id].children.push_back(child);
      first = end;
    }
    return id;
  }

 private:
  /// Moves `count` of the keys, at even steps, to the end of the order.
  void take(Keys& left, std::size_t count, std::uint32_t id) {
    const std::size_t all = left.size();
    for (const std::size_t i : spread_order(count)) {
      const std::uint32_t point = left[i * all / count].index;
      layout_.order.push_back(point);
      layout_.node_of[point] = id;
    }
    std::erase_if(left, [&](const spatial::Keyed& k) { return layout_.node_of[k.index] == id; });
  }

  static std::pair<std::size_t, unsigned> run_of(const Keys& keys, std::size_t first, int level) {
    if (level >= kLevels) return {keys.size(), 0};
    const int shift = 3 * (kLevels - 1 - level);
    const auto octant = [&](std::size_t i) {
      return static_cast<unsigned>(keys[i].key >> shift & 7);
    };
    std::size_t end = first;
    while (end < keys.size() && octant(end) == octant(first)) ++end;
    return {end, octant(first)};
  }

  Layout& layout_;
  double spacing_;
};

std::int8_t signed_byte(double value) {
  return static_cast<std::int8_t>(std::lround(std::clamp(value, -1.0, 1.0) * 127.0));
}

}  // namespace

Layout make_layout(std::span<const Vec3> positions, double spacing) {
  Layout layout;
  layout.node_of.assign(positions.size(), kNoNode);
  std::vector<Vec3> places;
  for (const Vec3& p : positions) {
    if (p.allFinite()) places.push_back(p);
  }
  const BoundingBox most = box_of_most(places);
  std::vector<std::uint32_t> near, far;
  BoundingBox box, far_box;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (!positions[i].allFinite()) continue;
    const bool is_near = most.holds(positions[i]);
    (is_near ? near : far).push_back(i);
    (is_near ? box : far_box).add(positions[i]);
  }
  layout.order.reserve(places.size());
  Builder builder(layout, spacing);
  const auto add = [&](const std::vector<std::uint32_t>& points, const BoundingBox& their_box) {
    const Cube cube(their_box);
    return builder.add(sorted_keys(positions, points, cube), cube.centre, cube.half, 0);
  };
  if (!near.empty()) add(near, box);
  if (!far.empty()) {
    const std::uint32_t node = add(far, far_box);
    if (node != 0) layout.nodes[0].children.push_back(node);
  }
  return layout;
}

std::vector<std::byte> encode_points(const Layout& layout, const Node& node,
                                     std::span<const Vec3> positions, std::span<const Vec3> normals,
                                     std::span<const Rgb> colours) {
  std::vector<std::byte> bytes(node.points * (colours.empty() ? 8 : 11));
  for (std::size_t i = 0; i < node.points; ++i) {
    const std::uint32_t point = layout.order[node.first + i];
    std::array<std::uint16_t, 3> place;
    for (int k = 0; k < 3; ++k) {
      const double share = (positions[point][k] - node.centre[k] + node.half) / (2 * node.half);
      place[static_cast<std::size_t>(k)] =
          static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * 65535));
    }
    const Eigen::Vector2d unfolded = octahedral(normals[point]);
    const std::array<std::int8_t, 2> normal = {signed_byte(unfolded.x()),
                                               signed_byte(unfolded.y())};
    std::memcpy(bytes.data() + 6 * i, place.data(), 6);
    std::memcpy(bytes.data() + 6 * node.points + 2 * i, normal.data(), 2);
    if (!colours.empty()) {
      std::memcpy(bytes.data() + 8 * node.points + 3 * i, colours[point].data(), 3);
    }
  }
  return bytes;
}

}  // namespace pcednet::annotate
