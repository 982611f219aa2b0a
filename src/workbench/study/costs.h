#pragma once

#include <string>

#include "pcednet/core/stopwatch.h"

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

}  // namespace pcednet::study
