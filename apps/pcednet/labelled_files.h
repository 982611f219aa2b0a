#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"
#include "pcednet/detect/train.h"
#include "result_plan.h"

namespace pcednet::app {

/// Codes for the LAS field Classification: pairs of a class and its code.
using LasCodes = std::vector<std::pair<std::uint8_t, std::uint8_t>>;

/// Those of --las-classification, comma-separated pairs class=code; there are `classes` classes.
/// Throws Error(kUsage) for others.
LasCodes las_codes(const std::string& pairs, std::size_t classes);

/// Adds --las-classification, which tells how labels are coded in the field Classification.
void add_label_codes_option(CLI::App& command, std::string& pairs);

/// Those of --las-classification for edge classes, to read labels. Throws Error(kUsage) as
/// las_codes(), and if a code stands for two classes.
LasCodes label_codes(const std::string& pairs);

/// Throws Error(kUsage) if an output would keep a point format of its input that cannot hold the
/// codes. Reads only the beginnings of the inputs; those that cannot be read are passed over.
void check_codes_fit(const LasCodes& codes, const std::vector<Job>& jobs);

/// The same for an input that has been read.
void check_codes_fit(const LasCodes& codes, const Job& job, const PointCloud& cloud);

/// Sets the field of the points of these classes; the others keep what they have.
void set_las_codes(const LasCodes& codes, const std::vector<std::uint8_t>& classes,
                   PointCloud& cloud);

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
