#include "pcednet/tiles/large_facts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "pcednet/formats/format.h"
#include "pcednet/spatial/kd_tree.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/layout.h"
#include "pcednet/tiles/nearest.h"
#include "pcednet/tiles/sample.h"

namespace pcednet::tiles {
namespace {

using formats::CloudFacts;
using formats::SampledSpacing;
using formats::SpacingSample;

constexpr std::size_t kParts = 16;           ///< of a sample
constexpr std::size_t kPlaces = 2000;        ///< where the spacing is measured
constexpr std::size_t kPositions = 500'000;  ///< to bound the distance of the nearest points

/// At most this many parts' boxes may contain the average position, for the spacing within a part
/// to be that of the cloud.
constexpr double kMostCover = 2.0;

static_assert(SpacingSample::kNearest == gls::kSpacingNeighbours);  // of a NearestInStream

/// The squared distances at `places` places of the points, at equal steps.
template <typename Use>
void measure(std::span<const Vec3> points, std::size_t places, const Use& use) {
  const spatial::KdTree tree(points);
  std::array<double, SpacingSample::kNearest> sq_distances;
  for (std::size_t i = 0; i < std::min(places, points.size()); ++i) {
    const Vec3& place = points[i * points.size() / std::min(places, points.size())];
    if (!place.allFinite()) continue;
    const std::size_t found = tree.nearest(place, sq_distances);
    use(place, std::span<const double>(sq_distances).first(found));
  }
}

/// Reads parts of a file, finished.
void read_parts(const io::PartReader& reader, std::span<const std::size_t> parts, const char* stage,
                const Progress* progress, const std::function<void(const PointCloud&)>& see,
                io::PartTally& tally) {
  Stage steps(progress, stage, parts.size());
  read_in_turn(
      parts, [&](std::size_t part) { return reader.read(part); },
      [&](PointCloud& part, std::size_t) {
        io::finish_part(part, tally);
        see(part);
        steps.advance();
      });
}

std::vector<std::size_t> chosen_parts(std::size_t parts, bool all) {
  std::vector<std::size_t> chosen(all ? parts : kParts);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  if (all) return chosen;
  for (std::size_t& part : chosen) part = part * parts / kParts;  // the first has the comments
  return chosen;
}

/// The share of the box of the cloud that a box takes, seen along the axis where it is least.
double share_of(const BoundingBox& box, const BoundingBox& whole) {
  const Vec3 shares = shares_of(box, whole);
  return std::min({shares.x() * shares.y(), shares.y() * shares.z(), shares.z() * shares.x()});
}

/// The spacing of all points, which are read once more.
std::optional<SampledSpacing> spacing_of_all(const io::PartReader& reader, Sample& sample,
                                             const Progress* progress) {
  std::vector<Vec3> positions = sample.take();
  // A place counts once, as in the stream.
  positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
  std::vector<Vec3> places;
  std::vector<double> reach;
  measure(positions, kPlaces, [&](const Vec3& place, std::span<const double> sq_distances) {
    places.push_back(place);
    reach.push_back(std::sqrt(sq_distances.back()) * (1.0 + 1e-12));
  });
  NearestInStream stream(std::move(places), reach);
  io::PartTally known;
  read_parts(
      reader, chosen_parts(reader.parts(), true), "spacing", progress,
      [&](const PointCloud& part) { stream.add(part.positions); }, known);
  SpacingSample distances;
  for (std::size_t i = 0; i < reach.size(); ++i) distances.add(stream.of(i));
  return distances.spacing();
}

/// Normals that are all unusable count as absent, as in read_cloud().
void settle(const io::PartTally& tally, CloudFacts& facts) {
  for (std::string& warning : io::warnings_of(tally)) facts.warnings.push_back(std::move(warning));
  if (tally.unusable_normals == tally.points) facts.has_normals = false, facts.defects.normals = 0;
  facts.rescaled_normals = tally.rescaled_normals;
}

/// From a sample of the parts. `whole`: of all points, empty where the file does not say.
void add_sample(const io::PartReader& reader, const BoundingBox& whole, CloudFacts& facts,
                const Progress* progress) {
  SpacingSample distances;
  std::vector<BoundingBox> boxes;
  io::PartTally tally;
  const auto see = [&](const PointCloud& part) {
    formats::add_part(part, facts);
    boxes.push_back(bounding_box(part.positions));
    measure(part.positions, kPlaces / kParts,
            [&](const Vec3&, std::span<const double> found) { distances.add(found); });
  };
  read_parts(reader, chosen_parts(reader.parts(), false), "sample", progress, see, tally);
  settle(tally, facts);
  if (whole.holds(facts.bounds.min) && whole.holds(facts.bounds.max)) {
    facts.bounds = whole;
  } else if (facts.las) {
    facts.warnings.emplace_back(
        "the bounds in the header do not hold the points: those of the sample are given");
  }
  double cover = 0.0;
  for (const BoundingBox& box : boxes) cover += share_of(box, facts.bounds);
  cover *= static_cast<double>(reader.parts()) / static_cast<double>(boxes.size());
  if (cover <= kMostCover) facts.spacing = distances.spacing();
}

void add_all(const io::PartReader& reader, CloudFacts& facts, const Progress* progress) {
  Sample sample(kPositions);
  io::PartTally tally;
  const auto see = [&](const PointCloud& part) {
    formats::add_part(part, facts);
    sample.add(part.positions);
  };
  read_parts(reader, chosen_parts(reader.parts(), true), "read", progress, see, tally);
  settle(tally, facts);
  facts.spacing = spacing_of_all(reader, sample, progress);
}

}  // namespace

std::optional<CloudFacts> large_facts(const std::filesystem::path& path,
                                      const FactsOptions& options, const Progress* progress) {
  auto file = std::make_unique<io::InputFile>(path);
  const formats::Format& format = formats::format_of(*file);
  if (!format.is_tiled()) return std::nullopt;
  CloudFacts facts = formats::facts_of_header(*file);
  const BoundingBox whole = facts.las ? io::las_outline(*file).bounds : BoundingBox{};
  const auto reader = format.open_parts(std::move(file), kChunkPoints);
  if (!reader || reader->points() <= options.large || reader->parts() < 2 * kParts) {
    return std::nullopt;
  }
  reader->set_narrow_colours(true);  // the depth of the colours is not reported
  facts.points = reader->points(), facts.parts = reader->parts();
  facts.warnings = reader->warnings;
  if (options.all) {
    add_all(*reader, facts, progress);
  } else {
    add_sample(*reader, whole, facts, progress);
  }
  facts.problems = formats::find_problems(facts);
  return facts;
}

}  // namespace pcednet::tiles
