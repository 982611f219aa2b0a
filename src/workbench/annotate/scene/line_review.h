#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "pcednet/lines/curves/curve.h"
#include "workbench/annotate/scene/scene.h"

namespace pcednet::annotate {

/// The user's decision on a line.
enum class Decision : std::uint8_t { kOpen, kAccepted, kRejected };

/// The lines that were found last in a cloud, and the decisions on them.
struct LineReview {
  int version = 0;             ///< number of searches for lines
  int prediction_version = 0;  ///< of the prediction that they were found in
  bool is_searching = false;
  std::shared_ptr<const std::vector<lines::Curve>> curves = {};  ///< null before the first time
  std::vector<Decision> decisions = {};                          ///< one per curve
  double tolerance = 0.0;  ///< how far their points may be from the curves
};

/// A request to decide on lines of a version, or its outcome.
struct LinesDecided {
  int version = 0;
  Decision decision = Decision::kOpen;
  std::vector<std::uint32_t> lines = {};  ///< numbers from 0
  std::size_t cloud = 0;                  ///< that they are in
};

/// Throws Error(kInsufficient) if new lines were found since, NotFound for a line that does not
/// exist; changes nothing then.
void decide(LineReview& review, const LinesDecided& wanted);

/// The accepted curves. Throws Error(kInsufficient) if there are none.
std::vector<lines::Curve> accepted_curves(const LineReview& review);

/// The data with which a page draws a curve and moves the view to it. Local coordinates.
struct CurveView {
  std::vector<Vec3> path = {};  ///< as lines::sampled()
  Vec3 middle = Vec3::Zero();   ///< half way along it
  Vec3 normal = Vec3::Zero();   ///< the mean of the surface there
};
CurveView view_of(const lines::Curve& curve, const Scene& scene);

/// The file beside a project that keeps the decisions on the lines of a cloud.
std::filesystem::path decisions_of(std::filesystem::path project, std::size_t cloud);

/// Writes the decisions, with a digest of their lines. Throws Error(kFailure) when the disk is
/// full.
void keep_decisions(const std::filesystem::path& file, const LineReview& review);

/// Those that were kept of the same lines; all open if there are none, if they are of other lines,
/// or if the file is damaged.
std::vector<Decision> kept_decisions(const std::filesystem::path& file,
                                     std::span<const lines::Curve> curves);

}  // namespace pcednet::annotate
