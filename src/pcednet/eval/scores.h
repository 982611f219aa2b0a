#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace pcednet::eval {

/// The confusion counts of a binary classification.
struct ConfusionCounts {
  std::size_t tp = 0, fp = 0, tn = 0, fn = 0;

  std::size_t total() const { return tp + fp + tn + fn; }
  ConfusionCounts& operator+=(const ConfusionCounts& other);
  bool operator==(const ConfusionCounts&) const = default;
};

/// The classes that count as positive, both in the truth and in the prediction.
enum class Positive {
  kSharp,     ///< sharp-edge alone
  kEdge,      ///< sharp-edge and smooth-edge
  kBoundary,  ///< boundary alone
};

/// Their names in options.
inline constexpr std::array<std::pair<std::string_view, Positive>, 3> kPositives = {
    {{"sharp", Positive::kSharp}, {"edge", Positive::kEdge}, {"boundary", Positive::kBoundary}}};

bool is_positive(std::uint8_t label, Positive positive);

/// What to say of labels of which `smooth` are smooth-edge and `sharp` sharp-edge: that every score
/// is 0 where sharp-edge alone is positive and none is one, as where a program marks its edges
/// by 1. Otherwise empty.
std::string none_is_positive(std::size_t smooth, std::size_t sharp, Positive positive);

/// Compares the classes of every point; both spans have one class per point. A point whose truth is
/// kUnlabelled is left out; a prediction other than an edge class counts as negative. Throws
/// Error(kInsufficient) if the sizes differ.
ConfusionCounts count_confusion(std::span<const std::uint8_t> truth,
                                std::span<const std::uint8_t> predicted, Positive positive);

/// The same with `positive` alone as the positive class, of any table.
ConfusionCounts count_confusion(std::span<const std::uint8_t> truth,
                                std::span<const std::uint8_t> predicted, std::uint8_t positive);

/// The scores of Himeur et al. 2021, appendix B. A score whose denominator is zero is 0.
struct Scores {
  double precision = 0, recall = 0, mcc = 0, f1 = 0, accuracy = 0, iou = 0;
};
Scores scores_of(const ConfusionCounts& counts);

}  // namespace pcednet::eval
