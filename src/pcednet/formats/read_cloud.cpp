#include "pcednet/formats/read_cloud.h"

#include <utility>

#include "pcednet/formats/format.h"
#include "pcednet/io/scanners.h"

namespace pcednet::formats {
namespace {

/// If so, they count as absent, which a single part cannot know.
bool all_normals_unusable(const io::PartReader& reader) {
  for (std::size_t part = 0; part < reader.parts(); ++part) {
    io::PartTally tally;
    PointCloud points = reader.read(part);
    if (!points.has_normals()) return false;
    finish_part(points, tally);
    if (tally.unusable_normals < tally.points) return false;
  }
  return true;
}

}  // namespace

io::LoadedCloud read_cloud(const std::filesystem::path& path) {
  const io::InputFile file(path);
  io::LoadedCloud loaded = format_of(file).read(file);
  PointCloud& cloud = loaded.cloud;
  if (cloud.scanners.empty()) cloud.scanners = io::scanners_of_comments(cloud.comments);
  io::PartTally tally;
  io::finish_part(cloud, tally);
  if (tally.unusable_normals == tally.points) cloud.normals.clear();
  loaded.rescaled_normals = tally.rescaled_normals;
  for (std::string& warning : warnings_of(tally)) loaded.warnings.push_back(std::move(warning));
  return loaded;
}

std::unique_ptr<io::PartReader> open_parts(const std::filesystem::path& path, std::size_t most) {
  auto file = std::make_unique<io::InputFile>(path);
  const Format& format = format_of(*file);
  if (!format.open_parts) return nullptr;
  auto reader = format.open_parts(std::move(file), most);
  if (!reader || reader->parts() == 0 || all_normals_unusable(*reader)) return nullptr;
  return reader;
}

}  // namespace pcednet::formats
