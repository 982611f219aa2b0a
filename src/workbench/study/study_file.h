#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "pcednet/core/output_file.h"
#include "workbench/study/runner.h"

namespace pcednet::study {

struct FileOptions {
  std::string command = {};  ///< that made the study, for readers
  bool energy_is_measured = false;
  double watts_per_core = 0;
};

/// The study as JSON of schema "pcednet-study-1", see docs/study.md. Relative files of clouds are
/// given as seen from `folder`; if that is empty, from the working folder.
std::string to_json(const Study& study, const FileOptions& options,
                    const std::filesystem::path& folder = {});

/// Writes `folder`/NAME.json, and the predictions of the methods as
/// `folder`/predictions/NAME/VARIANT/SET/CLOUD.u8, a byte a point. A file that an earlier run of
/// the same command left there is replaced; otherwise `overwrite` decides.
void write_study(const std::filesystem::path& folder, const Study& study,
                 const FileOptions& options, Overwrite overwrite);

/// Throws Error(kUsage) if write_study() would refuse to write NAME.json: before long work.
void check_study_file(const std::filesystem::path& folder, const std::string& name,
                      const std::string& command, Overwrite overwrite);

/// The energy of a result per thousand points of its phase; none if it is of all phases.
std::optional<double> joules_per_thousand(const Result& result, Phase phase);

/// A table for people: a row per variant and set, mean and spread over the seeds; of timed
/// experiments also joules per thousand points.
std::string to_table(const Study& study);

}  // namespace pcednet::study
