#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "workbench/annotate/line_review.h"

namespace pcednet::annotate {

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
