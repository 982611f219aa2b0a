#include "pcednet/formats/cloud_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/core/random.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::formats {
namespace {

std::optional<SampledSpacing> find_spacing(const PointCloud& cloud) {
  constexpr std::size_t kNeighbours = 10, kSample = 2000;
  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.positions[i].allFinite()) finite.push_back(i);
  }
  if (finite.size() <= kNeighbours) return std::nullopt;
  const spatial::KdTree tree(cloud.positions);
  Random random(1);
  const std::size_t sample = std::min(finite.size(), kSample);
  double sum = 0.0;
  std::vector<double> nearest;
  std::vector<spatial::Neighbour> found;
  for (std::size_t s = 0; s < sample; ++s) {
    const std::size_t i = finite[sample == finite.size() ? s : random.index(finite.size())];
    // The nearest of all is the point itself.
    tree.nearest(cloud.positions[i], kNeighbours + 1, found);
    for (const spatial::Neighbour& neighbour : found) sum += std::sqrt(neighbour.sq_distance);
    nearest.push_back(std::sqrt(found[1].sq_distance));
  }
  std::nth_element(nearest.begin(), nearest.begin() + sample / 2, nearest.end());
  return SampledSpacing{sum / static_cast<double>(sample * kNeighbours), nearest[sample / 2]};
}

/// What may surprise, one sentence each.
std::vector<std::string> find_problems(const io::LoadedCloud& loaded, const CloudFacts& facts) {
  const PointCloud& cloud = loaded.cloud;
  const Defects& defects = facts.defects;
  std::vector<std::string> problems;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) problems.push_back(fmt::format("{} of {} {}", count, cloud.size(), what));
  };
  if (cloud.empty()) problems.emplace_back("no points");
  add(defects.positions, "points have no finite position: kept, not labelled");
  add(defects.duplicates, "points lie exactly on another one");
  if (!cloud.empty() && !cloud.has_normals()) {
    problems.emplace_back("no normals: they will be estimated");
  }
  add(defects.normals, "normals are zero or not finite");
  add(loaded.rescaled_normals, "normals are not of unit length: made so");
  if (!facts.bounds.empty() && facts.spacing) {
    const double largest =
        std::max(facts.bounds.min.cwiseAbs().maxCoeff(), facts.bounds.max.cwiseAbs().maxCoeff());
    const double step = std::ldexp(1.0, std::ilogb(std::max(largest, 1e-30)) - 23);
    if (step > 0.1 * facts.spacing->median) {
      problems.push_back(fmt::format(
          "coordinates up to {}: as float they would be rounded to "
          "{:.2g}, the points are {:.2g} apart",
          largest < 1e15 ? fmt::format("{:.0f}", largest) : fmt::format("{:g}", largest), step,
          facts.spacing->median));
    }
  }
  return problems;
}

AttributeFacts facts_of(const Attribute& attribute, std::size_t points) {
  double least = INFINITY, largest = -INFINITY;
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t c = 0; c < attribute.components; ++c) {
      const double value = attribute.value(i, c);
      least = std::fmin(least, value);
      largest = std::fmax(largest, value);
    }
  }
  return {attribute.name, attribute.type, attribute.components, least, largest, least <= largest};
}

}  // namespace

CloudFacts cloud_facts(const std::filesystem::path& path) {
  const io::LoadedCloud loaded = read_cloud(path);
  const PointCloud& cloud = loaded.cloud;
  const io::InputFile file(path);
  CloudFacts facts{.format = format_of(file).name,
                   .points = cloud.size(),
                   .position_type = cloud.position_type,
                   .bounds = bounding_box(cloud.positions),
                   .spacing = find_spacing(cloud),
                   .has_normals = cloud.has_normals(),
                   .has_colours = !cloud.colours.empty(),
                   .comments = cloud.comments,
                   .defects = find_defects(cloud),
                   .warnings = loaded.warnings};
  for (const std::uint8_t label : cloud.labels) ++facts.labels[label];
  for (const Attribute& attribute : cloud.attributes) {
    facts.attributes.push_back(facts_of(attribute, cloud.size()));
  }
  for (const ForeignElement& element : cloud.foreign_elements) {
    facts.elements.push_back(element.header.substr(0, element.header.find('\n')));
  }
  facts.problems = find_problems(loaded, facts);
  if (facts.format == "E57") facts.e57 = io::read_e57_document(io::E57Pages(file));
  if (facts.format == "LAS") facts.las = io::las_facts(file, cloud);
  return facts;
}

}  // namespace pcednet::formats
