#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/detect/classify.h"
#include "workbench/annotate/scene/described.h"

namespace pcednet::annotate {

/// A cloud to learn from; not owned.
struct SubjectCloud {
  const Described& described;
  std::span<const Vec3> positions;
  std::span<const std::uint32_t> curve;  ///< spatial::curve_order() of the positions
};

/// Clouds to learn from together, all described in the same way. Points are numbered through all
/// clouds in order, as are labels and predictions. Labels index `table`.
struct Subject {
  std::vector<SubjectCloud> clouds;
  ClassTable table = edge_classes();
};

/// The number of the first point of each cloud.
std::vector<std::uint32_t> first_points(const Subject& subject);

/// The predictions for each cloud, joined.
detect::Classification joined(std::vector<detect::Classification> found);

/// The predictions for `count` points, from `first` on.
detect::Classification part_of(const detect::Classification& found, std::size_t first,
                               std::size_t count);

/// The predictions of `model` for each cloud. Throws Error(kCancelled) if `progress` asks to
/// cancel.
std::vector<detect::Classification> classify_each(const Subject& subject,
                                                  const detect::EdgeModel& model,
                                                  const Progress* progress = nullptr);

/// The same, joined.
detect::Classification classify(const Subject& subject, const detect::EdgeModel& model,
                                const Progress* progress = nullptr);

/// The description of points of one cloud for a network: a row of numbers for each of the points,
/// which are numbered from 0.
struct CloudRows {
  std::span<const std::uint32_t> points = {};
  std::span<const float> values = {};
};

/// Rows of several clouds, with the points that they describe, numbered through the clouds.
struct Rows {
  std::vector<std::uint32_t> points = {};
  std::size_t width = 0;
  std::vector<CloudRows> clouds = {};
  std::vector<std::size_t> ends = {};  ///< of the clouds' rows

  std::span<const float> row(std::size_t row) const;
};

/// `firsts` are the first_points(); the values must outlive the result.
Rows joined_rows(std::vector<CloudRows> clouds, std::span<const std::uint32_t> firsts,
                 std::size_t width);

/// The rows of the clouds' descriptions.
Rows described_rows(const Subject& subject);

}  // namespace pcednet::annotate
