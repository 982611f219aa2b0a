#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/context.h"
#include "pcednet/nn/train.h"
#include "workbench/annotate/subject.h"

namespace pcednet::annotate {

/// A model to start from and what it finds in the subject.
struct Start {
  detect::EdgeModel model = {};
  detect::Classification answer = {};
  std::vector<detect::ContextPlaces> places = {};  ///< one per cloud, if there is a context network
};

/// `model`, and its answer for clouds that were described as it wants them.
Start make_start(detect::EdgeModel model, const Subject& subject);

/// A label that training must not see: the point is not painted, nor does the start's answer for it
/// say anything.
inline constexpr std::uint8_t kLeftOut = 254;

/// Epochs of each of the two networks; what adapt() reports counts both.
inline constexpr int kAdaptEpochs = 15;

struct Adapted {
  detect::EdgeModel model = {};
  detect::Classification found = {};  ///< what it finds in the subject
  bool cancelled = false;             ///< nothing else is of use then
  double loss = 0;                    ///< of the last epoch
  double seconds_classify = 0;        ///< of the time that it took
};

/// Teaches a model the painted points without unlearning the rest (self-distillation): the network
/// trains on the painted points with their labels and on a sample of the others with the start's
/// own answers as targets; then the context network does, on what the new network finds. So where
/// nothing was painted the answers stay, unless points of the same description were painted
/// otherwise.
///
/// `labels` has a class of the subject's table that can be painted, kUnlabelled or kLeftOut per
/// point; the start's classes are the first of the table, and for those that it does not know the
/// network gets outputs. Depends on the arguments alone, not on the number of threads or the
/// numbering of the points.
Adapted adapt(const std::string& name, const Start& start, const Subject& subject,
              std::span<const std::uint8_t> labels, std::uint64_t seed,
              const std::function<void(const nn::EpochReport&)>& on_epoch = {},
              const Progress* progress = nullptr);

}  // namespace pcednet::annotate
