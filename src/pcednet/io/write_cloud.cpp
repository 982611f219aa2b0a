#include "pcednet/io/write_cloud.h"

#include <fmt/format.h>

#include "pcednet/core/error.h"
#include "pcednet/io/las.h"
#include "pcednet/io/las_file.h"
#include "pcednet/io/obj.h"
#include "pcednet/io/pcd.h"
#include "pcednet/io/ply.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/io/xyz.h"

namespace pcednet::io {
namespace {

enum class Format { kPly, kPcd, kObj, kText, kLas };

Format format_of(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".ply") return Format::kPly;
  if (extension == ".pcd") return Format::kPcd;
  if (extension == ".obj") return Format::kObj;
  if (extension == ".las" || extension == ".laz") return Format::kLas;
  for (const char* text : {".xyz", ".txt", ".asc", ".pts", ".csv"}) {
    if (extension == text) return Format::kText;
  }
  throw Error(
      ErrorKind::kUsage,
      fmt::format("{}: points are written as .ply .pcd .las .laz .obj .xyz .txt .asc .pts .csv",
                  path.string()));
}

}  // namespace

void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const WriteOptions& options) {
  switch (format_of(path)) {
    case Format::kPly:
      return write_ply(path, cloud, options);
    case Format::kPcd:
      return write_pcd(path, cloud, options);
    case Format::kObj:
      return write_obj(path, cloud, options);
    case Format::kLas:
      return write_las(path, cloud, options);
    case Format::kText:
      return write_xyz(path, cloud, options);
  }
}

std::vector<std::string> losses(const std::filesystem::path& path, const PointCloud& cloud) {
  const Format format = format_of(path);
  std::vector<std::string> lost = format == Format::kPly   ? ply_losses(cloud)
                                  : format == Format::kPcd ? pcd_losses(cloud)
                                  : format == Format::kLas ? las_losses(cloud)
                                  : format == Format::kObj ? obj_losses(cloud)
                                                           : xyz_losses(path, cloud);
  if (format == Format::kPly) return lost;
  for (const ForeignElement& element : cloud.foreign_elements) {
    if (format == Format::kLas && is_las_element(element)) continue;
    lost.push_back(fmt::format("{:.60}", element.header.substr(0, element.header.find('\n'))));
  }
  return lost;
}

}  // namespace pcednet::io
