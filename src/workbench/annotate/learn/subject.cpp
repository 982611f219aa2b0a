#include "workbench/annotate/learn/subject.h"

#include <algorithm>

#include "pcednet/detect/decide.h"
#include "pcednet/detect/describe.h"

namespace pcednet::annotate {

std::vector<std::uint32_t> first_points(const Subject& subject) {
  std::vector<std::uint32_t> firsts;
  std::size_t next = 0;
  for (const SubjectCloud& cloud : subject.clouds) {
    firsts.push_back(static_cast<std::uint32_t>(next));
    next += cloud.positions.size();
  }
  return firsts;
}

detect::Classification joined(std::vector<detect::Classification> found) {
  if (found.size() == 1) return std::move(found.front());
  detect::Classification all;
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (const detect::Classification& one : found) {
    append(all.classes, one.classes);
    append(all.p_sharp, one.p_sharp);
    append(all.p_smooth, one.p_smooth);
    append(all.p_class, one.p_class);
  }
  all.counts = detect::count_classes(all.classes);
  return all;
}

detect::Classification part_of(const detect::Classification& found, std::size_t first,
                               std::size_t count) {
  if (count == found.classes.size()) return found;
  const auto cut = [&](const auto& all) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
    return std::decay_t<decltype(all)>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  detect::Classification part;
  part.classes = cut(found.classes);
  part.p_sharp = cut(found.p_sharp);
  part.p_smooth = cut(found.p_smooth);
  if (!found.p_class.empty()) part.p_class = cut(found.p_class);
  part.counts = detect::count_classes(part.classes);
  return part;
}

std::vector<detect::Classification> classify_each(const Subject& subject,
                                                  const detect::EdgeModel& model,
                                                  const Progress* progress) {
  const Progress cancel_only = without_report(progress);
  std::vector<detect::Classification> found;
  for (const auto& [described, positions, curve] : subject.clouds) {
    found.push_back(detect::classify(described.cloud, positions, model, &cancel_only));
  }
  return found;
}

detect::Classification classify(const Subject& subject, const detect::EdgeModel& model,
                                const Progress* progress) {
  return joined(classify_each(subject, model, progress));
}

std::span<const float> Rows::row(std::size_t row) const {
  const auto k =
      static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), row) - ends.begin());
  return clouds[k].values.subspan((row - (k == 0 ? 0 : ends[k - 1])) * width, width);
}

Rows joined_rows(std::vector<CloudRows> clouds, std::span<const std::uint32_t> firsts,
                 std::size_t width) {
  Rows rows{.width = width};
  std::size_t end = 0;
  for (const CloudRows& cloud : clouds) rows.ends.push_back(end += cloud.points.size());
  rows.points.reserve(end);
  for (std::size_t k = 0; k < clouds.size(); ++k) {
    for (const std::uint32_t i : clouds[k].points) rows.points.push_back(firsts[k] + i);
  }
  rows.clouds = std::move(clouds);
  return rows;
}

Rows described_rows(const Subject& subject) {
  std::size_t width = 0;
  std::vector<CloudRows> clouds;
  for (const SubjectCloud& one : subject.clouds) {
    const detect::DescribedCloud& cloud = one.described.cloud;
    if (!cloud.order.empty()) width = cloud.values.size() / cloud.order.size();
    clouds.push_back({cloud.order, cloud.values});
  }
  return joined_rows(std::move(clouds), first_points(subject), width);
}

}  // namespace pcednet::annotate
