#include "workbench/annotate/kept_decisions.h"

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <string_view>

#include "pcednet/core/digest.h"
#include "pcednet/core/output_file.h"

namespace pcednet::annotate {
namespace {

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
