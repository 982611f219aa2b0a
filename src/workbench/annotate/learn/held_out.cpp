#include "workbench/annotate/learn/held_out.h"

#include <algorithm>
#include <array>
#include <map>

#include "pcednet/core/error.h"

namespace pcednet::annotate {
namespace {

constexpr std::uint32_t kMostParts = 4;  // trainings

/// The class of every stroke that is still visible, by its number.
std::map<std::uint32_t, std::uint8_t> classes_of(std::span<const std::uint32_t> strokes,
                                                 std::span<const std::uint8_t> labels) {
  std::map<std::uint32_t, std::uint8_t> classes;
  std::uint32_t last = kNoStroke;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (strokes[i] == kNoStroke || strokes[i] == last) continue;
    classes[last = strokes[i]] = labels[i];
  }
  return classes;
}

/// The part of each stroke: the strokes of a class are dealt in turn. Empty if there are too few.
std::map<std::uint32_t, std::uint32_t> parts_of(
    const std::map<std::uint32_t, std::uint8_t>& classes) {
  std::array<std::uint32_t, kMostClasses> count = {};
  for (const auto& [stroke, edge_class] : classes) ++count[edge_class];
  const auto painted = std::ssize(count) - std::count(count.begin(), count.end(), 0u);
  if (painted < 2 || std::count(count.begin(), count.end(), 1u) > 0) return {};
  const auto most = std::min(kMostParts, *std::max_element(count.begin(), count.end()));
  std::map<std::uint32_t, std::uint32_t> parts;
  std::array<std::uint32_t, kMostClasses> next = {};
  for (const auto& [stroke, edge_class] : classes) parts[stroke] = next[edge_class]++ % most;
  return parts;
}

/// Correct and all predictions, by true class.
struct Tally {
  std::array<double, kMostClasses> right = {}, all = {};

  void add(std::uint8_t truth, std::uint8_t answer) {
    ++all[truth];
    if (truth == answer) ++right[truth];
  }
  double accuracy() const {
    double sum = 0, classes = 0;
    for (std::size_t c = 0; c < all.size(); ++c) {
      if (all[c] == 0) continue;
      sum += right[c] / all[c];
      ++classes;
    }
    return sum / classes;
  }
};

}  // namespace

HeldOut hold_out(const Subject& subject, const Labels& labels, const Settings& settings,
                 const Start* start, const Progress* progress) {
  const std::vector<std::uint32_t> strokes = labels.strokes();
  // Without clouds that joined later.
  std::size_t points = 0;
  for (const SubjectCloud& cloud : subject.clouds) points += cloud.positions.size();
  std::vector<std::uint8_t> truth = labels.classes();
  truth.resize(points);
  const bool has_smooth =
      settings.classes == 3 && !(start && detect::edge_outputs(start->model).size() == 2);
  if (has_edges(subject.table) && !has_smooth) {
    std::replace(truth.begin(), truth.end(), kSmoothEdge, kNonEdge);
  }
  const auto classes = classes_of(strokes, truth);
  const auto parts = parts_of(classes);
  HeldOut held_out{.strokes = classes.size()};
  if (parts.empty()) return held_out;
  std::uint32_t count = 0;
  for (const auto& [stroke, part] : parts) count = std::max(count, part + 1);
  Tally tally, of_start;
  for (std::uint32_t part = 0; part < count; ++part) {
    std::vector<std::uint8_t> shown = truth;
    std::vector<std::uint32_t> asked;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (strokes[i] == kNoStroke || parts.at(strokes[i]) != part) continue;
      shown[i] = kLeftOut;
      asked.push_back(static_cast<std::uint32_t>(i));
    }
    const Adapted learnt = learn("", subject, shown, settings, start, {}, progress);
    if (learnt.cancelled) throw Error(ErrorKind::kCancelled, "cancelled");
    for (const std::uint32_t i : asked) {
      tally.add(truth[i], learnt.found.classes[i]);
      if (start) of_start.add(truth[i], start->answer.classes[i]);
    }
  }
  held_out.accuracy = tally.accuracy();
  if (start) held_out.start = of_start.accuracy();
  return held_out;
}

}  // namespace pcednet::annotate
