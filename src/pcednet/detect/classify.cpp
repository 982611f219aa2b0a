#include "pcednet/detect/classify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/blocks.h"
#include "pcednet/core/error.h"
#include "pcednet/core/median.h"
#include "pcednet/detect/acute_edge.h"
#include "pcednet/detect/context.h"
#include "pcednet/detect/crease_kind.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/octaves.h"
#include "pcednet/detect/piece.h"
#include "pcednet/gls/scales.h"
#include "pcednet/nn/predict.h"

namespace pcednet::detect {
namespace {

/// Points classified at once from existing descriptions: few pauses for all threads, and quick
/// cancellation.
constexpr std::size_t kDescribedBlock = 8 * kBlock;

/// Classifies the points `order`; rows_of(begin, end) gives the descriptions of at most `at_a_time`
/// of them.
template <typename RowsOf>
void decide_rows(std::span<const std::uint32_t> order, std::size_t at_a_time, const RowsOf& rows_of,
                 const EdgeModel& model, Stage& stage, Classification& found) {
  for_each_block(order.size(), at_a_time, [&](std::size_t begin, std::size_t end) {
    const auto block = order.subspan(begin, end - begin);
    decide(block, nn::predict(model.network, rows_of(begin, end)), model, found);
    stage.advance(block.size());
  });
}

/// That hardly a point has neighbours at given scales, as where their unit is another; empty if
/// they have.
std::string note_on_given(const PreparedCloud& cloud, const gls::ScaleRange& given, double s_max) {
  const double diagonal = bounding_box(cloud.positions).diagonal();
  const bool is_given = given.s_min > 0.0 || given.s_max > 0.0;
  // Points of a surface are not further apart.
  if (!is_given || s_max * std::sqrt(static_cast<double>(cloud.curve.size())) > diagonal) return {};
  const double spacing = median(gls::spacings_of_places(cloud.positions, cloud.curve));
  if (s_max > spacing) return {};
  return fmt::format(
      "the largest scale, {:.4g}, reaches hardly a point, as the ten nearest are {:.4g} away: "
      "nearly all become non-edge; is it in the unit of the cloud?",
      s_max, spacing);
}

/// Holds a scale space only while needed.
Classification describe_and_decide(const PreparedCloud& cloud, const EdgeModel& model,
                                   const Progress* progress) {
  Classification found;
  const std::size_t width = row_width(model.descriptor);
  std::vector<float> rows(std::min(kBlock, cloud.curve.size()) * width);
  const Progress cancel_only = without_report(progress);
  std::optional<Stage> stage;
  for_each_octave(cloud, model.descriptor, progress, [&](const auto& space, const auto& points) {
    if (!stage) {
      // Not before: the memory is needed most while a space is made.
      found = nothing_found(cloud.positions.size(), has_own_classes(model.table));
      stage.emplace(progress, "describe", cloud.curve.size());
      found.s_min = space.scales().front();
      found.note = gls::note_on(model.descriptor, space.scales(), cloud.positions);
      if (found.note.empty()) {
        found.note = note_on_given(cloud, model.descriptor.range, space.scales().back());
      }
    }
    found.s_max = space.scales().back();
    const auto rows_of = [&](std::size_t begin, std::size_t end) {
      const auto some = std::span(rows).first((end - begin) * width);
      describe(space, points.subspan(begin, end - begin), some, &cancel_only);
      return some;
    };
    decide_rows(points, kBlock, rows_of, model, *stage, found);
  });
  return found;
}

/// Whether the distance to the crease decides between sharp-edge and smooth-edge.
bool is_by_creases(const EdgeModel& model, const Expert* expert) {
  constexpr std::size_t kWithSmooth = 3;
  return expert != nullptr && expert->kind.exact && edge_outputs(model).size() == kWithSmooth;
}

/// A cloud, however it is described.
struct Subject {
  std::span<const Vec3> positions;
  std::span<const std::uint32_t> curve;  ///< spatial::curve_order() of the positions
  CloudTraits traits;                    ///< if the model asks for any
  std::span<const AcuteEdgePoint> acute_edges;
};

/// decide(model) returns the classification by the model's networks from each point's description;
/// the context network decides last.
template <typename Decide>
Classification classify_with(const Decide& decide, const Subject& subject, const EdgeModel& model,
                             const Progress* progress) {
  const EdgeModel suited = suited_to(model, subject.traits);
  Classification found = decide(suited);
  if (suited.context) {
    apply_context(suited, subject.positions, subject.curve, found, progress);
  }
  const Expert* expert = expert_for(model, subject.traits);
  if (expert) found.expert = expert->kind;
  if (has_edges(model.table)) mark_acute_edges(subject.acute_edges, suited, found);
  if (is_by_creases(model, expert)) {
    apply_crease_kind(subject.positions, subject.curve, found.s_min, suited.least_edge, found);
  }
  found.counts = count_classes(found.classes);
  return found;
}

}  // namespace

Classification classify(const PreparedCloud& cloud, const EdgeModel& model,
                        const Progress* progress) {
  check_consistent(cloud);
  const auto acute_edges = find_acute_edges(cloud, model.descriptor, progress);
  return classify_with(
      [&](const EdgeModel& suited) { return describe_and_decide(cloud, suited, progress); },
      {cloud.positions, cloud.curve, traits_for(model, cloud), acute_edges}, model, progress);
}

Classification classify(const DescribedCloud& cloud, std::span<const Vec3> positions,
                        const EdgeModel& model, const Progress* progress) {
  const std::size_t width = row_width(model.descriptor);
  if (cloud.values.size() != cloud.order.size() * width || positions.size() != cloud.points) {
    throw Error(ErrorKind::kModelMismatch,
                fmt::format("{} numbers describe {} of {} points; the model wants {} for each",
                            cloud.values.size(), cloud.points, positions.size(), width));
  }
  const auto rows_of = [&](std::size_t begin, std::size_t end) {
    return std::span(cloud.values).subspan(begin * width, (end - begin) * width);
  };
  const auto decide = [&](const EdgeModel& suited) {
    Classification found = nothing_found(cloud.points, has_own_classes(suited.table));
    Stage stage(progress, "describe", cloud.order.size());
    decide_rows(cloud.order, kDescribedBlock, rows_of, suited, stage, found);
    found.s_min = cloud.scales.front();
    found.s_max = cloud.scales.back();
    return found;
  };
  return classify_with(decide,
                       {positions, cloud.order, traits_for(model, cloud), cloud.acute_edges}, model,
                       progress);
}

}  // namespace pcednet::detect
