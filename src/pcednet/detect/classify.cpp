#include "pcednet/detect/classify.h"
#include "pcednet/detect/describe.h"

#include <fmt/format.h>

#include "pcednet/core/blocks.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/context.h"
#include "pcednet/detect/decide.h"
#include "pcednet/nn/predict.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

/// Classifies the points `order`, whose descriptions rows_of(begin, end) gives block by block. A
/// context network needs the `curve` order of all positions.
template <typename RowsOf>
Classification classify_rows(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
                             std::span<const std::uint32_t> order, const RowsOf& rows_of,
                             const EdgeModel& model, const Progress* progress) {
  Classification found = nothing_found(positions.size());
  Stage stage(progress, "describe", order.size());
  for_each_block(order.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    const auto points = order.subspan(begin, end - begin);
    decide(points, nn::predict(model.network, rows_of(begin, end)), model.classes, found);
    stage.advance(points.size());
  });
  if (model.context)
    apply_context(*model.context, model.classes, positions, curve, found, progress);
  found.counts = count_classes(found.classes);
  return found;
}

}  // namespace

Classification classify(const PreparedCloud& cloud, const EdgeModel& model,
                        const Progress* progress) {
  const gls::ScaleSpace space({cloud.positions, cloud.normals, cloud.curve}, model.descriptor,
                              progress);
  const auto order = space.order();
  const std::size_t width = row_width(model.descriptor);
  std::vector<float> rows(std::min(kBlock, order.size()) * width);
  const Progress cancel_only = without_report(progress);
  const auto rows_of = [&](std::size_t begin, std::size_t end) {
    const auto some = std::span(rows).first((end - begin) * width);
    describe(space, order.subspan(begin, end - begin), some, &cancel_only);
    return some;
  };
  Classification found =
      classify_rows(cloud.positions, cloud.curve, order, rows_of, model, progress);
  found.note = gls::note_on(model.descriptor, space.scales(), cloud.positions);
  return found;
}

Classification classify(const DescribedCloud& cloud, std::span<const Vec3> positions,
                        const EdgeModel& model) {
  const std::size_t width = row_width(model.descriptor);
  if (cloud.values.size() != cloud.order.size() * width || positions.size() != cloud.points) {
    throw Error(ErrorKind::kModelMismatch,
                fmt::format("{} numbers describe {} of {} points; the model wants {} for each",
                            cloud.values.size(), cloud.points, positions.size(), width));
  }
  const auto rows_of = [&](std::size_t begin, std::size_t end) {
    return std::span(cloud.values).subspan(begin * width, (end - begin) * width);
  };
  std::vector<std::uint32_t> curve;
  if (model.context) curve = spatial::curve_order(positions);
  return classify_rows(positions, curve, cloud.order, rows_of, model, nullptr);
}

}  // namespace pcednet::detect
