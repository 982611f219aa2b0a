#include "pcednet/detect/classify.h"

#include <fmt/format.h>

#include "pcednet/core/blocks.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/context.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/part_of_cloud.h"
#include "pcednet/nn/predict.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

/// Points that are classified at once where their descriptions are there: few pauses for all
/// threads, and cancelled soon.
constexpr std::size_t kDescribedBlock = 8 * kBlock;

/// Classifies the points `order` of a cloud of `points`, whose descriptions rows_of(begin, end)
/// gives for so many at a time.
template <typename RowsOf>
Classification decide_rows(std::size_t points, std::span<const std::uint32_t> order,
                           std::size_t at_a_time, const RowsOf& rows_of, const EdgeModel& model,
                           const Progress* progress) {
  Classification found = nothing_found(points, has_own_classes(model.table));
  Stage stage(progress, "describe", order.size());
  for_each_block(order.size(), at_a_time, [&](std::size_t begin, std::size_t end) {
    const auto block = order.subspan(begin, end - begin);
    decide(block, nn::predict(model.network, rows_of(begin, end)), model, found);
    stage.advance(block.size());
  });
  return found;
}

/// The points of `order` that are to get a label in `part`.
std::vector<std::uint32_t> wanted_of(std::span<const std::uint32_t> order,
                                     const PartOfCloud& part) {
  std::vector<std::uint32_t> wanted(order.begin(), order.end());
  std::erase_if(wanted, [&](std::uint32_t i) { return part.wanted[i] == 0; });
  return wanted;
}

/// Holds the scale space no longer than it is needed.
Classification describe_and_decide(const PreparedCloud& cloud, const EdgeModel& model,
                                   const Progress* progress) {
  const gls::PyramidPlan* whole = cloud.part ? &cloud.part->pyramid : nullptr;
  const gls::ScaleSpace space({cloud.positions, cloud.normals, cloud.curve, whole},
                              model.descriptor, progress);
  std::vector<std::uint32_t> wanted;
  if (cloud.part) wanted = wanted_of(space.order(), *cloud.part);
  const auto order = cloud.part ? std::span<const std::uint32_t>(wanted) : space.order();
  const std::size_t width = row_width(model.descriptor);
  std::vector<float> rows(std::min(kBlock, order.size()) * width);
  const Progress cancel_only = without_report(progress);
  const auto rows_of = [&](std::size_t begin, std::size_t end) {
    const auto some = std::span(rows).first((end - begin) * width);
    describe(space, order.subspan(begin, end - begin), some, &cancel_only);
    return some;
  };
  Classification found =
      decide_rows(cloud.positions.size(), order, kBlock, rows_of, model, progress);
  found.s_min = space.scales().front();
  found.s_max = space.scales().back();
  found.note = gls::note_on(model.descriptor, space.scales(), cloud.positions);
  return found;
}

/// Whether the model's networks for sparse clouds decide. Copies of a point, which are neighbours
/// on the curve, do not count: they say nothing of the surface. A cloud whose scales are given is a
/// piece of a larger one.
bool is_sparse(const EdgeModel& model, std::span<const Vec3> positions,
               std::span<const std::uint32_t> curve) {
  if (model.descriptor.s_min > 0.0 && model.descriptor.s_max > 0.0) return false;
  std::size_t distinct = 0;
  for (std::size_t i = 0; i < curve.size() && distinct < model.sparse->fewer_than; ++i) {
    distinct += i == 0 || positions[curve[i]] != positions[curve[i - 1]];
  }
  return distinct < model.sparse->fewer_than;
}

/// The model with the networks that decide.
EdgeModel chosen(const EdgeModel& model, bool sparse) {
  return suited_to(model, sparse ? 0 : model.sparse->fewer_than);
}

}  // namespace

Classification classify(const PreparedCloud& cloud, const EdgeModel& model,
                        const Progress* progress) {
  if (model.sparse) {
    const bool sparse = cloud.part ? cloud.part->points < model.sparse->fewer_than
                                   : is_sparse(model, cloud.positions, cloud.curve);
    Classification found = classify(cloud, chosen(model, sparse), progress);
    found.sparse = sparse;
    return found;
  }
  Classification found = describe_and_decide(cloud, model, progress);
  if (model.context) {
    apply_context(model, cloud.positions, cloud.curve, found, progress);
  }
  found.counts = count_classes(found.classes);
  return found;
}

Classification classify(const DescribedCloud& cloud, std::span<const Vec3> positions,
                        const EdgeModel& model, const Progress* progress) {
  if (model.sparse) {
    const bool sparse = is_sparse(model, positions, cloud.order);
    Classification found = classify(cloud, positions, chosen(model, sparse), progress);
    found.sparse = sparse;
    return found;
  }
  const std::size_t width = row_width(model.descriptor);
  if (cloud.values.size() != cloud.order.size() * width || positions.size() != cloud.points) {
    throw Error(ErrorKind::kModelMismatch,
                fmt::format("{} numbers describe {} of {} points; the model wants {} for each",
                            cloud.values.size(), cloud.points, positions.size(), width));
  }
  const auto rows_of = [&](std::size_t begin, std::size_t end) {
    return std::span(cloud.values).subspan(begin * width, (end - begin) * width);
  };
  Classification found =
      decide_rows(cloud.points, cloud.order, kDescribedBlock, rows_of, model, progress);
  if (model.context) {
    const auto curve = spatial::curve_order(positions);
    apply_context(model, positions, curve, found, progress);
  }
  found.counts = count_classes(found.classes);
  return found;
}

}  // namespace pcednet::detect
