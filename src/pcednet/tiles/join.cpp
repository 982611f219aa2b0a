#include "pcednet/tiles/join.h"

#include <fmt/format.h>

#include "pcednet/core/error.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/parts.h"
#include "pcednet/io/parts.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/tile_file.h"

namespace pcednet::tiles {
namespace {

/// Calls `visit` with all chunks of all tiles, one after the other, until it returns false.
void each_chunk(const Plan& plan, const std::function<bool(const PointCloud&)>& visit) {
  const bool narrow = plan.narrow_colours();
  for (const Tile& tile : plan.tiles) {
    const auto reader = open_chunks(tile.output);
    reader->set_narrow_colours(narrow);
    for (std::size_t p = 0; p < reader->parts(); ++p) {
      if (!visit(read_finished(*reader, p))) return;
    }
  }
}

}  // namespace

std::vector<NumberRange> ranges_of(const std::vector<std::size_t>& numbers) {
  std::vector<NumberRange> ranges;
  for (const std::size_t number : numbers) {
    if (!ranges.empty() && number == ranges.back().last + 1) {
      ranges.back().last = number;
    } else {
      ranges.push_back({number, number});
    }
  }
  return ranges;
}

std::string list_of(const std::vector<std::size_t>& numbers) {
  constexpr std::size_t kMost = 20;
  std::string text;
  std::size_t ranges = 0;
  for (const auto& [first, last] : ranges_of(numbers)) {
    if (++ranges > kMost) return text + ", ...";
    text += fmt::format("{}{}", text.empty() ? "" : ", ", first);
    if (last > first) text += fmt::format(" to {}", last);
  }
  return text;
}

void check_all_done(const Plan& plan) {
  std::vector<std::size_t> undone;
  for (std::size_t id = 0; id < plan.tiles.size(); ++id) {
    if (state_of(plan, id) != TileState::kDone) undone.push_back(id);
  }
  if (undone.empty()) return;
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: {} of {} tiles are missing or damaged: {}", plan.path.string(),
                          undone.size(), plan.tiles.size(), list_of(undone)));
}

void check_joins(const std::filesystem::path& path) {
  if (formats::format_for(path).create_parts) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("{}: tiles are joined as .laz, .las, .ply or text", path.string()));
}

Joined join(const Plan& plan, const std::filesystem::path& path, Overwrite overwrite,
            const Progress* progress) {
  check_joins(path);
  check_all_done(plan);
  PointCloud first;
  each_chunk(plan, [&](const PointCloud& part) {
    first = part;
    return false;
  });
  const bool is_las = !plan.las_steps.empty();
  const bool to_las = formats::format_for(path).is_las();
  io::PartOutline outline{.points = plan.points(), .first = &first, .is_las = is_las};
  outline.each_part = [&](const auto& visit) {
    // The steps and columns of tiles made of LAS are the same in all.
    if (is_las && to_las) {
      visit(first);
    } else {
      each_chunk(plan, visit);
    }
  };
  const auto writer =
      formats::create_parts(path, outline, {.overwrite = overwrite, .progress = progress});
  Joined joined{.points = 0, .losses = writer->losses};
  Stage stage(progress, "join", plan.points());
  each_chunk(plan, [&](const PointCloud& part) {
    writer->append(part);
    joined.points += part.size();
    stage.advance(part.size());
    return true;
  });
  if (joined.points != plan.points()) {
    throw Error(ErrorKind::kFailure, fmt::format("{}: the tiles have {} points, the inputs {}",
                                                 path.string(), joined.points, plan.points()));
  }
  writer->commit();
  return joined;
}

}  // namespace pcednet::tiles
