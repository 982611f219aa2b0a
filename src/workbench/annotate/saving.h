#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "pcednet/io/drawing/drawing.h"
#include "workbench/annotate/scene/line_review.h"
#include "workbench/annotate/scene/scene.h"

namespace pcednet::annotate {

enum class Saved { kCloud, kModel, kProject, kLines };

/// `<stem>_annotation.json` beside the input.
std::filesystem::path default_project(const std::filesystem::path& input);

/// The path of `what`: `name`, or the default name, beside the input. Throws Error(kUsage) unless
/// `name` is empty or a plain file name of `what` that is neither an input, the journal, another's
/// project nor one of `starts`, the models that the project's runs start from. The default name of
/// a model is none of these. A cloud goes beside its own input, the rest beside the first.
std::filesystem::path saving_path(Saved what, const std::string& name,
                                  std::span<const std::filesystem::path> inputs, std::size_t cloud,
                                  const std::filesystem::path& project,
                                  std::span<const std::filesystem::path> starts = {});

/// Writes the accepted lines of a cloud as `pcednet lines` does, with its coordinate system; `arcs`
/// is for DXF. Throws Error(kInsufficient) as accepted_curves().
void write_lines(const std::filesystem::path& path, const LineReview& review,
                 const PointCloud& cloud, Overwrite overwrite, io::DxfArcs arcs);

/// The cloud to save: with its painted labels and, if there is one, the prediction. Own classes go
/// into its comments.
PointCloud saved_cloud(const Scene& scene, const std::vector<std::uint8_t>& labels,
                       const ClassTable& table, const Prediction* prediction);

}  // namespace pcednet::annotate
