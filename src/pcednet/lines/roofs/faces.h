#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/lines/creases/crease.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

inline constexpr std::uint32_t kNoFace = std::numeric_limits<std::uint32_t>::max();

/// A plane part of the surface.
struct Face {
  Vec3 point, normal;     ///< the sign of the normal is arbitrary
  std::size_t count;      ///< of its points
  double within = 0.0;    ///< largest distance of its points, by that of most of them
  bool is_curved = true;  ///< unless folds explain its heights better than a parabola

  double height(const Vec3& place) const { return normal.dot(place - point); }
};

/// A cloud segmented into plane faces.
struct Faces {
  std::vector<Face> faces;
  std::vector<std::uint32_t> of_points;  ///< of each point, or kNoFace
  std::vector<std::uint32_t> others;     ///< the nearest others of each point, row after row
  std::size_t others_of_each = 0;
  double within = 0.0;  ///< largest distance of a point to any face
  double share = 0.0;   ///< share of points on faces that are not part of a curved surface

  std::span<const std::uint32_t> near(std::size_t point) const {
    return std::span(others).subspan(point * others_of_each, others_of_each);
  }
  /// Whether the eight nearest others are on the point's own face.
  bool is_inside(std::size_t point) const;
  /// Whether they are on one of two faces.
  bool is_inside(std::size_t point, std::uint32_t a, std::uint32_t b) const;
  /// Calls work(point, other) for each point and each of its near others on another face.
  template <typename Work>
  void for_each_contact(const Work& work) const {
    for (std::uint32_t i = 0; i < of_points.size(); ++i) {
      if (of_points[i] == kNoFace) continue;
      for (const std::uint32_t other : near(i)) {
        if (of_points[other] != kNoFace && of_points[other] != of_points[i]) work(i, other);
      }
    }
  }
};

/// How many points are near one of another face, for each pair of faces with such points.
std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> count_contacts(const Faces& faces);

/// Grows faces from the flattest points over their neighbours, lets every point choose among the
/// adjacent faces, and merges faces that one plane explains. No faces, and a share of 0, if there
/// are more than a hundred: such a surface does not consist of planes.
Faces find_faces(const OrderedPoints& cloud, const Sampling& sampling, const Progress* progress);

}  // namespace pcednet::lines
