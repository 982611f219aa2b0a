#include "tiled_cloud.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <string>

#include "common.h"
#include "descriptor_options.h"
#include "memory_size.h"
#include "pcednet/core/counted.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/parts.h"
#include "pcednet/io/scanners.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/layout.h"
#include "pcednet/tiles/make_plan.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

/// What the beginning of a point file tells.
struct RoughFacts {
  std::uint64_t points = 0;  ///< by the header, otherwise by the length of the first lines
  bool has_normals = false;  ///< the header, or a heading, names some
};

std::uint64_t points_by_lines(const io::InputFile& file, const std::string& start) {
  const auto lines = static_cast<std::uint64_t>(std::count(start.begin(), start.end(), '\n'));
  return start.empty() ? 0 : file.size() / (start.size() / (lines + 1) + 1);
}

/// Throws Error(kUnreadable) for a header that cannot be read.
RoughFacts rough_facts(const io::InputFile& file) {
  constexpr std::uint64_t kLookedAt = std::uint64_t{1} << 16;
  const std::string start = file.text(0, kLookedAt);
  const std::string names = io::lower_case(start);
  const bool has_normals =
      names.find("normal_x") != std::string::npos || names.find(" nx") != std::string::npos ||
      names.find(",nx") != std::string::npos || names.find("\nvn ") != std::string::npos;
  const formats::Format& format = formats::format_of(file);
  return {.points = format.points ? format.points(file) : points_by_lines(file, start),
          .has_normals = has_normals};
}

/// Larger tiles repeat hardly less of their neighbours.
constexpr std::uint64_t kMostForTile = std::uint64_t{4} << 30;

/// A cloud as it would be in memory.
struct InWhole {
  std::uint64_t points = 0, bytes = 0;
};

/// The memory for classifying in one piece: without normals, for the largest possible number of
/// neighbours.
std::uint64_t bytes_in_whole(std::uint64_t points, bool has_normals) {
  constexpr std::size_t kMostNeighbours = 48;
  return tiles::memory_for(points, {.made = !has_normals, .neighbours = kMostNeighbours});
}

/// Estimated from the first points.
InWhole in_whole(const io::PartReader& reader) {
  const PointCloud first = tiles::read_finished(reader, 0);
  std::size_t columns = 0;
  for (const Attribute& attribute : first.attributes) columns += attribute.stride();
  return {reader.points(),
          bytes_in_whole(reader.points(), first.has_normals()) + columns * reader.points()};
}

/// The same for a file that is not read in parts.
InWhole in_whole(const io::InputFile& file) {
  const RoughFacts facts = rough_facts(file);
  return {facts.points, bytes_in_whole(facts.points, facts.has_normals)};
}

/// A pipe can be read only once; a small file need not be inspected.
bool is_surely_small(const fs::path& input, std::uint64_t limit) {
  constexpr std::uint64_t kMostPerByte = 1000;  // of memory per byte of a file
  std::error_code error;
  if (!fs::is_regular_file(input, error)) return true;
  const std::uint64_t bytes = fs::file_size(input, error);
  return error || bytes < limit / kMostPerByte;
}

bool is_tiled_format(const fs::path& input) {
  return formats::format_of(io::InputFile(input)).is_tiled();
}

tiles::Plan plan_for(const TiledRequest& request, const detect::EdgeModel& model,
                     const fs::path& sorted, const Progress& progress) {
  tiles::Plan plan =
      tiles::make_plan({.inputs = {request.input},
                        .folder = request.output.parent_path(),
                        .output = {},
                        .model = planned_model(request.model),
                        .memory = request.memory,
                        .keep_orientation = request.preparation.keep_orientation,
                        .viewpoint = request.viewpoint,
                        .sort = {.folder = sorted, .if_needed = true, .numbered = true}},
                       model, &progress);
  check_scales(request.input, plan.box, model.descriptor);
  for (const std::string& note : plan.notes) {
    const std::string name = request.input.string();
    warn(note.starts_with(name) ? note : name + ": " + note);
  }
  return plan;
}

}  // namespace

void add_memory_option(CLI::App& command, std::string& memory) {
  command.add_option("--max-memory", memory,
                     "Memory to stay within, such as 8G: larger clouds are classified tile by tile "
                     "(default: most of what is free)");
}

std::uint64_t memory_limit(const std::string& memory) {
  if (!memory.empty()) return byte_size("--max-memory", memory);
  return free_memory() / 5 * 4;
}

std::optional<TilesNeeded> tiles_needed(const fs::path& input, const fs::path& output,
                                        std::uint64_t limit) {
  if (is_surely_small(input, limit)) return std::nullopt;
  const bool is_text = formats::format_of(io::InputFile(input)).is_text();
  const auto reader = is_text ? nullptr : formats::open_parts(input, tiles::kChunkPoints);
  const InWhole whole = reader ? in_whole(*reader) : in_whole(io::InputFile(input));
  if (whole.bytes <= limit) return std::nullopt;
  const std::string much =
      fmt::format("{}: {}{} points may take {} of memory, more than {}", input.string(),
                  reader ? "" : "about ", whole.points, size_text(whole.bytes), size_text(limit));
  if (!reader || !is_tiled_format(input)) {
    warn(much + "; LAS, LAZ and binary PLY, which pcednet convert writes, are read in tiles");
    return std::nullopt;
  }
  if (!output.empty() && !formats::format_for(output).create_parts) {
    warn(much + "; .las, .laz, .ply and text are written in tiles");
    return std::nullopt;
  }
  return TilesNeeded{std::min(limit, kMostForTile), much};
}

PassingFolder::~PassingFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

TiledCloud::TiledCloud(TiledRequest request, const detect::EdgeModel& model,
                       const Progress& progress)
    : request_(std::move(request)),
      sorted_(fmt::format("{}.sorted-{}", request_.output.string(), getpid())),
      plan_(plan_for(request_, model, sorted_.path(), progress)),
      reader_(tiles::open_chunks(request_.input)) {
  reader_->set_narrow_colours(plan_.inputs.front().narrow_colours);
  if (request_.given && !plan_.normals.made) return;
  say(fmt::format("  {} of length {:g}, each with {:.4g} around it, of up to {}",
                  counted(plan_.tiles.size(), "tile"), plan_.grid.length(), plan_.buffer,
                  size_text(plan_.memory)));
  if (plan_.memory > request_.memory) {
    warn(fmt::format("that is more than {}: no tile is shorter than its buffer",
                     size_text(request_.memory)));
  }
  if (request_.given && request_.look_first) request_.look_first(*this);
  labels_.emplace(request_.output, !request_.given && has_own_classes(model.table),
                  plan_.normals.made);
  if (request_.given) {
    tiles::label_points(plan_, nullptr, *labels_, &progress);
  } else {
    const detect::EdgeModel planned = tiles::load_planned_model(plan_);
    found_ = tiles::label_points(plan_, &planned, *labels_, &progress);
  }
}

void TiledCloud::each(const Visit& visit) const {
  std::size_t begin = 0;
  for (std::size_t p = 0; p < reader_->parts(); ++p) {
    PointCloud part = tiles::read_finished(*reader_, p);
    if (plan_.estimates) detect::set_estimated_normals(part, true);
    if (request_.viewpoint) io::set_scanners(plan_.scanners, part);
    tiles::TileFindings findings;
    if (labels_) findings = labels_->get(begin, begin + part.size());
    if (request_.given) findings.found = request_.given(part);
    begin += part.size();
    if (!visit(part, findings)) return;
  }
}

std::vector<std::string> write_tiled(const std::filesystem::path& output, const TiledCloud& cloud,
                                     const TiledResult& result, const Progress& progress) {
  const auto each = [&](const std::function<bool(const PointCloud&)>& visit) {
    cloud.each([&](PointCloud& part, const tiles::TileFindings& findings) {
      throw_if_cancelled(&progress);
      result.add_result(part, findings);
      return visit(part);
    });
  };
  PointCloud first;
  each([&](const PointCloud& part) {
    first = part;
    return false;
  });
  const std::size_t points = cloud.plan().points();
  io::WriteOptions options = result.write;
  options.new_normals = !cloud.plan().normals.made;
  options.progress = &progress;
  const auto writer = formats::create_parts(
      output, {.points = points, .first = &first, .each_part = each, .is_las = cloud.is_las()},
      options);
  Stage stage(&progress, "write", points);
  std::size_t before = 0;
  each([&](const PointCloud& part) {
    writer->append(part);
    result.see(part, before);
    before += part.size();
    stage.advance(part.size());
    return true;
  });
  writer->commit();
  return writer->losses;
}

}  // namespace pcednet::app
