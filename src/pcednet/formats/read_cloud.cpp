#include "pcednet/formats/read_cloud.h"

#include <utility>

#include "pcednet/formats/format.h"
#include "pcednet/io/scanners.h"

namespace pcednet::formats {

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

}  // namespace pcednet::formats
