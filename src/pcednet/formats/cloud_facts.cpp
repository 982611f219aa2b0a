#include "pcednet/formats/cloud_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "pcednet/core/error.h"
#include "pcednet/core/median.h"
#include "pcednet/core/random.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/labels.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/kd_tree.h"
#include "pcednet/spatial/middle_half.h"
#include "pcednet/spatial/neighbour_search.h"
#include "pcednet/spatial/side_of_square.h"

namespace pcednet::formats {
namespace {

std::optional<SampledSpacing> find_spacing(const PointCloud& cloud) {
  constexpr std::size_t kSample = 2000;
  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.positions[i].allFinite()) finite.push_back(i);
  }
  const spatial::KdTree tree(cloud.positions);
  Random random(1);
  const std::size_t sample = std::min(finite.size(), kSample);
  SpacingSample spacings;
  for (std::size_t s = 0; s < sample; ++s) {
    const std::size_t i = finite[sample == finite.size() ? s : random.index(finite.size())];
    std::array<double, SpacingSample::kNearest> sq_distances;
    const std::size_t found = tree.nearest(cloud.positions[i], sq_distances);
    spacings.add(std::span(sq_distances).first(found));
  }
  return spacings.spacing();
}

/// The finite points with fewer than three others within `reach`.
std::size_t count_outliers(std::span<const Vec3> positions, double reach) {
  constexpr std::size_t kCompany = 3;
  const std::vector<Vec3> finite = spatial::in_order(positions, spatial::curve_order(positions));
  const spatial::NeighbourSearch search(finite);
  if (search.available(kCompany) < kCompany) return finite.size();
  std::vector<std::uint32_t> all(finite.size());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<std::uint8_t> is_alone(finite.size());
  const auto visit = [&](std::size_t i, std::span<const spatial::Neighbour> others) {
    is_alone[i] = others.back().sq_distance > reach * reach;
  };
  search.for_each_neighbourhood(all, kCompany, visit);
  return std::accumulate(is_alone.begin(), is_alone.end(), std::size_t{0});
}

void add_values(const Attribute& attribute, std::size_t points, AttributeFacts& facts) {
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t c = 0; c < attribute.components; ++c) {
      const double value = attribute.value(i, c);
      facts.least = std::fmin(facts.least, value);
      facts.largest = std::fmax(facts.largest, value);
    }
  }
}

void add_in_common(const PointCloud& part, CloudFacts& facts) {
  facts.position_type = part.position_type;
  facts.has_normals = part.has_normals();
  facts.has_colours = !part.colours.empty();
  facts.comments = part.comments;
  for (const Attribute& attribute : part.attributes) {
    facts.attributes.push_back({attribute.name, attribute.type, attribute.components});
  }
  for (const ForeignElement& element : part.foreign_elements) {
    facts.elements.push_back(element.header.substr(0, element.header.find('\n')));
  }
}

/// In steps: the places of a lattice, all of them taken, are not further apart, as the mean of the
/// ten nearest in a plane (1.4) or in its diagonal section (1.9).
constexpr double kFullLattice = 2.0;

/// The step between the largest coordinate of the box and the next that float32 holds.
double float_step(const BoundingBox& bounds) {
  return std::ldexp(1.0, std::ilogb(std::max(bounds.farthest(), 1e-30)) - 23);
}

/// The largest coordinate of the box, as text: 5400000, or 1e+20.
std::string largest_coordinate(const BoundingBox& bounds) {
  const double largest = bounds.farthest();
  return largest < 1e15 ? fmt::format("{:.0f}", largest) : fmt::format("{:g}", largest);
}

/// Copies of points count for the median, which is then 0.
double distance_of_points(const SampledSpacing& spacing) {
  return spacing.median > 0.0 ? spacing.median : spacing.mean;
}

/// The cloud's own, otherwise those of its column, as of a result in LAS.
std::vector<std::uint8_t> labels_in_use(const PointCloud& part) {
  if (part.has_labels()) return part.labels;
  try {
    return labels_of(part, {});
  } catch (const Error&) {  // numbers that are no labels
    return {};
  }
}

}  // namespace

void SpacingSample::add(std::span<const double> sq_distances) {
  if (sq_distances.size() < kNearest || std::isinf(sq_distances.back())) return;
  for (const double sq : sq_distances) sum_ += std::sqrt(sq);
  nearest_.push_back(std::sqrt(sq_distances[1]));
  sides_.push_back(spatial::side_of_square(sq_distances.back(), sq_distances.size()));
}

std::optional<SampledSpacing> SpacingSample::spacing() const {
  if (nearest_.empty()) return std::nullopt;
  const auto count = static_cast<double>(nearest_.size() * (kNearest - 1));
  std::vector<double> sides = sides_;
  return SampledSpacing{.mean = sum_ / count,
                        .median = upper_median(nearest_),
                        .side = upper_median(sides_),
                        .uneven = spatial::is_uneven(spatial::middle_half(sides))};
}

std::string note_on_float(const BoundingBox& bounds, double apart, double distinct) {
  const double step = float_step(bounds);
  if (kFullLattice * step > apart) apart *= std::sqrt(distinct);
  if (step <= apart) return {};
  return fmt::format(
      "float coordinates up to {} are rounded to steps of {:.2g}, but the points are only {:.2g} "
      "apart: write them as double, or relative to a nearer origin",
      largest_coordinate(bounds), step, apart);
}

CloudFacts facts_of_header(const io::InputFile& file) {
  const Format& format = format_of(file);
  CloudFacts facts{.format = format.name};
  if (format.name == "E57") facts.e57 = io::read_e57_document(io::E57Pages(file));
  if (format.is_las()) facts.las = io::las_facts(file);
  return facts;
}

void add_part(const PointCloud& part, CloudFacts& facts) {
  if (facts.read == 0) add_in_common(part, facts);
  facts.read += part.size();
  facts.bounds.add(bounding_box(part.positions));
  for (const std::uint8_t label : labels_in_use(part)) ++facts.labels[label];
  for (std::size_t a = 0; a < std::min(part.attributes.size(), facts.attributes.size()); ++a) {
    add_values(part.attributes[a], part.size(), facts.attributes[a]);
  }
  const Defects defects = find_defects(part);
  facts.defects.positions += defects.positions;
  facts.defects.normals += defects.normals;
  facts.defects.duplicates += defects.duplicates;
  if (facts.las) io::count_points(part, *facts.las);
  facts.withheld += io::count_withheld(part);
}

std::vector<std::string> find_problems(const CloudFacts& facts) {
  const Defects& defects = facts.defects;
  std::vector<std::string> problems;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) problems.push_back(fmt::format("{} of {} {}", count, facts.read, what));
  };
  if (facts.points == 0) problems.emplace_back("no points");
  add(defects.positions, "points have no finite position: kept, not labelled");
  add(defects.duplicates, "points lie exactly on another one");
  if (facts.outliers.value_or(0) > 0) {
    add(*facts.outliers,
        fmt::format("points are outliers: fewer than three others are within {:.2g}, about the "
                    "largest scale",
                    facts.spacing->reach())
            .c_str());
  }
  if (facts.las) {
    const auto noise = [&](int code) {
      const auto found = facts.las->points_by_class.find(code);
      return found == facts.las->points_by_class.end() ? 0 : found->second;
    };
    add(noise(7) + noise(18),
        "points are of the classes 7 and 18, noise: labelled like all others; convert --drop-class "
        "7,18 leaves them out");
  }
  if (facts.withheld > 0) problems.push_back(io::note_on_withheld(facts.withheld, facts.read));
  if (facts.points > 0 && !facts.has_normals) {
    problems.emplace_back("no normals: they will be estimated");
  }
  add(defects.normals, "normals are zero or not finite");
  add(facts.rescaled_normals, "normals are not of unit length: normalised");
  if (!facts.bounds.empty() && facts.spacing) {
    const double step = float_step(facts.bounds), apart = distance_of_points(*facts.spacing);
    const bool is_float = facts.position_type == ScalarType::kFloat32;
    if (apart > 0.0 && step > 0.1 * apart) {
      problems.push_back(fmt::format(
          "coordinates up to {}: as float they {} rounded to {:.2g}, the points are "
          "{:.2g} apart",
          largest_coordinate(facts.bounds), is_float ? "are" : "would be", step, apart));
    }
  }
  return problems;
}

CloudFacts cloud_facts(const std::filesystem::path& path) {
  const io::LoadedCloud loaded = read_cloud(path);
  CloudFacts facts = facts_of_header(io::InputFile(path));
  facts.points = loaded.cloud.size();
  add_part(loaded.cloud, facts);
  facts.spacing = find_spacing(loaded.cloud);
  if (facts.spacing && facts.spacing->side > 0.0) {
    facts.outliers = count_outliers(loaded.cloud.positions, facts.spacing->reach());
  }
  facts.rescaled_normals = loaded.rescaled_normals;
  facts.warnings = loaded.warnings;
  facts.problems = find_problems(facts);
  return facts;
}

}  // namespace pcednet::formats
