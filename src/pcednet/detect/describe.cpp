#include "pcednet/detect/describe.h"

#include <algorithm>

#include "pcednet/core/blocks.h"
#include "pcednet/detect/octaves.h"

namespace pcednet::detect {

std::size_t row_width(const gls::ScaleSpaceOptions& descriptor) {
  return static_cast<std::size_t>(descriptor.scales) *
         static_cast<std::size_t>(gls::column_count(descriptor));
}

void describe(const gls::ScaleSpace& space, std::span<const std::uint32_t> points,
              std::span<float> rows, const Progress* progress) {
  std::vector<gls::FitStatus> status(points.size() * space.scales().size());
  space.describe(points, rows, status, progress);
}

std::vector<double> describe_rows(
    const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor,
    const std::function<void(std::span<const std::uint32_t>, std::span<const float>)>& take,
    const Progress* progress) {
  const Progress cancel_only = without_report(progress);
  const std::size_t width = row_width(descriptor);
  std::vector<double> scales;
  std::vector<float> rows;
  Stage stage(progress, "describe", cloud.curve.size());
  for_each_octave(cloud, descriptor, &cancel_only, [&](const auto& space, const auto& points) {
    if (scales.empty()) scales = space.scales();
    for_each_block(points.size(), kBlock, [&](std::size_t begin, std::size_t end) {
      const auto block = points.subspan(begin, end - begin);
      rows.resize(block.size() * width);
      describe(space, block, rows, &cancel_only);
      take(block, rows);
      stage.advance(block.size());
    });
  });
  return scales;
}

DescribedCloud describe(const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor,
                        const Progress* progress) {
  const std::size_t width = row_width(descriptor);
  DescribedCloud described{.points = cloud.positions.size(),
                           .order = cloud.curve,
                           .traits = traits_of(cloud, descriptor)};
  described.values.resize(described.order.size() * width);
  std::vector<std::uint32_t> row_of(described.points);
  for (std::size_t row = 0; row < described.order.size(); ++row) {
    row_of[described.order[row]] = static_cast<std::uint32_t>(row);
  }
  const auto take = [&](std::span<const std::uint32_t> points, std::span<const float> rows) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::copy_n(rows.data() + i * width, width,
                  described.values.data() + row_of[points[i]] * width);
    }
  };
  described.acute_edges = find_acute_edges(cloud, descriptor, progress);
  described.scales = describe_rows(cloud, descriptor, take, progress);
  return described;
}

}  // namespace pcednet::detect
