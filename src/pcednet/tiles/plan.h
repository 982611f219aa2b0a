#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/output_file.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/gls/pyramid_plan.h"
#include "pcednet/tiles/grid.h"

namespace pcednet::tiles {

/// Points of an input that are read together.
struct Chunk {
  std::size_t points = 0;
  std::size_t without_place = 0;  ///< of them, see has_place()
  BoundingBox box = {};           ///< of the others
  std::string digest = {};        ///< of everything that the file holds on the points
};

struct PlannedInput {
  std::filesystem::path path;
  std::uint64_t bytes = 0;
  bool narrow_colours = false;  ///< see io::PartReader
  /// Where each input has scanners of its own: the first of them in the plan's list, and how many;
  /// otherwise 0, and points have the attribute `scan` that the file gives them, if any.
  std::int32_t first_scan = 0, scans = 0;
  std::vector<Chunk> chunks;
  std::vector<std::string> left_out = {};  ///< columns that mean something else in the tiles

  std::size_t points() const;
};

/// The model and its use.
struct PlannedModel {
  std::string name = {};            ///< as the user gave it
  std::filesystem::path path = {};  ///< of the file
  std::string sha256 = {};          ///< of its bytes
  bool context = true;              ///< the context network decides last
  bool boundary = true;             ///< points where the surface ends get the class boundary
  bool exact = false;               ///< the exact engine describes
};

struct Tile {
  std::int64_t column = 0, row = 0;  ///< of its core
  std::size_t points = 0;            ///< in its core
  std::filesystem::path output = {};
};

/// Everything that must be the same for every tile of a cloud, and the tiles.
struct Plan {
  std::filesystem::path path = {};  ///< of its file
  std::string digest = {};          ///< SHA-256 of its file
  std::string version = {};         ///< of the program that made it
  std::vector<PlannedInput> inputs = {};
  /// The inputs, by number, that together have the columns and the header of the tiles: the first,
  /// and of LAS those with more.
  std::vector<std::size_t> forms = {0};
  std::size_t timed = 0;  ///< the form whose GPS times count as those of the tiles
  /// Scale and offset of x, y and z in the tiles, where all inputs are LAS or LAZ; otherwise empty.
  std::vector<double> las_steps = {};
  BoundingBox box = {};  ///< of all points with a place
  /// As in PointCloud: that of the request, or those of the inputs.
  std::vector<Vec3> scanners = {};
  /// Distinct places of points; of more than 2,000,000 points, all those with a place. The maximum
  /// of few points that count as a piece of a larger cloud.
  std::size_t places = 0;
  PlannedModel model = {};
  bool estimates = false;  ///< the inputs' normals are, and their comments, if any, do not say so
  double s_min = 0.0, s_max = 0.0;
  detect::NormalsDecision normals = {};
  /// One per octave of scales in use; without levels for the exact engine.
  std::vector<gls::PyramidPlan> pyramids = {};
  Grid grid = {};
  double buffer = 0.0;  ///< points within this distance of a core are read with it
  double reach =
      0.0;  ///< points within this distance are described with it, for the context network
  std::uint64_t memory = 0;             ///< bytes that the largest tile is expected to take
  std::vector<Tile> tiles = {};         ///< those with points; a tile's number is its index
  std::vector<std::string> notes = {};  ///< for the user, one sentence each

  std::size_t points() const;
  bool narrow_colours() const;  ///< of all inputs
  /// The box of the core of a tile, extended by `around`, without bounds in z.
  BoundingBox box_of(const Tile& tile, double around) const;
};

/// Throws Error(kUsage), before any work, for a file that a plan of that path cannot name: JSON
/// takes names in UTF-8 only.
void check_can_name(const std::filesystem::path& plan,
                    std::span<const std::filesystem::path> files);

/// Writes a plan as JSON. Paths of files in or below the folder of `path` are written relative to
/// it, so that a folder can be moved as a whole.
void write_plan(const std::filesystem::path& path, const Plan& plan, Overwrite overwrite);

/// Throws Error(kUnreadable) for a file that is not a plan, Error(kUsage) for a plan by another
/// version of the program, whose tiles could differ.
Plan read_plan(const std::filesystem::path& path);

}  // namespace pcednet::tiles
