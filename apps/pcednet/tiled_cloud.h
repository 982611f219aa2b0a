#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "models.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/prepare.h"
#include "pcednet/io/parts.h"
#include "pcednet/tiles/label_points.h"
#include "pcednet/tiles/plan.h"

namespace CLI {
class App;
}

namespace pcednet::app {

/// Adds --max-memory.
void add_memory_option(CLI::App& command, std::string& memory);

/// The memory to stay within: what --max-memory says, otherwise most of what is free. Throws
/// Error(kUsage) for what is no size.
std::uint64_t memory_limit(const std::string& memory);

/// The memory for each tile where classifying `input` in memory would take more than `limit`, which
/// is said on stderr; nothing where it fits, or, with a warning, where one of the files cannot be
/// read or written in parts. `output`: of points; empty where there is none.
std::optional<std::uint64_t> memory_of_tiles(const std::filesystem::path& input,
                                             const std::filesystem::path& output,
                                             std::uint64_t limit);

/// A folder that is removed with all that is in it, if it is ever made.
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

struct TiledRequest {
  std::filesystem::path input;
  std::filesystem::path output;  ///< what is kept on the disk meanwhile is beside it
  ModelArguments model;
  detect::PrepareOptions preparation;
  std::uint64_t memory = 0;  ///< for a tile
  /// What is known of a part's points already; empty: the model finds it.
  std::function<detect::Classification(const PointCloud& part)> given = {};
};

/// A cloud whose points get normals, if need be, and labels in the memory of one tile, then read
/// part by part with what was found. What it keeps on the disk is gone with it.
class TiledCloud {
 public:
  /// Does the work, and says what the tiles are. Throws what make_plan() and label_points() throw.
  TiledCloud(TiledRequest request, const detect::EdgeModel& model, const Progress& progress);

  const tiles::Plan& plan() const { return plan_; }
  const detect::ClassCounts& counts() const { return counts_; }
  bool is_las() const { return reader_->is_las(); }

  /// Calls `visit` with part after part, in the order of the file, until it returns false.
  using Visit = std::function<bool(PointCloud& part, const tiles::TileFindings& findings)>;
  void each(const Visit& visit) const;

 private:
  TiledRequest request_;
  PassingFolder sorted_;
  tiles::Plan plan_;
  std::optional<tiles::PointLabels> labels_ = {};
  detect::ClassCounts counts_ = {};
  std::unique_ptr<io::PartReader> reader_;
};

}  // namespace pcednet::app
