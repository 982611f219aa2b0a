#include "workbench/study/clouds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "pcednet/core/digest.h"

namespace pcednet::study {
namespace {

void add_vectors(Digest& digest, const std::vector<Vec3>& vectors) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  digest.add_values(std::span(vectors));
}

/// The sum of the digests of the single positions.
std::string places_of(const std::vector<Vec3>& positions) {
  std::array<std::uint64_t, 2> sum = {positions.size(), 0};
  for (const Vec3& position : positions) {
    const auto lanes = Digest().add_values(std::span(&position, 1)).lanes();
    sum[0] += lanes[0];
    sum[1] += lanes[1];
  }
  return fmt::format("{:016x}{:016x}", sum[0], sum[1]);
}

}  // namespace

void check_edge_classes(const ClassTable& table, const std::string& whose, ErrorKind kind) {
  const ClassTable& edges = edge_classes();
  if (table.size() <= edges.size() &&
      std::equal(table.begin(), table.end(), edges.begin(),
                 [](const auto& a, const auto& b) { return a.name == b.name; })) {
    return;
  }
  throw Error(kind, fmt::format("{}: its classes are {}; a study is of edge classes", whose,
                                names_of(table)));
}

StudyCloud make_study_cloud(const std::string& name, const std::string& file, PointCloud cloud) {
  check_consistent(cloud);
  const std::string& whose = file.empty() ? name : file;
  if (cloud.empty() || !cloud.has_labels()) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: has no {}; a study needs labelled clouds", whose,
                            cloud.empty() ? "points" : "labels"));
  }
  check_edge_classes(classes_of(cloud.comments), whose, ErrorKind::kInsufficient);
  Digest digest;
  add_vectors(digest, cloud.positions);
  add_vectors(digest, cloud.normals);
  digest.add_values(std::span(std::as_const(cloud.labels)));
  std::string places = places_of(cloud.positions);
  return {name, file, std::move(cloud), digest.hex(), std::move(places)};
}

eval::Positive positive_of(const std::vector<StudyCloud>& clouds) {
  const bool smooth = std::any_of(clouds.begin(), clouds.end(), [](const StudyCloud& c) {
    const auto& labels = c.cloud.labels;
    return std::find(labels.begin(), labels.end(), kSmoothEdge) != labels.end();
  });
  return smooth ? eval::Positive::kEdge : eval::Positive::kSharp;
}

}  // namespace pcednet::study
