#include "workbench/annotate/scene/line_review.h"

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <string_view>

#include "pcednet/core/digest.h"
#include "pcednet/core/error.h"
#include "pcednet/core/output_file.h"
#include "workbench/annotate/scene/not_found.h"

namespace pcednet::annotate {
namespace {

constexpr double kDrawnTolerance = 0.1;     // spacings
constexpr std::size_t kNormalsAround = 24;  // points on both sides of an edge

/// The place at half the length of a polyline.
Vec3 middle_of(const std::vector<Vec3>& path) {
  double left = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) left += 0.5 * (path[i] - path[i - 1]).norm();
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double length = (path[i] - path[i - 1]).norm();
    if (length > 0.0 && left <= length) {
      return path[i - 1] + left / length * (path[i] - path[i - 1]);
    }
    left -= length;
  }
  return path.back();
}

constexpr std::string_view kDecisionsFormat = "pcednet-decisions-1";
constexpr std::string_view kDecisionLetters = "oar";  // in the order of Decision

std::string digest_of(std::span<const lines::Curve> curves) {
  Digest digest;
  for (const lines::Curve& curve : curves) {
    digest.add(name_of(curve.kind));
    for (const Vec3& point : curve.points) digest.add_values(std::span(point.data(), 3));
    digest.add_values(std::span(curve.centre.data(), 3));
    digest.add_values(std::span(curve.axis.data(), 3));
  }
  return digest.hex();
}

}  // namespace

void decide(LineReview& review, const LinesDecided& wanted) {
  if (wanted.version != review.version || !review.curves) {
    throw Error(ErrorKind::kInsufficient, "the lines have been found again: review these first");
  }
  for (const std::uint32_t line : wanted.lines) {
    if (line >= review.decisions.size()) throw NotFound(fmt::format("there is no line {}", line));
  }
  for (const std::uint32_t line : wanted.lines) review.decisions[line] = wanted.decision;
}

std::vector<lines::Curve> accepted_curves(const LineReview& review) {
  std::vector<lines::Curve> accepted;
  for (std::size_t i = 0; i < review.decisions.size(); ++i) {
    if (review.decisions[i] == Decision::kAccepted) accepted.push_back((*review.curves)[i]);
  }
  if (accepted.empty()) {
    throw Error(ErrorKind::kInsufficient, "no line is accepted yet: find and accept some");
  }
  return accepted;
}

CurveView view_of(const lines::Curve& curve, const Scene& scene) {
  CurveView view{.path = lines::sampled(curve, kDrawnTolerance * scene.spacing)};
  view.middle = middle_of(view.path);
  std::vector<spatial::Neighbour> near;
  scene.selector->tree().nearest(view.middle, kNormalsAround, near);
  for (const spatial::Neighbour& one : near) view.normal += scene.prepared.normals[one.index];
  view.normal.normalize();
  view.middle -= scene.origin;
  for (Vec3& vertex : view.path) vertex -= scene.origin;
  return view;
}

std::filesystem::path decisions_of(std::filesystem::path project, std::size_t cloud) {
  project += cloud == 0 ? ".lines" : fmt::format(".lines-{}", cloud + 1);
  return project;
}

void keep_decisions(const std::filesystem::path& file, const LineReview& review) {
  std::string letters;
  for (const Decision decision : review.decisions) {
    letters += kDecisionLetters[static_cast<std::size_t>(decision)];
  }
  write_text_file(file,
                  fmt::format("{} {}\n{}\n", kDecisionsFormat, digest_of(*review.curves), letters),
                  Overwrite::kYes);
}

std::vector<Decision> kept_decisions(const std::filesystem::path& file,
                                     std::span<const lines::Curve> curves) {
  std::vector<Decision> decisions(curves.size(), Decision::kOpen);
  std::ifstream text(file);
  std::string format, digest, letters;
  text >> format >> digest >> letters;
  if (format != kDecisionsFormat || digest != digest_of(curves) ||
      letters.size() != curves.size()) {
    return decisions;
  }
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    const std::size_t letter = kDecisionLetters.find(letters[i]);
    if (letter != std::string_view::npos) decisions[i] = static_cast<Decision>(letter);
  }
  return decisions;
}

}  // namespace pcednet::annotate
