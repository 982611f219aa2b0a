#include <fmt/format.h>

#include <algorithm>

#include "pcednet/io/cloud_columns.h"
#include "pcednet/io/text/xyz.h"
#include "pcednet/io/text/xyz_fields.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/io/write_blocks.h"

namespace pcednet::io {
namespace {

/// Whether the normals to write look like normals.
bool normals_show(const PointCloud& part) {
  const bool as_stored = normals_are_stored(part);
  for (std::size_t i = 0; i < part.size(); ++i) {
    const Vec3 normal = as_stored ? stored_normal(part, i) : part.normals[i];
    if (!looks_like_normal(normal.data())) return false;
  }
  return true;
}

bool is_intensity(std::string_view name) {
  return lower_case(name) == "intensity";
}

bool has_intensity(const PointCloud& cloud) {
  return std::any_of(cloud.attributes.begin(), cloud.attributes.end(), [](const Attribute& one) {
    return one.components == 1 && is_intensity(one.name);
  });
}

/// The columns of columns_of(), for a .pts in its order: x y z intensity red green blue, then the
/// others.
std::vector<ColumnView> text_columns(const std::string& extension, const PointCloud& cloud) {
  std::vector<ColumnView> columns = columns_of(cloud, {});
  if (extension != ".pts") return columns;
  const auto first = columns.begin() + 3;
  const auto intensity = std::find_if(
      first, columns.end(), [](const ColumnView& column) { return is_intensity(column.name); });
  if (intensity != columns.end()) std::rotate(first, intensity, intensity + 1);
  if (cloud.has_normals() && !cloud.colours.empty()) {
    const auto normals = first + (intensity == columns.end() ? 0 : 1);
    std::rotate(normals, normals + 3, normals + 6);
  }
  return columns;
}

/// Whether the columns need no names: see create_xyz_parts().
bool is_plain(const std::string& extension, const PartOutline& outline) {
  const PointCloud& cloud = *outline.first;
  if (extension == ".pts") {
    const std::size_t usual = 3 + (cloud.colours.empty() ? 0 : 3) + (has_intensity(cloud) ? 1 : 0);
    return columns_of(cloud, {}).size() == usual;
  }
  const bool more = !cloud.colours.empty() || cloud.has_labels() || !cloud.attributes.empty();
  if (extension == ".csv" || more || cloud.empty()) return false;
  if (!cloud.has_normals()) return true;
  return extension == ".xyz" && all_parts(outline.each_part, normals_show);
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
  for (const auto line : split_lines(cloud.comments)) header += fmt::format("# {}\n", line);
  return header + "# " + names + "\n";
}

std::vector<std::string> losses_of(const std::string& extension, const PointCloud& cloud,
                                   bool plain) {
  std::vector<std::string> losses;
  const bool are_read_as_written =
      std::all_of(cloud.attributes.begin(), cloud.attributes.end(),
                  [](const Attribute& one) { return one.type == ScalarType::kFloat64; });
  if (!are_read_as_written) losses.emplace_back("number types of attributes");
  if (!cloud.comments.empty() && (extension == ".csv" || plain)) losses.emplace_back("comments");
  return losses;
}

class XyzPartWriter : public PartWriter {
 public:
  XyzPartWriter(const std::filesystem::path& path, const PartOutline& outline,
                const WriteOptions& options)
      : path_(path),
        separator_(extension_of(path) == ".csv" ? ',' : ' '),
        extension_(extension_of(path)),
        columns_(text_columns(extension_, *outline.first)),
        file_(path, options.overwrite) {
    const bool plain = is_plain(extension_, outline);
    losses = losses_of(extension_, *outline.first, plain);
    if (extension_ == ".pts") file_.write(fmt::format("{}\n", outline.points));
    if (!plain) file_.write(header_of(extension_, *outline.first, columns_));
  }

  void append(const PointCloud& part) override {
    const auto columns = text_columns(extension_, part);
    check_same_columns(path_, columns_, columns);
    write_blocks(file_, part.size(), [&](std::size_t begin, std::size_t end, std::string& out) {
      append_text(columns, begin, end, separator_, out);
    });
  }

  void commit() override { file_.commit(); }

 private:
  std::filesystem::path path_;
  char separator_;
  std::string extension_;
  std::vector<ColumnView> columns_;
  OutputFile file_;
};

}  // namespace

std::unique_ptr<PartWriter> create_xyz_parts(const std::filesystem::path& path,
                                             const PartOutline& outline,
                                             const WriteOptions& options) {
  return std::make_unique<XyzPartWriter>(path, outline, options);
}

std::vector<std::string> xyz_losses(const std::filesystem::path& path, const PartOutline& outline) {
  const std::string extension = extension_of(path);
  return losses_of(extension, *outline.first, is_plain(extension, outline));
}

}  // namespace pcednet::io
