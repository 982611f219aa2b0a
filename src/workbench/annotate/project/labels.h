#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/cloud/class_table.h"
#include "workbench/annotate/project/stroke.h"

namespace pcednet::annotate {

inline constexpr std::uint32_t kNoStroke = 0xffffffff;

/// The painted classes of a cloud's points, with undo and redo. Functions that change them return
/// the points concerned, valid until the next change.
class Labels {
 public:
  explicit Labels(std::size_t points) : classes_(points, kUnlabelled) {}

  const std::vector<std::uint8_t>& classes() const { return classes_; }
  std::array<std::size_t, kMostClasses> counts() const { return counts_; }
  std::size_t painted() const;
  std::size_t undo_steps() const { return done_.size(); }
  std::size_t redo_steps() const { return undone_.size(); }

  /// The step that painted each point, from 0; kNoStroke for unpainted points.
  std::vector<std::uint32_t> strokes() const;

  /// Gives the points a class (kUnlabelled: none), as an undoable step even if nothing changes.
  /// Clears the redo steps.
  std::span<const std::uint32_t> paint(std::uint8_t edge_class, std::vector<std::uint32_t> points);

  /// Undoes the last step, or redoes it; does nothing if there is none.
  std::span<const std::uint32_t> undo();
  std::span<const std::uint32_t> redo();

  /// The number of steps that are in effect here and were not in `then`, of which this is the
  /// continuation, or the other way round.
  std::size_t steps_since(const Labels& then) const;

 private:
  struct Step {
    std::size_t number;  ///< of its paint()
    std::vector<std::uint32_t> points;
    std::vector<std::uint8_t> before;
    std::uint8_t after;
  };

  void set(std::uint32_t point, std::uint8_t edge_class);

  std::vector<std::uint8_t> classes_;
  std::array<std::size_t, kMostClasses> counts_ = {};
  std::vector<Step> done_, undone_;
  std::size_t steps_ = 0;  ///< ever painted
};

/// Those of `points` that `stroke` changes: not yet of its class, not protected, not hidden.
/// `prediction` is per point, or empty.
std::vector<std::uint32_t> points_to_change(std::vector<std::uint32_t> points, const Stroke& stroke,
                                            std::span<const std::uint8_t> labels,
                                            std::span<const std::uint8_t> prediction);

}  // namespace pcednet::annotate
