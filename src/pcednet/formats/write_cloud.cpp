#include "pcednet/formats/write_cloud.h"

#include <fmt/format.h>

#include "pcednet/formats/format.h"

namespace pcednet::formats {
namespace {

/// Adds elements other than points that the format drops.
void add_lost_elements(const PointCloud& cloud, const Format& format,
                       std::vector<std::string>& lost) {
  for (const ForeignElement& element : cloud.foreign_elements) {
    if (format.keeps && format.keeps(element)) continue;
    lost.push_back(fmt::format("{:.60}", element.header.substr(0, element.header.find('\n'))));
  }
}

}  // namespace

void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const io::WriteOptions& options) {
  const Format& format = format_for(path);
  if (format.write) return format.write(path, cloud, options);
  const auto writer = format.create_parts(path, io::outline_of(cloud), options);
  writer->append(cloud);
  writer->commit();
}

std::vector<std::string> losses(const std::filesystem::path& path, const PointCloud& cloud) {
  const Format& format = format_for(path);
  std::vector<std::string> lost;
  if (format.losses) lost = format.losses(path, cloud);
  add_lost_elements(cloud, format, lost);
  return lost;
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
