#include "pcednet/lines/shadows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "pcednet/core/median.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kFewest = 200;  // points of a scanner
constexpr std::size_t kBeams = 28;    // up to three steps of the scanner away
constexpr std::size_t kLeast = 4;     // of these beside the point
constexpr double kBefore = 6.0;       // spacings
constexpr double kJump = 3.0;         // times the difference to the beams beyond

std::array<double, 3> key_of(const Vec3& scanner) {
  return {scanner.x(), scanner.y(), scanner.z()};
}

double median_of(std::span<const double> ranges) {
  return median(std::vector<double>(ranges.begin(), ranges.end()));
}

}  // namespace

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
    views_.emplace(key, View{std::move(points), spatial::KdTree(beams)});
  }
}

bool Shadows::hide_what_is_beyond(std::size_t point, const Vec3& outward, double spacing) const {
  const Vec3 scanner = cloud_.scanner(point), offset = cloud_.position(point) - scanner;
  const auto found = views_.find(key_of(scanner));
  if (!scanner.allFinite() || found == views_.end() || offset.isZero(0.0)) return false;
  const View& view = found->second;
  const double range = offset.norm();
  const Vec3 beam = offset / range;
  const Vec3 beside = (outward - outward.dot(beam) * beam).normalized();
  std::vector<spatial::Neighbour> near;
  view.beams.nearest(beam, kBeams, near);
  std::vector<double> ranges;  // of the beams beside the point, the nearest first
  for (const spatial::Neighbour& one : near) {
    const Vec3 other = cloud_.position(view.points[one.index]) - scanner;
    const double along = beside.dot(other.normalized() - beam);
    if (along > 0.0 && along * along > 0.5 * one.sq_distance) ranges.push_back(other.norm());
  }
  if (ranges.size() < kLeast) return false;
  const std::span<const double> all = ranges;
  const double first = median_of(all.first(all.size() / 2));
  const double beyond = median_of(all.subspan(all.size() / 2));
  return range - first > std::max(kBefore * spacing, kJump * std::abs(first - beyond));
}

}  // namespace pcednet::lines
