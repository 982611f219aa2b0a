#include "lines_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

#include "memory_size.h"
#include "pcednet/cloud/class_table.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/averages.h"
#include "pcednet/detect/points/thinned_cloud.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/morton.h"
#include "pcednet/tiles/inputs.h"

namespace pcednet::app {
namespace {

/// The least sum of both edge probabilities at which find_lines() considers a point.
constexpr float kLeastProbability = 0.1f;
constexpr std::uint64_t kBytesPerPoint = 400;  ///< for measurements see docs/large.md
constexpr std::uint64_t kBytesIfAveraged = 200;

/// Cubes of one size, by their places in a grid that begins one cube before the cloud.
class Cubes {
 public:
  Cubes(const BoundingBox& box, double side)
      : corner_(box.min.array() - side),
        side_(std::max(side, (box.max - box.min).maxCoeff() / kMostAlong)) {}

  void add_with_neighbours(const Vec3& position) {
    const auto place = place_of(position);
    if (!own_.insert(spatial::morton_code(place)).second) return;
    for (std::uint32_t x = place[0] - 1; x <= place[0] + 1; ++x) {
      for (std::uint32_t y = place[1] - 1; y <= place[1] + 1; ++y) {
        for (std::uint32_t z = place[2] - 1; z <= place[2] + 1; ++z) {
          all_.insert(spatial::morton_code({x, y, z}));
        }
      }
    }
  }
  bool hold(const Vec3& position) const {
    return all_.contains(spatial::morton_code(place_of(position)));
  }
  /// Whether the position was not added but has only a neighbour: then points around it may not be
  /// held.
  bool are_partial_at(const Vec3& position) const {
    return !own_.contains(spatial::morton_code(place_of(position)));
  }

 private:
  static constexpr double kMostAlong = 2'000'000;  // of the 2^21 that a code has room for

  std::array<std::uint32_t, 3> place_of(const Vec3& position) const {
    std::array<std::uint32_t, 3> place = {};
    for (int axis = 0; axis < 3; ++axis) {
      place[static_cast<std::size_t>(axis)] =
          static_cast<std::uint32_t>(std::floor((position[axis] - corner_[axis]) / side_));
    }
    return place;
  }

  Vec3 corner_;
  double side_;
  std::unordered_set<std::uint64_t> own_ = {}, all_ = {};
};

bool may_be_edge(const detect::Classification& found, std::size_t i) {
  const std::uint8_t its_class = found.classes[i];
  return its_class == kSharpEdge || its_class == kSmoothEdge || its_class == kBoundary ||
         found.p_sharp[i] + found.p_smooth[i] > kLeastProbability;
}

Cubes cubes_near_edges(const TiledCloud& cloud, const Progress& progress) {
  const tiles::Plan& plan = cloud.plan();
  constexpr double kOfSpacing = 24.0;  // where octaves make s_max up to 64
  Cubes cubes(plan.box, plan.pyramids.size() > 1 ? kOfSpacing * plan.s_min : plan.s_max);
  Stage stage(&progress, "edges", plan.points());
  cloud.each([&](const PointCloud& part, const tiles::TileFindings& findings) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Vec3& position = part.positions[i];
      if (tiles::has_place(position) && may_be_edge(findings.found, i)) {
        cubes.add_with_neighbours(position);
      }
    }
    stage.advance(part.size());
    return true;
  });
  return cubes;
}

void check_memory(std::size_t points, const detect::Averaging& averaging, std::uint64_t limit) {
  const std::uint64_t each = averaging.deviation > 0.0 ? kBytesIfAveraged : kBytesPerPoint;
  if (each * points <= limit) return;
  throw Error(
      ErrorKind::kFailure,
      fmt::format("more than {} points are near edges: their lines take more memory than {}. Give "
                  "a larger --max-memory, or draw the lines tile by tile: pcednet tiles plan, "
                  "tiles run, then pcednet lines of each tile",
                  points, size_text(limit)));
}

/// The averages in place of the points, where the cloud's noise is thick.
PointsNearEdges averages_of(PointsNearEdges&& points, const detect::Averaging& averaging,
                            const Progress& progress) {
  const std::vector<Vec3>& positions = points.cloud.positions;
  detect::ThinnedCloud thinned =
      detect::thin_as_decided(positions, spatial::curve_order(positions), averaging, &progress);
  detect::PreparedCloud prepared;
  prepared.moved = std::move(thinned.positions);
  prepared.positions = prepared.moved;
  prepared.average_of = std::move(thinned.average_of);
  PointsNearEdges averages;
  averages.found = of_averages(prepared, std::move(points.found));
  averages.cloud.foreign_elements = std::move(points.cloud.foreign_elements);
  averages.cloud.normals.resize(prepared.positions.size());
  averages.partial.resize(prepared.positions.size());
  for (std::size_t i = 0; i < prepared.average_of.size(); ++i) {
    const std::uint32_t own = prepared.average_of[i];
    averages.cloud.normals[own] = points.cloud.normals[i];  // that of all its points
    averages.partial[own] |= points.partial[i];
  }
  averages.cloud.positions = std::move(prepared.moved);
  return averages;
}

}  // namespace

void check_near_edges(const TiledCloud& cloud, std::uint64_t limit, const Progress& progress) {
  const Cubes cubes = cubes_near_edges(cloud, progress);
  std::size_t near = 0;
  cloud.each([&](const PointCloud& part, const tiles::TileFindings&) {
    throw_if_cancelled(&progress);
    near += static_cast<std::size_t>(std::count_if(
        part.positions.begin(), part.positions.end(),
        [&](const Vec3& position) { return tiles::has_place(position) && cubes.hold(position); }));
    check_memory(near, cloud.plan().normals.averaging, limit);
    return true;
  });
}

PointsNearEdges read_near_edges(const TiledCloud& cloud, std::uint64_t limit,
                                const Progress& progress) {
  const Cubes cubes = cubes_near_edges(cloud, progress);
  const detect::Averaging& averaging = cloud.plan().normals.averaging;
  PointsNearEdges near;
  near.cloud.scanners = cloud.plan().scanners;
  Stage stage(&progress, "points near edges", cloud.plan().points());
  cloud.each([&](const PointCloud& part, const tiles::TileFindings& findings) {
    if (near.cloud.foreign_elements.empty()) near.cloud.foreign_elements = part.foreign_elements;
    std::vector<std::uint32_t> chosen;
    const std::vector<Vec3>& made = findings.made;
    const std::vector<Vec3>& normals = made.empty() ? part.normals : made;
    for (std::uint32_t i = 0; i < part.size(); ++i) {
      const Vec3& position = part.positions[i];
      if (!tiles::has_place(position) || !cubes.hold(position)) continue;
      chosen.push_back(i);
      near.cloud.positions.push_back(position);
      near.cloud.normals.push_back(normals.empty() ? Vec3::Zero() : normals[i]);
      near.found.classes.push_back(findings.found.classes[i]);
      near.found.p_sharp.push_back(findings.found.p_sharp[i]);
      near.found.p_smooth.push_back(findings.found.p_smooth[i]);
      near.partial.push_back(cubes.are_partial_at(position) ? 1 : 0);
    }
    tiles::append_scans(part, chosen, near.cloud);
    check_memory(near.cloud.size(), averaging, limit);
    stage.advance(part.size());
    return true;
  });
  return averaging.deviation > 0.0 ? averages_of(std::move(near), averaging, progress) : near;
}

}  // namespace pcednet::app
