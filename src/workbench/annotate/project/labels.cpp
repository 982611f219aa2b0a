#include "workbench/annotate/project/labels.h"

#include <algorithm>
#include <numeric>

namespace pcednet::annotate {

void Labels::set(std::uint32_t point, std::uint8_t edge_class) {
  std::uint8_t& label = classes_[point];
  if (label < counts_.size()) --counts_[label];
  label = edge_class;
  if (label < counts_.size()) ++counts_[label];
}

std::size_t Labels::painted() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0});
}

std::span<const std::uint32_t> Labels::paint(std::uint8_t edge_class,
                                             std::vector<std::uint32_t> points) {
  Step step{.number = steps_++, .points = std::move(points), .before = {}, .after = edge_class};
  step.before.reserve(step.points.size());
  for (const std::uint32_t point : step.points) {
    step.before.push_back(classes_[point]);
    set(point, edge_class);
  }
  done_.push_back(std::move(step));
  undone_.clear();
  return done_.back().points;
}

std::vector<std::uint32_t> Labels::strokes() const {
  std::vector<std::uint32_t> strokes(classes_.size(), kNoStroke);
  for (std::size_t step = 0; step < done_.size(); ++step) {
    const bool paints = done_[step].after != kUnlabelled;
    for (const std::uint32_t point : done_[step].points) {
      strokes[point] = paints ? static_cast<std::uint32_t>(step) : kNoStroke;
    }
  }
  return strokes;
}

std::span<const std::uint32_t> Labels::undo() {
  if (done_.empty()) return {};
  undone_.push_back(std::move(done_.back()));
  done_.pop_back();
  const Step& step = undone_.back();
  // Backwards: a point that a step names twice gets back what it had before the first time.
  for (std::size_t i = step.points.size(); i-- > 0;) set(step.points[i], step.before[i]);
  return step.points;
}

std::span<const std::uint32_t> Labels::redo() {
  if (undone_.empty()) return {};
  done_.push_back(std::move(undone_.back()));
  undone_.pop_back();
  for (const std::uint32_t point : done_.back().points) set(point, done_.back().after);
  return done_.back().points;
}

std::size_t Labels::steps_since(const Labels& then) const {
  const auto [last_then, last_now] =
      std::mismatch(then.done_.begin(), then.done_.end(), done_.begin(), done_.end(),
                    [](const Step& a, const Step& b) { return a.number == b.number; });
  return static_cast<std::size_t>((then.done_.end() - last_then) + (done_.end() - last_now));
}

std::vector<std::uint32_t> points_to_change(std::vector<std::uint32_t> points, const Stroke& stroke,
                                            std::span<const std::uint8_t> labels,
                                            std::span<const std::uint8_t> prediction) {
  const auto is_hidden = [&](std::uint8_t edge_class) {
    return std::find(stroke.hidden.begin(), stroke.hidden.end(), edge_class) != stroke.hidden.end();
  };
  std::erase_if(points, [&](std::uint32_t i) {
    if (labels[i] == stroke.edge_class) return true;
    if (stroke.protect && labels[i] != kUnlabelled) return true;
    return is_hidden(labels[i]) || (!prediction.empty() && is_hidden(prediction[i]));
  });
  return points;
}

}  // namespace pcednet::annotate
