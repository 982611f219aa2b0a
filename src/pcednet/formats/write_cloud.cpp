#include "pcednet/formats/write_cloud.h"

#include "pcednet/formats/format.h"

namespace pcednet::formats {

void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const io::WriteOptions& options) {
  const Format& format = format_for(path);
  if (format.write) return format.write(path, cloud, options);
  const auto writer = format.create_parts(path, io::outline_of(cloud), options);
  writer->append(cloud);
  writer->commit();
}

void check_positions(const std::filesystem::path& path, const PointCloud& cloud) {
  const Format& format = format_for(path);
  if (format.check_positions) format.check_positions(path, cloud);
}

std::vector<std::string> losses(const std::filesystem::path& path, const PointCloud& cloud) {
  const Format& format = format_for(path);
  std::vector<std::string> lost;
  if (format.losses) lost = format.losses(path, cloud);
  add_lost_elements(cloud, format, lost);
  return lost;
}

}  // namespace pcednet::formats
