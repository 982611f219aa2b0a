#include "pcednet/lines/roofs/folds.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "pcednet/core/sort_unique.h"
#include "pcednet/lines/points/plane_line.h"

namespace pcednet::lines {
namespace {

constexpr double kLeastSine = 0.1;
constexpr std::size_t kLeastContacts = 3;
constexpr double kOneSided = 0.75;  ///< of the points beside a fold that are on the right side

// In spacings.
constexpr double kFarthestFold = 1.5;  ///< of a contact from the fold
constexpr double kGap = 6.0;           ///< between contacts of one fold
constexpr double kBesideFold = 3.0;    ///< of the points that tell the side of the fold
constexpr double kLeastFold = 1.0;
constexpr double kNodeReach = 1.0;

using Pair = std::pair<std::uint32_t, std::uint32_t>;

/// The points beside each other of two faces.
struct Contact {
  std::uint32_t a, b;  ///< of the face of the lower number, of the other
};

std::map<Pair, std::vector<Contact>> face_contacts(const Faces& faces) {
  std::map<Pair, std::vector<Contact>> contacts;
  faces.for_each_contact([&](std::uint32_t point, std::uint32_t other) {
    const std::uint32_t own = faces.of_points[point], face = faces.of_points[other];
    if (own < face) contacts[{own, face}].push_back({point, other});
    if (face < own) contacts[{face, own}].push_back({other, point});
  });
  return contacts;
}

std::optional<Fit> line_of(const Face& a, const Face& b, const Vec3& near) {
  const auto line =
      line_of_planes(a.normal, -a.height(near), b.normal, -b.height(near), kLeastSine);
  if (!line) return std::nullopt;
  return Fit{CurveKind::kSegment, near + line->point, line->along, 0.0, 0.0};
}

class Folds {
 public:
  Folds(const OrderedPoints& cloud, const Faces& faces, double spacing)
      : cloud_(cloud), faces_(faces), spacing_(spacing) {}

  void add(const Pair& pair, const std::vector<Contact>& contacts);
  std::vector<Fold> found;

 private:
  void add_part(const Pair& pair, const Fit& line, double from, double to);
  std::optional<Vec3> side_of(std::uint32_t face, const std::vector<std::uint32_t>& beside,
                              const Fit& line, double from, double to) const;

  const OrderedPoints& cloud_;
  const Faces& faces_;
  double spacing_;
};

void Folds::add(const Pair& pair, const std::vector<Contact>& contacts) {
  const auto middle_of = [&](const Contact& contact) -> Vec3 {
    return 0.5 * (cloud_.position(contact.a) + cloud_.position(contact.b));
  };
  Vec3 mean = Vec3::Zero();
  for (const Contact& contact : contacts) mean += middle_of(contact) - cloud_.position(0);
  mean = cloud_.position(0) + mean / static_cast<double>(contacts.size());
  const auto line = line_of(faces_.faces[pair.first], faces_.faces[pair.second], mean);
  if (!line) return;
  std::vector<double> places;
  for (const Contact& contact : contacts) {
    const Vec3 middle = middle_of(contact);
    if ((middle - nearest_on(*line, middle)).norm() > kFarthestFold * spacing_) continue;
    places.push_back((middle - line->point).dot(line->direction));
  }
  std::sort(places.begin(), places.end());
  for (std::size_t first = 0, last = 0; first < places.size(); first = last) {
    for (last = first + 1; last < places.size(); ++last) {
      if (places[last] - places[last - 1] > kGap * spacing_) break;
    }
    if (last - first >= kLeastContacts) add_part(pair, *line, places[first], places[last - 1]);
  }
}

/// The direction from the line into the face, if its points near the line are on one side.
std::optional<Vec3> Folds::side_of(std::uint32_t face, const std::vector<std::uint32_t>& beside,
                                   const Fit& line, double from, double to) const {
  const Vec3 side = faces_.faces[face].normal.cross(line.direction);
  double count[2] = {};
  for (const std::uint32_t point : beside) {
    if (faces_.of_points[point] != face) continue;
    const Vec3 offset = cloud_.position(point) - line.point;
    const double place = offset.dot(line.direction), away = offset.dot(side);
    if (place < from || place > to || std::abs(away) > kBesideFold * spacing_) continue;
    if (std::abs(away) > 0.3 * spacing_) count[away > 0.0] += 1.0;
  }
  if (count[0] + count[1] < 2.0) return std::nullopt;
  if (std::max(count[0], count[1]) < kOneSided * (count[0] + count[1])) return std::nullopt;
  return count[1] > count[0] ? side : Vec3(-side);
}

void Folds::add_part(const Pair& pair, const Fit& line, double from, double to) {
  if (to - from < kLeastFold * spacing_) return;
  const auto steps = static_cast<std::size_t>(std::ceil((to - from) / spacing_));
  const double half_step = 0.5 * (to - from) / static_cast<double>(steps);
  Piece piece{.fit = line, .nodes = {}, .ends = {}};
  std::vector<std::uint32_t> beside;
  std::vector<spatial::Neighbour> near;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double place = from + (to - from) * static_cast<double>(i) / static_cast<double>(steps);
    ChainNode node{};
    node.at = line.point + place * line.direction;
    node.along = line.direction;
    node.spacing = spacing_;
    cloud_.within(node.at, (kBesideFold + 1.0) * spacing_, near);
    std::sort(near.begin(), near.end(),
              [](const auto& a, const auto& b) { return a.index < b.index; });
    for (const spatial::Neighbour& point : near) {
      beside.push_back(point.index);
      if (point.sq_distance > kNodeReach * kNodeReach * spacing_ * spacing_) continue;
      const Vec3 offset = cloud_.position(point.index) - node.at;
      if (std::abs(offset.dot(line.direction)) > half_step) continue;  // of the next node
      node.edge_points += cloud_.is_edge(point.index);
      node.probability += cloud_.probability(point.index) * cloud_.is_edge(point.index);
    }
    if (node.edge_points > 0.0) node.probability /= node.edge_points;
    node.sharp = 1.0;
    piece.nodes.push_back(node);
  }
  sort_unique(beside);
  const auto side_a = side_of(pair.first, beside, line, from, to);
  const auto side_b = side_of(pair.second, beside, line, from, to);
  if (!side_a || !side_b) return;
  for (ChainNode& node : piece.nodes) node.side_a = *side_a, node.side_b = *side_b;
  piece.ends = {piece.nodes.front().at, piece.nodes.back().at};
  found.push_back({std::move(piece), pair.first, pair.second});
}

}  // namespace

std::vector<Fold> find_roof_folds(const OrderedPoints& cloud, const Faces& faces, double spacing) {
  Folds folds(cloud, faces, spacing);
  for (const auto& [pair, contacts] : face_contacts(faces)) folds.add(pair, contacts);
  return std::move(folds.found);
}

}  // namespace pcednet::lines
