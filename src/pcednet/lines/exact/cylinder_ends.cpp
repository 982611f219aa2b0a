#include "pcednet/lines/exact/cylinder_ends.h"

#include <algorithm>
#include <cmath>

#include "pcednet/lines/points/moments.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kMostTried = 24;   ///< points, to lay lines through
constexpr std::size_t kLeastOnCone = 6;  ///< points
constexpr double kMostBesideCone = 0.3;  ///< points off it in its box, to one of it
constexpr double kLeastOfTurn = 0.6;     ///< of a chamfer, to that of its cylinder

// In spacings.
constexpr double kOffSurfaces = 0.02;  ///< from cylinder and plane
constexpr double kLeastChamfer = 0.15, kMostChamfer = 2.5;
constexpr double kOnCone = 0.01;
constexpr double kLeastRimRadius = 0.5;

/// A line across a corner: `out` from the cylinder and `up` from the plane.
struct CornerCut {
  double out, up;

  double height(const Eigen::Vector2d& at) const {
    return (at.x() / out + at.y() / up - 1.0) / std::hypot(1.0 / out, 1.0 / up);
  }
  bool is_chamfer() const {
    return out > kLeastChamfer && out < kMostChamfer && up > kLeastChamfer && up < kMostChamfer;
  }
};

/// The line through two places; none if it does not cut the corner.
std::optional<CornerCut> cut_through(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double cross = a.x() * b.y() - a.y() * b.x();
  const CornerCut cut{cross / (b.y() - a.y()), cross / (a.x() - b.x())};
  if (!cut.is_chamfer()) return std::nullopt;
  return cut;
}

std::size_t count_on(const CornerCut& cut, const std::vector<Eigen::Vector2d>& places) {
  return static_cast<std::size_t>(std::ranges::count_if(
      places, [&](const auto& at) { return std::abs(cut.height(at)) < kOnCone; }));
}

/// The line of least squares through the places on the cut.
std::optional<CornerCut> fitted(const CornerCut& cut, const std::vector<Eigen::Vector2d>& places) {
  FlatMoments on;
  for (const Eigen::Vector2d& at : places) {
    if (std::abs(cut.height(at)) < kOnCone) on.add(at);
  }
  const Eigen::Matrix2d covariance = on.covariance();
  const double angle =
      0.5 * std::atan2(2.0 * covariance(0, 1), covariance(0, 0) - covariance(1, 1));
  return cut_through(on.mean(), on.mean() + Eigen::Vector2d(std::cos(angle), std::sin(angle)));
}

/// The cone that the most of the places in the corner are on, if nearly none are beside it.
std::optional<CornerCut> chamfer_of(const std::vector<Eigen::Vector2d>& places) {
  if (places.size() < kLeastOnCone) return std::nullopt;
  const std::size_t step = (places.size() + kMostTried - 1) / kMostTried;
  std::optional<CornerCut> best;
  std::size_t most = kLeastOnCone - 1;
  for (std::size_t i = 0; i < places.size(); i += step) {
    for (std::size_t j = i + step; j < places.size(); j += step) {
      const auto cut = cut_through(places[i], places[j]);
      if (!cut) continue;
      const std::size_t on = count_on(*cut, places);
      if (on > most) most = on, best = cut;
    }
  }
  if (best) best = fitted(*best, places);
  if (!best) return std::nullopt;
  const auto beside = std::ranges::count_if(places, [&](const auto& at) {
    return at.x() < best->out && at.y() < best->up && std::abs(best->height(at)) > kOnCone;
  });
  const auto on = static_cast<double>(count_on(*best, places));
  if (on < static_cast<double>(kLeastOnCone)) return std::nullopt;
  if (static_cast<double>(beside) > kMostBesideCone * on) return std::nullopt;  // as a rounded edge
  return best;
}

/// The places off both surfaces in the corner on one side of the cylinder: away from it, and from
/// the plane.
std::vector<Eigen::Vector2d> places_in_corner(const Profile& profile, double side) {
  std::vector<Eigen::Vector2d> places;
  for (const Profile::Point& point : profile.points()) {
    const Eigen::Vector2d at(side * (point.at.x() - profile.radius()), point.at.y());
    if (at.minCoeff() > kOffSurfaces && at.maxCoeff() < kMostChamfer) places.push_back(at);
  }
  return places;
}

/// About the axis, all together.
double turn_of(const std::vector<Piece>& arcs) {
  double turn = 0.0;
  for (const Piece& arc : arcs) turn += length_of(arc) / arc.fit.radius;
  return turn;
}

/// The arc on a circle about the same axis.
Piece moved(Piece arc, const Fit& circle) {
  arc.fit = circle;
  for (ChainNode& node : arc.nodes) node.at = nearest_on(circle, node.at);
  for (Vec3& end : arc.ends) end = nearest_on(circle, end);
  return arc;
}

}  // namespace

ExactEdges edges_of_cylinder(const Profile& profile) {
  const double radius = profile.radius();
  const Eigen::Vector2d corner(radius, 0.0), up(0.0, 1.0);
  ExactEdges found;
  for (const double side : {1.0, -1.0}) {
    const ProfileRay out{corner, {side, 0.0}};
    append(found.pieces, profile.arcs(out, {corner, up}));
    append(found.rounded, profile.fillets(out, {corner, up}));
  }
  if (!found.pieces.empty() || !found.rounded.empty()) return found;
  for (const double side : {1.0, -1.0}) {
    const auto cut = chamfer_of(places_in_corner(profile, side));
    if (!cut || radius + side * cut->out < kLeastRimRadius) continue;
    const Eigen::Vector2d on_plane(radius + side * cut->out, 0.0), on_cylinder(radius, cut->up);
    const Eigen::Vector2d down = (on_plane - on_cylinder).normalized();
    std::vector<Piece> below =
        profile.arcs({on_plane, Eigen::Vector2d(side, 0.0)}, {on_plane, -down});
    std::vector<Piece> above = profile.arcs({on_cylinder, up}, {on_cylinder, down});
    const double turn = std::max(turn_of(below), turn_of(above));
    if (turn < kLeastOfTurn * profile.turn_along({on_cylinder, up})) continue;
    for (const Piece& arc : below) found.cut_off.push_back(moved(arc, profile.circle()));
    append(found.pieces, std::move(below));
    append(found.pieces, std::move(above));
  }
  return found;
}

}  // namespace pcednet::lines
