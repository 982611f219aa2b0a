#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/class_table.h"
#include "pcednet/eval/scores.h"

namespace pcednet::eval {

/// The confusion counts of every class against all others, for any classes, summed over clouds.
struct ClassReport {
  ClassTable table = {};
  std::vector<ConfusionCounts> counts = {};  ///< by class
  std::size_t clouds = 0, points = 0, right = 0;
};

/// Adds a cloud; both spans have a class per point. A point whose truth is not a class of the table
/// is left out. Throws Error(kInsufficient) if the sizes differ.
void add_cloud(std::span<const std::uint8_t> truth, std::span<const std::uint8_t> predicted,
               ClassReport& report);

/// {"classes":[{"id","name","points","precision","recall","f1","iou"}],"mean":{...},"accuracy",
/// "points","clouds"}, indented, with a final newline. "mean" is the macro average over the classes
/// that occur in the truth.
std::string to_json(const ClassReport& report);

/// A text table: a row per class, then their mean and the accuracy.
std::string to_table(const ClassReport& report);

}  // namespace pcednet::eval
