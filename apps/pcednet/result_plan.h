#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "batch.h"
#include "common.h"
#include "view_options.h"

namespace pcednet::app {

/// Where the user wants the results of `classify`.
struct ResultArguments {
  std::string output;        ///< file, for a single input; empty: beside the input
  std::string folder;        ///< for all results; empty: beside the inputs
  PreviewArguments preview;  ///< of several inputs: with the name of the input added
  bool skip_existing = false;
};

/// An input and its results.
struct Job {
  std::filesystem::path input, output;
  std::filesystem::path preview;  ///< empty: none
};

/// The inputs to work on, and the number of those that have their result already.
struct ResultPlan {
  std::vector<Job> jobs;
  std::size_t skipped = 0;
};

/// The inputs but for those that classify wrote beside others of them, for work that needs labels.
std::vector<std::filesystem::path> without_results(
    const std::vector<std::filesystem::path>& inputs);

/// Warns of attributes of an input that its result replaces.
void warn_of_replaced(const std::string& input, const std::vector<std::string>& attributes);

/// Plans the results of `inputs`, before any work: LAS for LAS, LAZ for LAZ and COPC, PLY for
/// everything else.
/// Inputs that are results of others, those of an earlier run on the same folder, are left out.
/// The folder must exist. Throws Error(kUsage) if results exist that may not be replaced, if two
/// would be the same file or if one cannot be written.
ResultPlan plan_results(const Inputs& inputs, const ResultArguments& arguments,
                        const Common& common);

}  // namespace pcednet::app
