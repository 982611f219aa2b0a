#include "pcednet/tiles/label_points.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

#include "pcednet/core/bytes.h"
#include "pcednet/detect/decide.h"

namespace pcednet::tiles {
namespace {

// A point's record: its class, both probabilities of edges, that of an own class, its normal if
// some are made.
constexpr std::size_t kSharpAt = 1, kSmoothAt = 5, kClassAt = 9, kNormalAt = 13;
constexpr std::size_t kBytesOfNormal = 3 * sizeof(double);

std::size_t record_bytes(bool normals) {
  return kNormalAt + (normals ? kBytesOfNormal : 0);
}

void add_tile(const detect::Classification& tile, bool is_first, detect::Classification& whole) {
  whole.counts += tile.counts;
  whole.s_max = std::max(whole.s_max, tile.s_max);
  if (is_first) {
    whole.expert = tile.expert;
  } else if (whole.expert != tile.expert) {
    whole.expert.reset();
  }
}

}  // namespace

PointLabels::PointLabels(const std::filesystem::path& beside, bool own_classes, bool normals)
    : own_classes_(own_classes), normals_(normals), file_(beside) {}

void PointLabels::put(std::span<const std::uint64_t> numbers, const TileFindings& findings) {
  std::vector<std::uint32_t> order(numbers.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return numbers[a] < numbers[b]; });
  const std::size_t stride = record_bytes(normals_);
  std::vector<std::byte> rows(stride * order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint32_t i = order[k];
    std::byte* const row = &rows[k * stride];
    store(row, findings.found.classes[i]);
    store(row + kSharpAt, findings.found.p_sharp[i]);
    store(row + kSmoothAt, findings.found.p_smooth[i]);
    if (own_classes_) store(row + kClassAt, findings.found.p_class[i]);
    if (!normals_ || findings.made.empty()) continue;
    std::memcpy(row + kNormalAt, findings.made[i].data(), kBytesOfNormal);
  }
  // Numbers that follow each other are written together.
  for (std::size_t k = 0, end = 0; k < order.size(); k = end) {
    for (end = k + 1; end < order.size() && numbers[order[end]] == numbers[order[end - 1]] + 1;) {
      ++end;
    }
    file_.write_at(numbers[order[k]] * stride,
                   std::span(rows).subspan(k * stride, (end - k) * stride));
  }
}

TileFindings PointLabels::get(std::size_t begin, std::size_t end) const {
  const std::size_t stride = record_bytes(normals_);
  std::vector<std::byte> rows((end - begin) * stride);
  file_.read(begin * stride, rows);
  TileFindings findings{.found = detect::nothing_found(end - begin, own_classes_)};
  if (normals_) findings.made.resize(end - begin);
  for (std::size_t i = 0; i < end - begin; ++i) {
    const std::byte* const row = &rows[i * stride];
    findings.found.classes[i] = load<std::uint8_t>(row);
    findings.found.p_sharp[i] = load<float>(row + kSharpAt);
    findings.found.p_smooth[i] = load<float>(row + kSmoothAt);
    if (own_classes_) findings.found.p_class[i] = load<float>(row + kClassAt);
    if (!normals_) continue;
    std::memcpy(findings.made[i].data(), row + kNormalAt, kBytesOfNormal);
  }
  findings.found.counts = detect::count_classes(findings.found.classes);
  return findings;
}

detect::Classification label_points(const Plan& plan, const detect::EdgeModel* model,
                                    PointLabels& labels, const Progress* progress) {
  detect::Classification whole{.s_min = plan.s_min};
  const Progress quiet = without_report(progress);
  Stage stage(progress, "tiles", plan.points());
  for (std::size_t id = 0; id < plan.tiles.size(); ++id) {
    TileCloud points = read_tile(plan, id, &quiet);
    const TileFindings findings = classify_tile(plan, id, model, points, &quiet);
    labels.put(points.numbers, findings);
    add_tile(findings.found, id == 0, whole);
    stage.advance(points.core.size());
  }
  return whole;
}

}  // namespace pcednet::tiles
