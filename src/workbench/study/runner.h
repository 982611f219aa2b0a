#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/eval/report.h"
#include "workbench/study/cache.h"
#include "workbench/study/plan.h"

namespace pcednet::study {

struct RunOptions {
  std::vector<std::uint64_t> seeds = {1};
  double watts_per_core = 9.0;  ///< where energy cannot be read; that of the paper's processor
  std::function<void(const std::string&)> on_job = {};  ///< called as each job begins
};

/// A variant on a set with a seed.
struct Result {
  std::size_t variant = 0;  ///< in the experiment
  std::string set = {};
  std::optional<std::uint64_t> seed = {};  ///< of methods with randomness
  std::optional<std::size_t> parameters = {};
  eval::Positive positive = eval::Positive::kSharp;
  std::vector<eval::CloudScore> scores = {};
  Costs costs = {};
  double points = 0;  ///< of the test clouds, for their costs
  double training_points = 0;
  /// A byte a point for each cloud of `scores`, if the clouds are those of the files.
  std::vector<std::vector<std::uint8_t>> classes = {};
};

struct Curve {
  std::size_t variant = 0;
  std::uint64_t seed = 0;
  std::vector<EpochPoint> epochs = {};
};

/// The results of an experiment.
struct Study {
  Experiment experiment;
  std::string training = {};  ///< the name of the set that the networks learnt from
  std::vector<std::shared_ptr<const CloudSet>> sets = {};
  std::vector<Result> results = {};  ///< by variant, set, seed, and positive class
  std::vector<Curve> curves = {};
  std::vector<std::string> notes = {};      ///< what was left out, and why
  std::size_t trained = 0, classified = 0;  ///< networks and clouds not in `cache`
};

/// Runs the experiment as far as `cache` does not hold its results. Every training and every
/// classified cloud is kept at once, so that a cancelled run can be resumed.
///
/// A cloud with the positions of a training cloud is not scored with networks trained on it, and a
/// cloud that cannot be described (thinned to nothing, say) is not scored: the notes name both. The
/// scores depend only on data, experiment and seeds, not on the number of threads and the order of
/// the seeds. Throws the errors of the work, including Error(kCancelled), and Error(kInsufficient)
/// if every test cloud is one to learn from.
Study run(const Experiment& experiment, const StudyData& data, const Cache& cache,
          const RunOptions& options, const Progress* progress = nullptr);

}  // namespace pcednet::study
