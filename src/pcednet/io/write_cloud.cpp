#include "pcednet/io/write_cloud.h"

#include <fmt/format.h>

#include "pcednet/core/error.h"
#include "pcednet/io/las.h"
#include "pcednet/io/las_file.h"
#include "pcednet/io/las_layout.h"
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

PartOutline outline_of(const PointCloud& cloud) {
  return {.points = cloud.size(), .first = &cloud, .each_part = [&](const auto& visit) {
            visit(cloud);
          }};
}

/// Other elements than points that a format which is not PLY leaves behind.
void add_lost_elements(const PointCloud& cloud, Format format, std::vector<std::string>& lost) {
  if (format == Format::kPly) return;
  for (const ForeignElement& element : cloud.foreign_elements) {
    if (format == Format::kLas && is_las_element(element)) continue;
    lost.push_back(fmt::format("{:.60}", element.header.substr(0, element.header.find('\n'))));
  }
}

std::vector<std::string> format_losses(const std::filesystem::path& path, const PointCloud& cloud) {
  switch (format_of(path)) {
    case Format::kPly:
    case Format::kPcd:
      return {};  // they have a column for everything
    case Format::kObj:
      return obj_losses(cloud);
    case Format::kLas:
      return las_losses(cloud, las_choices(outline_of(cloud)));
    case Format::kText:
      break;
  }
  return xyz_losses(path, outline_of(cloud));
}

}  // namespace

std::unique_ptr<PartWriter> create_parts(const std::filesystem::path& path,
                                         const PartOutline& outline, const WriteOptions& options) {
  const Format format = format_of(path);
  std::unique_ptr<PartWriter> writer;
  if (format == Format::kPly) writer = create_ply_parts(path, outline, options);
  if (format == Format::kLas) writer = create_las_parts(path, outline, options);
  if (format == Format::kText) writer = create_xyz_parts(path, outline, options);
  if (writer) add_lost_elements(*outline.first, format, writer->losses);
  return writer;
}

void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const WriteOptions& options) {
  const Format format = format_of(path);
  if (format == Format::kPcd) return write_pcd(path, cloud, options);
  if (format == Format::kObj) return write_obj(path, cloud, options);
  const auto writer = create_parts(path, outline_of(cloud), options);
  writer->append(cloud);
  writer->commit();
}

std::vector<std::string> losses(const std::filesystem::path& path, const PointCloud& cloud) {
  std::vector<std::string> lost = format_losses(path, cloud);
  add_lost_elements(cloud, format_of(path), lost);
  return lost;
}

}  // namespace pcednet::io
