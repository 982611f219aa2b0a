#include "pcednet/eval/scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"

namespace pcednet::eval {
namespace {

/// Counts points; `is` decides whether a class is positive.
template <typename IsPositive>
ConfusionCounts count_points(std::span<const std::uint8_t> truth,
                             std::span<const std::uint8_t> predicted, const IsPositive& is_one) {
  if (truth.size() != predicted.size()) {
    throw Error(ErrorKind::kInsufficient, fmt::format("{} predicted classes for {} labelled points",
                                                      predicted.size(), truth.size()));
  }
  ConfusionCounts counts;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] == kUnlabelled) continue;
    const bool is = is_one(truth[i]), said = is_one(predicted[i]);
    ++(is ? (said ? counts.tp : counts.fn) : (said ? counts.fp : counts.tn));
  }
  return counts;
}

double ratio(double numerator, double denominator) {
  return denominator == 0.0 ? 0.0 : numerator / denominator;
}

}  // namespace

bool is_positive(std::uint8_t label, Positive positive) {
  switch (positive) {
    case Positive::kSharp:
      return label == kSharpEdge;
    case Positive::kEdge:
      return label == kSharpEdge || label == kSmoothEdge;
    case Positive::kBoundary:
      break;
  }
  return label == kBoundary;
}

std::string none_is_positive(std::size_t smooth, std::size_t sharp, Positive positive) {
  if (positive != Positive::kSharp || sharp > 0 || smooth == 0) return {};
  return fmt::format(
      "{} points are smooth-edge (1), none is sharp-edge (2): positive sharp counts 2 alone, "
      "positive edge both",
      smooth);
}

ConfusionCounts& ConfusionCounts::operator+=(const ConfusionCounts& other) {
  tp += other.tp;
  fp += other.fp;
  tn += other.tn;
  fn += other.fn;
  return *this;
}

ConfusionCounts count_confusion(std::span<const std::uint8_t> truth,
                                std::span<const std::uint8_t> predicted, Positive positive) {
  return count_points(truth, predicted,
                      [&](std::uint8_t label) { return is_positive(label, positive); });
}

ConfusionCounts count_confusion(std::span<const std::uint8_t> truth,
                                std::span<const std::uint8_t> predicted, std::uint8_t positive) {
  return count_points(truth, predicted, [&](std::uint8_t label) { return label == positive; });
}

Scores scores_of(const ConfusionCounts& counts) {
  const auto tp = static_cast<double>(counts.tp), fp = static_cast<double>(counts.fp);
  const auto tn = static_cast<double>(counts.tn), fn = static_cast<double>(counts.fn);
  // In two roots: where all is right, they are exactly tp and tn.
  const double norm = std::sqrt((tp + fp) * (tp + fn)) * std::sqrt((tn + fp) * (tn + fn));
  return {
      .precision = ratio(tp, tp + fp),
      .recall = ratio(tp, tp + fn),
      .mcc = std::clamp(ratio(tp * tn - fp * fn, norm), -1.0, 1.0),
      .f1 = ratio(2 * tp, 2 * tp + fp + fn),
      .accuracy = ratio(tp + tn, tp + tn + fp + fn),
      .iou = ratio(tp, tp + fp + fn),
  };
}

}  // namespace pcednet::eval
