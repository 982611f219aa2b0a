#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/detect/model.h"
#include "pcednet/eval/scores.h"
#include "workbench/study/costs.h"

namespace pcednet::study {

/// An epoch of a training, for its curve.
struct EpochPoint {
  int epoch = 0;
  double seconds = 0;  ///< since the training began
  double loss = 0, held_out_loss = 0, held_out_accuracy = 0, held_out_mcc = 0;
};

/// A trained network, and the cost of its training.
struct StoredModel {
  detect::EdgeModel model = {};
  Costs costs = {};
  std::vector<EpochPoint> epochs = {};
};

/// The classification of a cloud, or the reason of its failure.
struct StoredClasses {
  std::vector<std::uint8_t> classes = {};  ///< a byte a point
  eval::ConfusionCounts sharp = {};        ///< agreement with the labels, Positive::kSharp
  eval::ConfusionCounts edge = {};         ///< the same, Positive::kEdge
  std::string failure = {};
  Costs costs = {};
};

/// A folder of results, each under the text that determines it (its key). A file that is damaged,
/// or of another key, counts as missing.
class Cache {
 public:
  /// Makes the folder if needed. Throws Error(kFailure) if that fails.
  explicit Cache(std::filesystem::path folder);

  std::optional<StoredModel> find_model(const std::string& key) const;
  std::optional<StoredClasses> find_classes(const std::string& key) const;

  /// These throw Error(kFailure) when the disk is full.
  void keep(const std::string& key, const StoredModel& model) const;
  void keep(const std::string& key, const StoredClasses& classes) const;

 private:
  /// The file of `key`; its name begins with `kind` and ends in `extension`.
  std::filesystem::path file(const std::string& kind, const std::string& key,
                             const std::string& extension) const;

  std::filesystem::path folder_;
};

}  // namespace pcednet::study
