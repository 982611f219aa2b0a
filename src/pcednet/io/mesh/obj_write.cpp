#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pcednet/io/cloud_columns.h"
#include "pcednet/io/mesh/obj.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/io/write_blocks.h"

namespace pcednet::io {
namespace {

/// Writes `columns` as lines that begin with `keyword`.
void write_statements(OutputFile& file, const std::string& keyword, std::size_t count,
                      const std::vector<ColumnView>& columns) {
  write_blocks(file, count, [&](std::size_t begin, std::size_t end, std::string& out) {
    for (std::size_t i = begin; i < end; ++i) {
      out += keyword;
      append_text(columns, i, i + 1, ' ', out);
    }
  });
}

/// Colours in 0 ... 1, behind the columns of the positions.
std::vector<float> unit_colours(const PointCloud& cloud) {
  std::vector<float> unit;
  unit.reserve(3 * cloud.colours.size());
  for (const Rgb& colour : cloud.colours) {
    for (const std::uint8_t channel : colour) unit.push_back(static_cast<float>(channel) / 255.0F);
  }
  return unit;
}

}  // namespace

void write_obj(const std::filesystem::path& path, const PointCloud& cloud,
               const WriteOptions& options) {
  const std::vector<ColumnView> columns = columns_of(cloud, {});
  const std::vector<float> colours = unit_colours(cloud);
  std::vector<ColumnView> vertex(columns.begin(), columns.begin() + 3);
  for (std::size_t c = 0; c < 3 && !colours.empty(); ++c) {
    vertex.push_back({"", ScalarType::kFloat32, reinterpret_cast<const std::byte*>(&colours[c]),
                      3 * sizeof(float), ScalarType::kFloat32});
  }
  OutputFile file(path, options.overwrite);
  for (const auto line : split_lines(cloud.comments)) file.write(fmt::format("# {}\n", line));
  write_statements(file, "v ", cloud.size(), vertex);
  if (cloud.has_normals()) {
    const std::vector<ColumnView> normal(columns.begin() + 3, columns.begin() + 6);
    write_statements(file, "vn ", cloud.size(), normal);
  }
  file.commit();
}

std::vector<std::string> obj_losses(const PointCloud& cloud) {
  std::vector<std::string> losses, names;
  for (const Attribute& attribute : cloud.attributes) names.push_back(attribute.name);
  if (!names.empty()) {
    losses.push_back(
        fmt::format("attribute{} {}", names.size() == 1 ? "" : "s", fmt::join(names, ", ")));
  }
  if (cloud.has_labels()) losses.emplace_back("labels");
  return losses;
}

}  // namespace pcednet::io
