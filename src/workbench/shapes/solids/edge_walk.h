#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "workbench/shapes/solids/solid_samples.h"

namespace pcednet::shapes {

/// The surfaces that the faces of a solid are parts of. The four sides of a round hole, and faces
/// of two volumes in one plane, belong to one surface.
class SurfaceIndex {
 public:
  explicit SurfaceIndex(const Solid& solid);

  /// The number of the surface: faces with the same signed distance everywhere share it.
  std::size_t of(const Face& face);

  /// A face of the surface.
  const Face& face(std::size_t surface) const { return faces_[surface]; }

 private:
  const Solid& solid_;
  std::vector<Vec3> probes_;
  std::vector<Face> faces_;
  std::vector<std::vector<double>> distances_;  ///< of each surface to the probes
  std::map<std::tuple<std::uint32_t, std::uint16_t, Face::Part>, std::size_t> known_;
};

/// A sharp edge of a solid, as points on the intersection of two surfaces, exact to about 1e-9.
struct WalkedEdge {
  std::size_t a, b;          ///< surfaces, a < b
  std::vector<Vec3> points;  ///< in order; the first is not repeated if closed
  bool closed = false;
  double turn = 0.0;  ///< mean angle between the surfaces' normals, radians
};

/// Follows the sharp edges (BorderPoint::turn() >= kSharpTurn) through the border points, and those
/// that start where they end.
class EdgeWalk {
 public:
  EdgeWalk(const Solid& solid, std::span<const BorderPoint> borders);

  const std::vector<WalkedEdge>& edges() const { return edges_; }

  /// The point of the edge's line near `p`.
  std::optional<Vec3> onto_edge(const WalkedEdge& edge, const Vec3& p) const;

 private:
  struct Seed {
    Vec3 position;
    std::size_t a, b;
  };
  /// A point on the intersection of two surfaces.
  struct Place {
    Vec3 position, normal_a, normal_b;
    Vec3 tangent() const;
    double turn() const;
  };

  std::optional<Place> onto(std::size_t a, std::size_t b, Vec3 p) const;
  bool is_edge(std::size_t a, std::size_t b, const Place& place, double reach);
  bool has_face(std::size_t surface, const Vec3& p);
  void follow(const Seed& seed);
  bool advance(WalkedEdge& edge, const Place& start, double sign);
  Vec3 end_beyond(const WalkedEdge& edge, const Place& last, const Vec3& ahead, double reach);
  Vec3 finish_end(const WalkedEdge& edge, const Place& last, const Vec3& ahead);
  std::vector<std::size_t> thirds_at(const WalkedEdge& edge, const Vec3& end);
  std::optional<Vec3> corner_near(const std::array<std::size_t, 3>& surfaces, Vec3 p) const;
  void add_seeds(std::size_t a, std::size_t b, const Vec3& corner);
  bool is_known(const Seed& seed) const;

  const Solid& solid_;
  SurfaceIndex surfaces_;
  double longest_step_;
  std::vector<WalkedEdge> edges_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> by_pair_;
  std::vector<Seed> seeds_;  ///< to be followed
};

}  // namespace pcednet::shapes
