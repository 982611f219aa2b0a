#include <fmt/format.h>

#include <algorithm>

#include "pcednet/io/cloud_columns.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/io/write_blocks.h"
#include "pcednet/io/xyz.h"
#include "pcednet/io/xyz_guess.h"

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

/// Whether the columns need no names: see create_xyz_parts().
bool is_plain(const std::string& extension, const PartOutline& outline) {
  const PointCloud& cloud = *outline.first;
  const bool more = !cloud.colours.empty() || cloud.has_labels() || !cloud.attributes.empty();
  if (extension == ".csv" || more || cloud.empty()) return false;
  if (!cloud.has_normals()) return true;
  bool all_show = extension == ".xyz";
  outline.each_part(
      [&](const PointCloud& part) { return all_show = all_show && normals_show(part); });
  return all_show;
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

std::vector<std::string> losses_of(const std::string& extension, const PointCloud& cloud,
                                   bool plain) {
  std::vector<std::string> losses;
  if (!cloud.attributes.empty()) losses.emplace_back("number types of attributes");
  if (!cloud.comments.empty() && (extension == ".csv" || plain)) losses.emplace_back("comments");
  return losses;
}

class XyzPartWriter : public PartWriter {
 public:
  XyzPartWriter(const std::filesystem::path& path, const PartOutline& outline,
                const WriteOptions& options)
      : path_(path),
        separator_(extension_of(path) == ".csv" ? ',' : ' '),
        columns_(columns_of(*outline.first, {})),
        file_(path, options.overwrite) {
    const std::string extension = extension_of(path);
    const bool plain = is_plain(extension, outline);
    losses = losses_of(extension, *outline.first, plain);
    if (!plain) {
      file_.write(header_of(extension, *outline.first, columns_));
    }
    if (extension == ".pts") file_.write(fmt::format("{}\n", outline.points));
  }

  void append(const PointCloud& part) override {
    const auto columns = columns_of(part, {});
    check_same_columns(path_, columns_, columns);
    write_blocks(file_, part.size(), [&](std::size_t begin, std::size_t end, std::string& out) {
      append_text(columns, begin, end, separator_, out);
    });
  }

  void commit() override { file_.commit(); }

 private:
  std::filesystem::path path_;
  char separator_;
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
