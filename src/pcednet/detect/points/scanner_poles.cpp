#include "pcednet/detect/points/scanner_poles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "pcednet/core/median.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::detect {
namespace {

constexpr double kSteep = 0.866;      ///< sine of the angle from which beams are of a pole
constexpr double kLessSteep = 0.906;  ///< up to which they tell how far rows are apart: 65 degrees
constexpr std::size_t kPoleSamples = 1000;
/// A beam's nearest four: where rows are twice as far apart as beams in them, these are of its row,
/// and the last is as far as the next row.
constexpr std::size_t kAround = 4;
constexpr double kCrowded = 0.5;  ///< of the angle between rows
/// Others so near to a beam are a crowd: in a row more than 75 degrees up or down, seldom by
/// chance.
constexpr std::size_t kCrowd = 4;
constexpr std::size_t kLeastShare = 100;

/// The steep beams of one scanner.
struct Pole {
  std::vector<std::uint32_t> points;  ///< in curve order
  std::vector<Vec3> beams;            ///< unit
};

/// By the places of the scanners.
std::vector<Pole> find_poles(std::span<const Vec3> positions, std::span<const Vec3> scanners,
                             std::span<const std::uint32_t> curve) {
  std::map<std::array<double, 3>, Pole> by_place;
  for (const std::uint32_t i : curve) {
    const Vec3& from = scanners[i];
    if (!from.allFinite()) continue;
    const Vec3 beam = (positions[i] - from).stableNormalized();
    if (!(std::abs(beam.z()) > kSteep)) continue;
    Pole& pole = by_place[{from.x(), from.y(), from.z()}];
    pole.points.push_back(i), pole.beams.push_back(beam);
  }
  std::vector<Pole> poles;
  for (auto& [place, pole] : by_place) poles.push_back(std::move(pole));
  return poles;
}

/// The angle between its rows, 0 if unknown.
double row_angle(const Pole& pole, const spatial::KdTree& tree) {
  std::vector<Vec3> outer;
  for (const Vec3& beam : pole.beams) {
    if (std::abs(beam.z()) < kLessSteep) outer.push_back(beam);
  }
  if (outer.size() <= kAround) return 0.0;
  const std::size_t samples = std::min(outer.size(), kPoleSamples);
  std::vector<double> angles(samples);
  std::array<double, kAround + 1> sq_distances;  // and the beam itself
  for (std::size_t s = 0; s < samples; ++s) {
    tree.nearest(outer[s * outer.size() / samples], sq_distances);
    angles[s] = std::sqrt(sq_distances.back());
  }
  return median(angles);
}

/// Makes `stands_for` of the points of the pole the one that is kept in their place.
void leave_out_crowd(const Pole& pole, std::vector<std::uint32_t>& stands_for) {
  const spatial::KdTree tree(pole.beams);
  const double reach = kCrowded * row_angle(pole, tree);
  std::vector<std::uint8_t> dropped(pole.points.size(), 0);
  std::vector<spatial::Neighbour> near;
  for (std::size_t b = 0; b < pole.points.size() && reach > 0.0; ++b) {
    if (dropped[b]) continue;
    tree.within_unsorted(pole.beams[b], reach, near);
    if (near.size() <= kCrowd) continue;
    for (const spatial::Neighbour& other : near) {
      if (other.index <= b || dropped[other.index]) continue;
      dropped[other.index] = 1;
      stands_for[pole.points[other.index]] = pole.points[b];
    }
  }
}

}  // namespace

bool WithoutPoles::are_many() const {
  return crowded > 0 && crowded * kLeastShare >= kept.size() + crowded;
}

WithoutPoles without_poles(std::span<const Vec3> positions, std::span<const Vec3> scanners,
                           std::span<const std::uint32_t> curve, const Progress* progress) {
  std::vector<std::uint32_t> stands_for(positions.size(), kNoAverage);
  for (const std::uint32_t i : curve) stands_for[i] = i;
  for (const Pole& pole : find_poles(positions, scanners, curve)) {
    throw_if_cancelled(progress);
    leave_out_crowd(pole, stands_for);
  }
  WithoutPoles found;
  std::vector<std::uint32_t> number(positions.size(), kNoAverage);
  for (std::uint32_t i = 0; i < stands_for.size(); ++i) {
    if (stands_for[i] != i) continue;
    number[i] = static_cast<std::uint32_t>(found.kept.size());
    found.kept.push_back(i);
  }
  found.crowded = curve.size() - found.kept.size();
  found.average_of.assign(positions.size(), kNoAverage);
  for (std::size_t i = 0; i < stands_for.size(); ++i) {
    if (stands_for[i] != kNoAverage) found.average_of[i] = number[stands_for[i]];
  }
  return found;
}

std::string note_on(const WithoutPoles& thinned) {
  return fmt::format(
      "{} points crowd above and below scanners, where their rows meet: left out, with the labels "
      "of those beside them",
      thinned.crowded);
}

}  // namespace pcednet::detect
