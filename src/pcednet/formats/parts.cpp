#include "pcednet/formats/parts.h"

#include <utility>

#include "pcednet/formats/format.h"

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

std::unique_ptr<io::PartReader> open_parts(const std::filesystem::path& path, std::size_t most) {
  auto file = std::make_unique<io::InputFile>(path);
  const Format& format = format_of(*file);
  if (!format.open_parts) return nullptr;
  auto reader = format.open_parts(std::move(file), most);
  if (!reader || reader->parts() == 0 || all_normals_unusable(*reader)) return nullptr;
  return reader;
}

std::unique_ptr<io::PartWriter> create_parts(const std::filesystem::path& path,
                                             const io::PartOutline& outline,
                                             const io::WriteOptions& options) {
  const Format& format = format_for(path);
  if (!format.create_parts) return nullptr;
  auto writer = format.create_parts(path, outline, options);
  add_lost_elements(*outline.first, format, writer->losses);
  return writer;
}

}  // namespace pcednet::formats
