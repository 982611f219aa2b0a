#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "las_codes.h"
#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"
#include "pcednet/detect/train.h"

namespace pcednet::app {

/// A file of a training.
struct LabelledFile {
  std::filesystem::path path;
  PointCloud cloud;
};

/// Reads files and folders, without results of classify, with their labels, in the field
/// Classification if there are codes, and sets the table of `options` to their
/// classes. Warns of what is strange in them. Throws as read_labelled, and Error(kInsufficient)
/// naming the file whose classes are not those of the first.
std::vector<LabelledFile> read_labelled_files(const std::vector<std::string>& inputs,
                                              const LasCodes& codes, bool no_normals,
                                              detect::TrainOptions& options,
                                              const Progress& progress);

/// Throws Error(kInsufficient) if the labels do not allow the training.
void check_can_learn(std::span<const detect::NamedLabels> labels,
                     const detect::TrainOptions& options);

/// Warns if the training may take more memory than is free; `describes_all`: not the labelled
/// points alone.
void warn_of_memory(std::span<const LabelledFile> files, const detect::TrainOptions& options,
                    bool describes_all);

}  // namespace pcednet::app
