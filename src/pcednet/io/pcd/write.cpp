#include <fmt/format.h>

#include <algorithm>

#include "pcednet/io/cloud_columns.h"
#include "pcednet/io/pcd/pcd.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/io/write_blocks.h"

namespace pcednet::io {
namespace {

/// PCL finds labels of type uint32 only.
ColumnNames pcd_names() {
  return {.normals = {"normal_x", "normal_y", "normal_z"},
          .colours = {},
          .label_type = ScalarType::kUint32,
          .has_counts = true};
}

/// The parts of a header that read_pcd() kept in comments.
struct KeptHeader {
  std::uint64_t width = 0;
  std::uint64_t height = 1;
  std::string viewpoint = "VIEWPOINT 0 0 0 1 0 0 0";
  std::string comments;
};

KeptHeader kept_header(const PointCloud& cloud) {
  KeptHeader kept;
  kept.width = cloud.size();
  std::vector<std::string_view> words;
  for (const auto line : split_lines(cloud.comments)) {
    split(line, words);
    const bool is_viewpoint = words.size() == 8 && words[0] == "VIEWPOINT" &&
                              std::all_of(words.begin() + 1, words.end(),
                                          [](auto word) { return parse_double(word).has_value(); });
    const bool is_grid = words.size() == 4 && words[0] == "WIDTH" && words[2] == "HEIGHT";
    if (is_viewpoint) {
      kept.viewpoint = line;
    } else if (is_grid) {
      const std::uint64_t width = parse_count(words[1]).value_or(0);
      const std::uint64_t height = parse_count(words[3]).value_or(0);
      const bool fits = height != 0 && cloud.size() % height == 0 && cloud.size() / height == width;
      if (fits) kept.width = width, kept.height = height;
    } else {
      kept.comments += fmt::format("# {}\n", line);
    }
  }
  return kept;
}

char type_letter(ScalarType type) {
  if (is_floating(type)) return 'F';
  return visit_scalar(type, [](auto zero) { return decltype(zero)(-1) < decltype(zero)(0); }) ? 'I'
                                                                                              : 'U';
}

std::string header_of(const PointCloud& cloud, const std::vector<ColumnView>& columns, bool ascii) {
  const KeptHeader kept = kept_header(cloud);
  std::string fields, sizes, types, counts;
  for (std::size_t c = 0; c < columns.size();) {
    const ColumnView& column = columns[c];
    const std::size_t first = c++;
    while (c < columns.size() && columns[c].component > 0) ++c;
    fields += " " + column.name;
    sizes += fmt::format(" {}", size_of(column.type));
    types += fmt::format(" {}", type_letter(column.type));
    counts += fmt::format(" {}", c - first);
  }
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\n{}VERSION 0.7\nFIELDS{}\nSIZE{}\nTYPE{}\n"
      "COUNT{}\nWIDTH {}\nHEIGHT {}\n{}\nPOINTS {}\nDATA {}\n",
      kept.comments, fields, sizes, types, counts, kept.width, kept.height, kept.viewpoint,
      cloud.size(), ascii ? "ascii" : "binary");
}

/// Colours as 0x00RRGGBB, the way PCL keeps them.
std::vector<std::uint32_t> packed_colours(const PointCloud& cloud) {
  std::vector<std::uint32_t> packed;
  packed.reserve(cloud.colours.size());
  for (const Rgb& colour : cloud.colours) {
    packed.push_back(std::uint32_t{colour[0]} << 16 | std::uint32_t{colour[1]} << 8 | colour[2]);
  }
  return packed;
}

/// Puts rgb behind positions and normals.
void insert_colours(std::vector<ColumnView>& columns, const std::vector<std::uint32_t>& packed,
                    const PointCloud& cloud) {
  if (packed.empty()) return;
  const std::ptrdiff_t place = cloud.has_normals() ? 6 : 3;
  columns.insert(columns.begin() + place,
                 {"rgb", ScalarType::kUint32, reinterpret_cast<const std::byte*>(packed.data()),
                  sizeof packed[0], ScalarType::kUint32});
}

}  // namespace

void write_pcd(const std::filesystem::path& path, const PointCloud& cloud,
               const WriteOptions& options) {
  const std::vector<std::uint32_t> packed = packed_colours(cloud);
  std::vector<ColumnView> columns = columns_of(cloud, pcd_names());
  insert_colours(columns, packed, cloud);
  OutputFile file(path, options.overwrite);
  file.write(header_of(cloud, columns, options.ascii));
  write_blocks(file, cloud.size(), [&](std::size_t begin, std::size_t end, std::string& out) {
    if (options.ascii) {
      append_text(columns, begin, end, ' ', out);
    } else {
      append_binary(columns, begin, end, out);
    }
  });
  file.commit();
}

}  // namespace pcednet::io
