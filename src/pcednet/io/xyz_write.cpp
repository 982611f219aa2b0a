#include <fmt/format.h>

#include <algorithm>

#include "pcednet/io/cloud_columns.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/io/write_blocks.h"
#include "pcednet/io/xyz.h"

namespace pcednet::io {
namespace {

/// Whether the columns speak for themselves: see write_xyz.
bool is_plain(const std::string& extension, const PointCloud& cloud) {
  const bool more = !cloud.colours.empty() || cloud.has_labels() || !cloud.attributes.empty();
  if (extension == ".csv" || more || cloud.empty()) return false;
  const auto is_usable = [](const Vec3& normal) { return !normal.isZero(0.0); };
  return !cloud.has_normals() ||
         (extension == ".xyz" &&
          std::all_of(cloud.normals.begin(), cloud.normals.end(), is_usable));
}

std::string extension_of(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

std::string header_of(const std::string& extension, const PointCloud& cloud,
                      const std::vector<ColumnView>& columns) {
  std::string names;
  const char separator = extension == ".csv" ? ',' : ' ';
  for (const ColumnView& column : columns) {
    if (!names.empty()) names += separator;
    names += column.name;
  }
  if (extension == ".csv") return names + "\n";
  std::string header;
  for (const std::string& comment : cloud.comments) {
    Lines parts(comment);
    std::string_view part;
    while (parts.next(part)) header += fmt::format("# {}\n", part);
  }
  return header + "# " + names + "\n";
}

}  // namespace

void write_xyz(const std::filesystem::path& path, const PointCloud& cloud,
               const WriteOptions& options) {
  const std::string extension = extension_of(path);
  const std::vector<ColumnView> columns = columns_of(cloud, {});
  OutputFile file(path, options.overwrite);
  if (!is_plain(extension, cloud)) file.write(header_of(extension, cloud, columns));
  if (extension == ".pts") file.write(fmt::format("{}\n", cloud.size()));
  const char separator = extension == ".csv" ? ',' : ' ';
  write_blocks(file, cloud.size(), [&](std::size_t begin, std::size_t end, std::string& out) {
    append_text(columns, begin, end, separator, out);
  });
  file.commit();
}

std::vector<std::string> xyz_losses(const std::filesystem::path& path, const PointCloud& cloud) {
  std::vector<std::string> losses = column_losses(cloud, {});
  const std::string extension = extension_of(path);
  if (!cloud.attributes.empty()) losses.emplace_back("number types of attributes");
  if (!cloud.comments.empty() && (extension == ".csv" || is_plain(extension, cloud))) {
    losses.emplace_back("comments");
  }
  return losses;
}

}  // namespace pcednet::io
