#include "pcednet/detect/averages.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "pcednet/detect/decide.h"

namespace pcednet::detect {
namespace {

template <typename T>
std::vector<T> for_all(const PreparedCloud& prepared, const std::vector<T>& values,
                       const std::type_identity_t<T>& missing) {
  if (values.empty()) return {};
  std::vector<T> all(prepared.average_of.size(), missing);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (prepared.average_of[i] != kNoAverage) all[i] = values[prepared.average_of[i]];
  }
  return all;
}

std::vector<float> means_of(const PreparedCloud& prepared, const std::vector<float>& values) {
  if (values.empty()) return {};
  std::vector<double> sums(prepared.positions.size(), 0.0), counts(sums.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint32_t own = prepared.average_of[i];
    if (own == kNoAverage) continue;
    sums[own] += static_cast<double>(values[i]);
    counts[own] += 1.0;
  }
  std::vector<float> means(sums.size());
  for (std::size_t i = 0; i < means.size(); ++i) {
    means[i] = static_cast<float>(sums[i] / counts[i]);
  }
  return means;
}

}  // namespace

bool averages_noise(const EdgeModel& model) {
  return !model.experts.empty() && model.descriptor.range.s_min == 0.0;
}

Classification of_all_points(const PreparedCloud& prepared, Classification found) {
  if (!prepared.is_averaged()) return found;
  found.classes = for_all(prepared, found.classes, kUnlabelled);
  found.p_sharp = for_all(prepared, found.p_sharp, 0.0f);
  found.p_smooth = for_all(prepared, found.p_smooth, 0.0f);
  found.p_class = for_all(prepared, found.p_class, 0.0f);
  found.counts = count_classes(found.classes);
  return found;
}

std::vector<Vec3> of_all_points(const PreparedCloud& prepared, std::vector<Vec3> normals) {
  if (!prepared.is_averaged()) return normals;
  return for_all(prepared, normals, Vec3::Zero());
}

Classification of_averages(const PreparedCloud& prepared, Classification found) {
  if (!prepared.is_averaged()) return found;
  std::vector<std::array<std::uint32_t, kBoundary + 1>> votes(prepared.positions.size());
  for (std::size_t i = 0; i < found.classes.size(); ++i) {
    const std::uint8_t its_class = found.classes[i];
    if (prepared.average_of[i] == kNoAverage || its_class == kUnlabelled) continue;
    ++votes[prepared.average_of[i]][its_class <= kBoundary ? its_class : 0];
  }
  Classification fewer;
  for (const auto& of_point : votes) {
    const auto most = std::max_element(of_point.begin(), of_point.end());
    fewer.classes.push_back(static_cast<std::uint8_t>(most - of_point.begin()));
    if (*most == 0) fewer.classes.back() = kUnlabelled;
  }
  fewer.p_sharp = means_of(prepared, found.p_sharp);
  fewer.p_smooth = means_of(prepared, found.p_smooth);
  fewer.counts = count_classes(fewer.classes);
  return fewer;
}

}  // namespace pcednet::detect
