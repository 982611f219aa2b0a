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

/// A network that was trained, and what that took.
struct StoredModel {
  detect::EdgeModel model = {};
  Costs costs = {};
  std::vector<EpochPoint> epochs = {};
};

/// How a cloud was classified, or why it could not be.
struct StoredClasses {
  std::vector<std::uint8_t> classes = {};  ///< a byte a point
  eval::ConfusionCounts sharp = {};        ///< agreement with the labels, Positive::kSharp
  eval::ConfusionCounts edge = {};         ///< the same, Positive::kEdge
  std::string failure = {};
  Costs costs = {};
};

/// Results that are kept in a folder, each under the text that decides it. A file that is damaged,
/// or of another text, counts as missing.
class Cache {
 public:
  /// Makes the folder if need be. Throws Error(kFailure) if that is impossible.
  explicit Cache(std::filesystem::path folder);

  std::optional<StoredModel> find_model(const std::string& key) const;
  std::optional<StoredClasses> find_classes(const std::string& key) const;

  /// These throw Error(kFailure) when the disk takes no more.
  void keep(const std::string& key, const StoredModel& model) const;
  void keep(const std::string& key, const StoredClasses& classes) const;

 private:
  /// The file of `key`; its name begins with `kind` and ends in `extension`.
  std::filesystem::path file(const std::string& kind, const std::string& key,
                             const std::string& extension) const;

  std::filesystem::path folder_;
};

}  // namespace pcednet::study
