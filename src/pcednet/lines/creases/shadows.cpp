#include "pcednet/lines/creases/shadows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "pcednet/core/median.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kFewest = 200;  // points of a scanner
constexpr std::size_t kBeams = 28;    // up to three steps of the scanner away
constexpr std::size_t kLeast = 4;     // of these beside the point
constexpr double kBefore = 6.0;       // spacings
constexpr double kJump = 3.0;         // times the difference to the beams beyond
constexpr double kAslant = 0.5;       // of a normal to the beam, a cosine
constexpr double kTurn = 0.05;        // of these cosines, within three steps

// Of the ends of beams below and above a scanner; heights are sines.
constexpr std::size_t kFewStray = 10, kShareOfStray = 2000;  // beams beyond the last row
constexpr double kSteep = 0.64, kPole = 0.9999;              // 40 and 89 degrees
constexpr double kSteepAbove = 0.966;  // 75 degrees: the eaves around a court are lower
constexpr double kLastRows = 0.03;
constexpr std::size_t kSectors = 36;
constexpr std::ptrdiff_t kMostSectors = 24;  // that a part of a turn may see

std::array<double, 3> key_of(const Vec3& scanner) {
  return {scanner.x(), scanner.y(), scanner.z()};
}

double median_of(std::span<const double> ranges) {
  return median(std::vector<double>(ranges.begin(), ranges.end()));
}

/// The angle above the horizon, or below it for `up` -1, from which a scanner that turns has no
/// beams; none unless it is steep, and beams end there all around.
std::optional<double> end_of_beams(std::span<const Vec3> beams, double up) {
  std::vector<double> heights(beams.size());
  std::transform(beams.begin(), beams.end(), heights.begin(),
                 [&](const Vec3& beam) { return -up * beam.z(); });
  const std::size_t stray = std::max(kFewStray, beams.size() / kShareOfStray);
  const double end = -value_at_rank(heights, std::min(stray, beams.size() - 1));
  if (end < (up > 0.0 ? kSteepAbove : kSteep) || end > kPole) return std::nullopt;
  std::array<bool, kSectors> sees = {};
  for (const Vec3& beam : beams) {
    if (up * beam.z() < end - kLastRows) continue;
    const double turn = std::atan2(beam.y(), beam.x()) / (2.0 * std::numbers::pi) + 0.5;
    sees[std::min(static_cast<std::size_t>(turn * kSectors), kSectors - 1)] = true;
  }
  const bool all_around = std::count(sees.begin(), sees.end(), true) > kMostSectors;
  return all_around ? std::optional(std::asin(end)) : std::nullopt;
}

}  // namespace

bool Shadows::View::ends(const Vec3& beam, const Vec3& beside, double step) const {
  constexpr double kTowards = 0.5;  // cosine
  const double level = std::hypot(beam.x(), beam.y());
  const auto is_last = [&](const std::optional<double>& end, double up) {
    return end && *end - std::asin(up * beam.z()) < step && up * beside.z() > kTowards * level;
  };
  return is_last(lowest, -1.0) || is_last(highest, 1.0);
}

Shadows::Shadows(const OrderedPoints& cloud) : cloud_(cloud) {
  std::map<std::array<double, 3>, std::vector<std::uint32_t>> seen;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Vec3 scanner = cloud.scanner(i);
    if (scanner.allFinite() && cloud.position(i) != scanner) seen[key_of(scanner)].push_back(i);
  }
  for (auto& [key, points] : seen) {
    if (points.size() < kFewest) continue;
    const Vec3 scanner(key[0], key[1], key[2]);
    std::vector<Vec3> beams;
    for (const std::uint32_t i : points) {
      beams.push_back((cloud.position(i) - scanner).normalized());
    }
    views_.emplace(key, View{std::move(points), spatial::KdTree(beams), end_of_beams(beams, -1.0),
                             end_of_beams(beams, 1.0)});
  }
}

bool Shadows::turns_away(std::size_t point, const View& view,
                         std::span<const std::uint32_t> inside) const {
  const Vec3 scanner = cloud_.scanner(point);
  const auto facing = [&](std::size_t i) {
    return std::abs(cloud_.normal(i).dot((cloud_.position(i) - scanner).normalized()));
  };
  const double its = facing(point);
  if (its > kAslant || inside.size() < kLeast) return false;
  std::vector<double> theirs;
  for (const std::uint32_t one : inside) {
    const std::uint32_t i = view.points[one];
    if (cloud_.edge_class(i) == kSharpEdge) return false;  // the other face of a post
    theirs.push_back(facing(i));
  }
  return median_of(theirs) > its + kTurn;
}

bool Shadows::lies_in_shadow(std::size_t point, const View& view,
                             std::span<const std::uint32_t> beyond, double spacing) const {
  if (beyond.size() < kLeast) return false;
  const Vec3 scanner = cloud_.scanner(point);
  std::vector<double> ranges;
  for (const std::uint32_t one : beyond) {
    ranges.push_back((cloud_.position(view.points[one]) - scanner).norm());
  }
  const std::span<const double> all = ranges;
  const double first = median_of(all.first(all.size() / 2));
  const double second = median_of(all.subspan(all.size() / 2));
  const double range = (cloud_.position(point) - scanner).norm();
  return range - first > std::max(kBefore * spacing, kJump * std::abs(first - second));
}

bool Shadows::are_why_it_ends(std::size_t point, const Vec3& outward, double spacing) const {
  const Vec3 scanner = cloud_.scanner(point), offset = cloud_.position(point) - scanner;
  const auto found = views_.find(key_of(scanner));
  if (!scanner.allFinite() || found == views_.end() || offset.isZero(0.0)) return false;
  const View& view = found->second;
  const Vec3 beam = offset.normalized();
  const Vec3 beside = (outward - outward.dot(beam) * beam).normalized();
  std::vector<spatial::Neighbour> near;
  view.beams.nearest(beam, kBeams, near);
  if (view.ends(beam, beside, std::sqrt(near.back().sq_distance))) return true;
  std::vector<std::uint32_t> beyond, inside;  // of the beams beside the point, the nearest first
  for (const spatial::Neighbour& one : near) {
    const Vec3 other = cloud_.position(view.points[one.index]) - scanner;
    const double along = beside.dot(other.normalized() - beam);
    if (along * along > 0.5 * one.sq_distance) {
      (along > 0.0 ? beyond : inside).push_back(one.index);
    }
  }
  return turns_away(point, view, inside) || lies_in_shadow(point, view, beyond, spacing);
}

}  // namespace pcednet::lines
