#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/detect/model.h"
#include "pcednet/detect/points/prepare.h"

namespace pcednet::detect {

struct ClassCounts {
  std::size_t non_edge = 0, smooth = 0, sharp = 0, boundary = 0, unlabelled = 0;

  std::size_t points() const { return non_edge + smooth + sharp + boundary + unlabelled; }
  ClassCounts& operator+=(const ClassCounts& other) {
    non_edge += other.non_edge, smooth += other.smooth, sharp += other.sharp;
    boundary += other.boundary, unlabelled += other.unlabelled;
    return *this;
  }
};

/// The result of a classification, per point in the order of the cloud.
struct Classification {
  std::vector<std::uint8_t> classes =
      {};  ///< of the model's table, EdgeClass by default; kUnlabelled: the position is not finite
  std::vector<float> p_sharp = {};       ///< probability of sharp-edge, 0 where unlabelled
  std::vector<float> p_smooth = {};      ///< of smooth-edge; 0 throughout with a two-class model
  std::vector<float> p_class = {};       ///< of the class itself; empty with edge classes alone
  ClassCounts counts = {};               ///< of edge classes
  double s_min = 0.0, s_max = 0.0;       ///< the smallest and the largest scale of any point
  std::string note = {};                 ///< for the user, or empty
  std::optional<CloudKind> expert = {};  ///< the kind of cloud whose expert decided
};

/// Describes every point at every scale and classifies it by the network. A point is an edge where
/// that is more probable than not, of the more probable kind; with own classes, the most probable
/// class decides. Works block by block: the scale-space matrix is never held whole. A
/// context network, if the model has one, then decides from the predictions around each point. The
/// result is the same for any number of threads and any order of the points.
///
/// Throws Error(kUsage) for a descriptor that is not possible or leaves no range of scales,
/// Error(kInsufficient) for fewer than two distinct points unless it gives both bounds of the
/// scales, and Error(kCancelled) when `progress` asks to cancel.
Classification classify(const PreparedCloud& cloud, const EdgeModel& model,
                        const Progress* progress = nullptr);

}  // namespace pcednet::detect
