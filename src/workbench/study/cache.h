#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/core/stopwatch.h"
#include "pcednet/detect/model.h"
#include "pcednet/eval/scores.h"
#include "workbench/study/plan.h"

namespace pcednet::study {

/// The cost of a piece of work.
struct Cost {
  double seconds = 0, joules = 0;

  Cost& operator+=(const Cost& other) {
    seconds += other.seconds;
    joules += other.joules;
    return *this;
  }
};

/// The costs of the parts of a result.
struct Costs {
  Cost normals = {};            ///< estimating and orienting those of the test clouds
  Cost describe = {};           ///< the test clouds
  Cost describe_training = {};  ///< the training clouds
  Cost train = {};              ///< the network, from descriptions
  Cost classify = {};           ///< the test clouds, from descriptions

  Costs& operator+=(const Costs& other);
};

/// The energy that the processor used: read from the RAPL counters where Linux exposes them,
/// otherwise estimated as processor seconds of this program x the design power of a core, as Himeur
/// et al. 2021 do.
class EnergyMeter {
 public:
  explicit EnergyMeter(double watts_per_core);

  /// Time and energy since the last call, or since the meter was made.
  Cost lap();

  bool has_counters() const { return has_counters_; }

 private:
  double joules_now() const;

  double watts_per_core_;
  bool has_counters_;
  double joules_;
  Stopwatch watch_ = {};
};

/// The processor's name and the threads in use: "AMD EPYC, 2 threads".
std::string machine_name();

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

// The determinants of a result, as text: results with equal text are equal.

std::string text_of(const detect::TrainOptions& options);
std::string text_of(const Treatment& treatment);

/// The digests of the clouds.
std::string text_of(const CloudSet& set);

/// The digest of the running program and its vector instructions, so that results of another
/// program are not taken for those of this one.
std::string this_program();

}  // namespace pcednet::study
