#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/core/error.h"
#include "pcednet/core/progress.h"

namespace pcednet::report {

struct MergeOptions {
  std::size_t clouds_per_set =
      4;  ///< the first clouds of each set, of those with predictions; 0: none
  std::size_t points_per_cloud = 30000;  ///< larger clouds are sampled
  bool lines = false;                    ///< also the lines of the truth and of each prediction
  std::string title = {}, date = {};     ///< of the page; empty: left out
};

/// Error(kUnreadable) for the file of a cloud; MergeOptions::clouds_per_set 0 needs no such files.
class MissingCloud : public Error {
  using Error::Error;
};

/// The content of a page.
struct MergedStudies {
  std::string json =
      {};  ///< one line: {"schema":"pcednet-report-1","studies":[...],"scenes":[...]}
  std::size_t studies = 0, scenes = 0;
  std::vector<std::filesystem::path> files = {};  ///< that were read
  std::vector<std::string> warnings = {};
};

/// Reads the studies in `folder`: its *.json files, in name order, whose "schema" is
/// "pcednet-study-1", unchanged into "studies". Others, and files that are no JSON, are left out
/// with a warning. A result whose "median" and "pooled" are null has times only.
///
/// "scenes" holds the clouds to look at,
/// {"set","cloud","file","points","shown","min","size","view",
/// "positions","normals","truth","predictions":[{"study","variant","seed","classes"}]}, where
/// "shown" counts points and "study" counts from 0: a cloud file with the predictions that any
/// study keeps for it, the first seed of each variant. The truth is what a study scores: see
/// truth::read_labelled(). See Scene and pack_classes() for the encoding. With MergeOptions::lines,
/// a scene has the "lines" of its truth and each prediction its own: see find_drawn_lines().
///
/// A cloud's file is searched from `folder`, then from the working folder; predictions are
/// <folder>/<predictions>/<cloud>.u8. Throws Error(kUnreadable) for a file that is missing or
/// differs from the study's record, or for the first that is no JSON where there is no study,
/// Error(kInsufficient) if there is neither, if a cloud has no labels, or if predictions or labels
/// differ in number from the points.
MergedStudies merge_studies(const std::filesystem::path& folder, const MergeOptions& options = {},
                            const Progress* progress = nullptr);

/// The web page `page` with `json` as its data. Nothing in `json` can end the script element that
/// holds it. Throws Error(kFailure) if the page has no place for it.
std::string fill_page(std::string_view page, std::string_view json);

}  // namespace pcednet::report
