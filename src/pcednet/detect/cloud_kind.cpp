#include "pcednet/detect/cloud_kind.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "pcednet/detect/part_of_cloud.h"
#include "pcednet/gls/scales.h"
#include "pcednet/normals/estimate.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/middle_half.h"

namespace pcednet::detect {
namespace {

constexpr std::string_view kBelowWord = "below=", kGivenWord = "given",
                           kEstimatedWord = "estimated", kExactWord = "exact", kNoisyWord = "noisy";

bool take_word(std::string_view word, CloudKind& kind) {
  if (word == kGivenWord || word == kEstimatedWord) {
    if (kind.estimated) return false;
    kind.estimated = word == kEstimatedWord;
    return true;
  }
  if (word == kExactWord) return !std::exchange(kind.exact, true);
  if (word == kNoisyWord) return !std::exchange(kind.noisy, true);
  if (!word.starts_with(kBelowWord) || kind.below > 0) return false;
  const char* end = word.data() + word.size();
  const auto read = std::from_chars(word.data() + kBelowWord.size(), end, kind.below);
  return read.ec == std::errc() && read.ptr == end && kind.below > 0;
}

/// Whether the normals agree with estimated ones: within 5 degrees at three points in four. Beside
/// edges, normals of the true surface, or from before the cloud was thinned, differ by 20 degrees
/// and more.
bool are_as_estimated(const PreparedCloud& cloud) {
  const double least_cosine = std::cos(5.0 / 180.0 * std::numbers::pi);
  const auto estimated = normals::estimate_normals(cloud.positions);
  std::vector<double> cosines;
  for (const std::uint32_t i : spatial::firsts_of_places(cloud.positions, cloud.curve)) {
    const Vec3& given = cloud.normals[i];  // agrees with nothing if it is unusable
    cosines.push_back(is_usable(given) ? std::abs(estimated[i].dot(given)) : 0.0);
  }
  const auto quarter = cosines.begin() + static_cast<std::ptrdiff_t>(cosines.size() / 4);
  std::nth_element(cosines.begin(), quarter, cosines.end());
  return quarter != cosines.end() && *quarter > least_cosine;
}

constexpr std::size_t kFew = 20000;  // above, the same networks decide in either case

/// Uneven clouds and pieces count as large: the experts for few points were trained on whole parts
/// of even spacing.
std::size_t points_for_experts(const PreparedCloud& cloud,
                               const gls::ScaleSpaceOptions& descriptor) {
  constexpr std::size_t kPiece = CloudTraits{}.points;
  const bool scales_given = descriptor.range.s_min > 0.0 && descriptor.range.s_max > 0.0;
  if (cloud.part) {
    const bool is_even = gls::octave_count(descriptor.range) == 1;
    return is_even ? cloud.part->points : kPiece;
  }
  if (scales_given) return kPiece;
  const std::size_t points = spatial::firsts_of_places(cloud.positions, cloud.curve).size();
  if (points >= kFew || !descriptor.range.octaves) return points;
  std::vector<double> spacings = gls::spacings_of_places(cloud.positions, cloud.curve);
  return spatial::is_uneven(spatial::middle_half(spacings)) ? kPiece : points;
}

}  // namespace

CloudTraits traits_of(const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor) {
  const bool estimated = cloud.decision.made && !cloud.reoriented;
  CloudTraits traits{.estimated = estimated,
                     .exact = cloud.decision.exact,
                     .noisy = estimated && cloud.decision.noisy};
  traits.points = points_for_experts(cloud, descriptor);
  if (!traits.estimated && traits.points < kFew) traits.estimated = are_as_estimated(cloud);
  return traits;
}

std::string text_of(const CloudKind& kind) {
  std::vector<std::string> words;
  if (kind.below > 0) words.push_back(fmt::format("{}{}", kBelowWord, kind.below));
  if (kind.estimated) words.emplace_back(*kind.estimated ? kEstimatedWord : kGivenWord);
  if (kind.exact) words.emplace_back(kExactWord);
  if (kind.noisy) words.emplace_back(kNoisyWord);
  return fmt::format("{}", fmt::join(words, ","));
}

std::optional<CloudKind> cloud_kind_of(std::string_view text) {
  CloudKind kind;
  for (bool is_last = false; !is_last;) {
    const std::size_t comma = text.find(',');
    is_last = comma == std::string_view::npos;
    if (!take_word(text.substr(0, comma), kind)) return {};
    if (!is_last) text.remove_prefix(comma + 1);
  }
  return kind;
}

}  // namespace pcednet::detect
