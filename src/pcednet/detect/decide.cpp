#include "pcednet/detect/decide.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"

namespace pcednet::detect {
namespace {

/// Calls work(row, point) for every point and its place among them.
template <typename Work>
void for_each_in_parallel(std::span<const std::uint32_t> points, const Work& work) {
  constexpr std::size_t kAnswers = 1 << 12;
  parallel_blocks(points.size(), kAnswers, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) work(row, points[row]);
  });
}

/// Writes the network's answer for one point.
void decide_point(std::span<const float> probabilities, const std::vector<std::uint8_t>& classes,
                  std::size_t point, Classification& found) {
  float sharp = 0.0f, smooth = 0.0f;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    if (classes[c] == kSharpEdge) sharp = probabilities[c];
    if (classes[c] == kSmoothEdge) smooth = probabilities[c];
  }
  found.p_sharp[point] = sharp;
  found.p_smooth[point] = smooth;
  const bool edge = sharp + smooth > 0.5f;
  found.classes[point] = !edge ? kNonEdge : sharp >= smooth ? kSharpEdge : kSmoothEdge;
}

/// The probability of the chosen edge class.
float p_of_edge_class(const Classification& found, std::size_t point) {
  const float sharp = found.p_sharp[point], smooth = found.p_smooth[point];
  const std::uint8_t c = found.classes[point];
  return c == kSharpEdge ? sharp : c == kSmoothEdge ? smooth : 1.0f - sharp - smooth;
}

/// The same where there are own classes.
void decide_own(std::span<const float> probabilities, const EdgeModel& model, bool edges,
                std::size_t point, Classification& found) {
  float own = -1.0f, non_edge = 0.0f, edge = 0.0f;
  std::uint8_t best = 0;
  for (std::size_t c = 0; c < model.classes.size(); ++c) {
    const std::uint8_t id = model.classes[c];
    const float p = probabilities[c];
    if (edges && id <= kSharpEdge) {
      (id == kNonEdge ? non_edge : edge) += p;
    } else if (p > own) {
      own = p;
      best = id;
    }
  }
  if (edges) decide_point(probabilities, model.classes, point, found);
  if (edges && own < std::max(non_edge, edge)) {
    const bool is_edge = edge > non_edge;
    const bool is_sharp = found.p_sharp[point] >= found.p_smooth[point];
    found.classes[point] = !is_edge ? kNonEdge : is_sharp ? kSharpEdge : kSmoothEdge;
    found.p_class[point] =
        is_edge ? std::max(found.p_sharp[point], found.p_smooth[point]) : non_edge;
  } else {
    found.classes[point] = best;
    found.p_class[point] = own;
  }
}

}  // namespace

void check_size(const Classification& found, std::size_t points) {
  const auto fits = [&](std::size_t size) { return size == points; };
  if (fits(found.classes.size()) && fits(found.p_sharp.size()) && fits(found.p_smooth.size()) &&
      (found.p_class.empty() || fits(found.p_class.size()))) {
    return;
  }
  throw Error(ErrorKind::kUsage, fmt::format("a result of {} points, not of the {} of the cloud",
                                             found.classes.size(), points));
}

Classification nothing_found(std::size_t points, bool has_own_classes) {
  return {.classes = std::vector<std::uint8_t>(points, kUnlabelled),
          .p_sharp = std::vector<float>(points, 0.0f),
          .p_smooth = std::vector<float>(points, 0.0f),
          .p_class = std::vector<float>(has_own_classes ? points : 0, 0.0f)};
}

void decide(std::span<const std::uint32_t> points, std::span<const float> probabilities,
            const std::vector<std::uint8_t>& classes, Classification& found) {
  const std::size_t outputs = classes.size();
  for_each_in_parallel(points, [&](std::size_t row, std::uint32_t i) {
    decide_point(probabilities.subspan(row * outputs, outputs), classes, i, found);
    if (!found.p_class.empty()) found.p_class[i] = p_of_edge_class(found, i);
  });
}

void decide(std::span<const std::uint32_t> points, std::span<const float> probabilities,
            const EdgeModel& model, Classification& found) {
  if (found.p_class.empty()) return decide(points, probabilities, model.classes, found);
  const bool edges = has_edges(model.table);
  const std::size_t outputs = model.classes.size();
  for_each_in_parallel(points, [&](std::size_t row, std::uint32_t i) {
    decide_own(probabilities.subspan(row * outputs, outputs), model, edges, i, found);
  });
}

ClassCounts count_classes(const std::vector<std::uint8_t>& classes) {
  const auto count = [&](std::uint8_t wanted) {
    return static_cast<std::size_t>(std::count(classes.begin(), classes.end(), wanted));
  };
  return {count(kNonEdge), count(kSmoothEdge), count(kSharpEdge), count(kBoundary),
          count(kUnlabelled)};
}

}  // namespace pcednet::detect
