#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "models.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/io/parts.h"
#include "pcednet/io/write_options.h"
#include "pcednet/tiles/label_points.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::app {

/// Adds --max-memory.
void add_memory_option(CLI::App& command, std::string& memory);

/// The memory limit: --max-memory, otherwise most of the free memory. Throws Error(kUsage) for an
/// invalid size.
std::uint64_t memory_limit(const std::string& memory);

/// That a cloud is too large to be worked on in one piece.
struct TilesNeeded {
  std::uint64_t memory = 0;  ///< for a tile
  std::string reason;        ///< for people; the caller says it, with what it does
};

/// Whether classifying `input` in memory would take more than `limit`; none if it fits or, with a
/// warning, if one of the files cannot be read or written in parts. `output`: of points; empty if
/// there is none.
std::optional<TilesNeeded> tiles_needed(const std::filesystem::path& input,
                                        const std::filesystem::path& output, std::uint64_t limit);

/// A folder that is removed with its contents, if it was made.
class PassingFolder {
 public:
  explicit PassingFolder(std::filesystem::path path) : path_(std::move(path)) {}
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  ~PassingFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

class TiledCloud;

struct TiledRequest {
  std::filesystem::path input;
  std::filesystem::path output;  ///< temporary files are beside it
  ModelArguments model;
  detect::PrepareOptions preparation;
  std::optional<Vec3> viewpoint = {};  ///< of the scanner that saw all points
  std::uint64_t memory = 0;            ///< for a tile
  /// Existing labels of a part's points; empty: the model finds them.
  std::function<detect::Classification(const PointCloud& part)> given = {};
  /// Called where these are given, before the long work: may look at each part, without normals.
  std::function<void(const TiledCloud& cloud)> look_first = {};
};

/// A cloud whose points get normals, if needed, and labels in the memory of one tile, and which is
/// then read part by part with the findings. Its temporary files are removed with it.
class TiledCloud {
 public:
  /// Does the work, and reports the tiles. Throws as make_plan() and label_points() do.
  TiledCloud(TiledRequest request, const detect::EdgeModel& model, const Progress& progress);

  const tiles::Plan& plan() const { return plan_; }
  /// What tiles::label_points() returned; nothing if labels were given.
  const detect::Classification& found() const { return found_; }
  bool is_las() const { return reader_->is_las(); }

  /// Calls `visit` with part after part, in the order of the file, until it returns false.
  using Visit = std::function<bool(PointCloud& part, const tiles::TileFindings& findings)>;
  void each(const Visit& visit) const;

 private:
  TiledRequest request_;
  PassingFolder sorted_;
  tiles::Plan plan_;
  std::optional<tiles::PointLabels> labels_ = {};
  detect::Classification found_ = {};
  std::unique_ptr<io::PartReader> reader_;
};

struct TiledResult {
  io::WriteOptions write;
  /// Adds the findings to the next part of the cloud.
  std::function<void(PointCloud& part, const tiles::TileFindings& findings)> add_result;
  /// Called with each part as written, and the number of points before it.
  std::function<void(const PointCloud& part, std::size_t before)> see;
};

/// Writes a cloud with the findings of its tiles, its points in their order: the same file as for
/// the cloud in memory, except for labels that differ (docs/large.md). Returns what its format
/// cannot hold.
std::vector<std::string> write_tiled(const std::filesystem::path& output, const TiledCloud& cloud,
                                     const TiledResult& result, const Progress& progress);

}  // namespace pcednet::app
