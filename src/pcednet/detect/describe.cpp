#include "pcednet/detect/describe.h"

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

DescribedCloud describe(const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor,
                        const Progress* progress) {
  const Progress cancel_only = without_report(progress);
  const gls::ScaleSpace space({cloud.positions, cloud.normals, cloud.curve}, descriptor,
                              &cancel_only);
  const auto order = space.order();
  DescribedCloud described{.points = cloud.positions.size(),
                           .order = {order.begin(), order.end()},
                           .scales = {space.scales().begin(), space.scales().end()},
                           .facts = facts_of(cloud, descriptor)};
  described.values.resize(order.size() * row_width(descriptor));
  describe(space, order, described.values, progress);
  return described;
}

}  // namespace pcednet::detect
