#include "pcednet/tiles/tile_file.h"

#include <optional>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/core/output_file.h"
#include "pcednet/io/input_file.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/sha256.h"

namespace pcednet::tiles {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecordFormat = "pcednet-tile-1";

fs::path record_path(const fs::path& tile) {
  return tile.string() + ".json";
}

/// The record of a tile; none if it is missing or damaged.
std::optional<TileRecord> read_record(const fs::path& tile) {
  try {
    const Json j = parse_json(io::InputFile(record_path(tile)).text());
    if (j.at("format") != kRecordFormat) return std::nullopt;
    return TileRecord{.plan = j.at("plan"),
                      .tile = j.at("tile"),
                      .points = j.at("points"),
                      .bytes = j.at("bytes"),
                      .sha256 = j.at("sha256"),
                      .counts = {j.at("non_edge"), j.at("smooth_edge"), j.at("sharp_edge"),
                                 j.at("boundary"), j.at("unlabelled")}};
  } catch (const Json::exception&) {
    return std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

void write_claim(const fs::path& tile, TileRecord record) {
  const Json j = {{"format", kRecordFormat},
                  {"plan", record.plan},
                  {"tile", record.tile},
                  {"points", record.points},
                  {"bytes", record.bytes},
                  {"sha256", record.sha256},
                  {"non_edge", record.counts.non_edge},
                  {"smooth_edge", record.counts.smooth},
                  {"sharp_edge", record.counts.sharp},
                  {"boundary", record.counts.boundary},
                  {"unlabelled", record.counts.unlabelled}};
  write_text_file(record_path(tile), to_text(j, 1) + "\n", Overwrite::kYes);
}

void remove_claim(const fs::path& tile) {
  std::error_code ignored;
  if (!fs::exists(tile, ignored)) fs::remove(record_path(tile), ignored);
}

void check_not_of_plan(const fs::path& output, const Plan& plan) {
  std::error_code ignored;
  if (!fs::exists(output, ignored)) return;  // one look instead of two for each tile
  check_not_input(output, plan.inputs);
  pcednet::check_not_input(output, plan.model.path);
  for (const Tile& tile : plan.tiles) {
    pcednet::check_not_input(output, tile.output);
    pcednet::check_not_input(output, record_path(tile.output));
  }
}

void write_record(const fs::path& tile, TileRecord record) {
  record.bytes = io::InputFile(tile).size();
  record.sha256 = sha256_of_file(tile);
  write_claim(tile, record);
}

fs::path strange_file(const fs::path& tile) {
  if (read_record(tile)) return {};
  std::error_code error;
  for (const fs::path& path : {tile, record_path(tile)}) {
    if (fs::exists(fs::symlink_status(path, error))) return path;
  }
  return {};
}

fs::path tile_of_another_plan(const fs::path& folder, const std::string& digest) {
  fs::path found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    fs::path tile = entry->path();
    if (tile.extension() != ".json") continue;
    tile.replace_extension();
    const auto record = read_record(tile);
    if (record && record->plan != digest && (found.empty() || tile < found)) found = tile;
  }
  return found;
}

TileState state_of(const Plan& plan, std::size_t tile, bool look_inside) {
  const fs::path& path = plan.tiles[tile].output;
  std::error_code error;
  const std::uint64_t bytes = fs::file_size(path, error);
  if (error) return TileState::kMissing;
  const auto record = read_record(path);
  if (!record) return TileState::kMissing;
  const bool fits = record->plan == plan.digest && record->tile == tile &&
                    record->points == plan.tiles[tile].points && record->bytes == bytes;
  if (!fits) return TileState::kDamaged;
  if (look_inside && sha256_of_file(path) != record->sha256) return TileState::kDamaged;
  return TileState::kDone;
}

}  // namespace pcednet::tiles
