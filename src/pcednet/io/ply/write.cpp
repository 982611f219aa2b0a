#include <fmt/format.h>

#include <memory>
#include <string>

#include "pcednet/core/error.h"
#include "pcednet/io/cloud_columns.h"
#include "pcednet/io/ply/header.h"
#include "pcednet/io/ply/ply.h"
#include "pcednet/io/ply/rows.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/io/write_blocks.h"

namespace pcednet::io {
namespace {

ColumnNames ply_names() {
  return {.has_int64 = false};
}

std::string comment_lines(const PointCloud& cloud) {
  std::string lines;
  for (const std::string& comment : cloud.comments) {
    if (comment.empty()) lines += "comment\n";
    for (const auto line : split_lines({&comment, 1})) {
      const bool is_info = line.starts_with("obj_info ");
      lines += fmt::format("{}{}\n", is_info ? "" : "comment ", line);
    }
  }
  return lines;
}

std::string header_of(const PointCloud& cloud, std::size_t points,
                      const std::vector<ColumnView>& columns, bool ascii) {
  std::string header =
      fmt::format("ply\nformat {} 1.0\n", ascii ? "ascii" : "binary_little_endian");
  header += comment_lines(cloud);
  header += fmt::format("element vertex {}\n", points);
  for (const ColumnView& column : columns) {
    header += fmt::format("property {} {}\n", ply_type_name(column.type), column.name);
  }
  for (const ForeignElement& element : cloud.foreign_elements) header += element.header;
  return header + "end_header\n";
}

/// The rows of a foreign element as lines of text.
std::string foreign_text(const std::filesystem::path& path, const ForeignElement& foreign) {
  const PlyHeader header =
      parse_ply_header(path, "ply\nformat ascii 1.0\n" + foreign.header + "end_header\n");
  std::string text;
  for (const PlyElement& element : header.elements) {
    std::vector<std::byte> bytes = foreign.bytes;
    std::byte* row = bytes.data();
    const std::byte* const end = row + bytes.size();
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
      const std::size_t start = text.size();
      row = walk_ply_row(element, row, end, false,
                         [&](std::size_t, const std::byte* number, ScalarType type, bool) {
                           if (text.size() > start) text += ' ';
                           append_number(type, number, text);
                         });
      if (!row) {
        throw Error(ErrorKind::kFailure,
                    fmt::format("{}: element {} has fewer bytes than its header says",
                                path.string(), element.name));
      }
      text += '\n';
    }
  }
  return text;
}

class PlyPartWriter : public PartWriter {
 public:
  PlyPartWriter(const std::filesystem::path& path, const PartOutline& outline,
                const WriteOptions& options)
      : path_(path),
        ascii_(options.ascii),
        foreign_(outline.first->foreign_elements),
        columns_(columns_of(*outline.first, ply_names())),
        file_(path, options.overwrite) {
    file_.write(header_of(*outline.first, outline.points, columns_, ascii_));
  }

  void append(const PointCloud& part) override {
    const auto columns = columns_of(part, ply_names());
    check_same_columns(path_, columns_, columns);
    write_blocks(file_, part.size(), [&](std::size_t begin, std::size_t end, std::string& out) {
      if (ascii_) {
        append_text(columns, begin, end, ' ', out);
      } else {
        append_binary(columns, begin, end, out);
      }
    });
  }

  void commit() override {
    for (const ForeignElement& element : foreign_) {
      if (ascii_) {
        file_.write(foreign_text(path_, element));
      } else {
        file_.write(element.bytes);
      }
    }
    file_.commit();
  }

 private:
  std::filesystem::path path_;
  bool ascii_;
  const std::vector<ForeignElement>& foreign_;
  std::vector<ColumnView> columns_;
  OutputFile file_;
};

}  // namespace

std::unique_ptr<PartWriter> create_ply_parts(const std::filesystem::path& path,
                                             const PartOutline& outline,
                                             const WriteOptions& options) {
  return std::make_unique<PlyPartWriter>(path, outline, options);
}

}  // namespace pcednet::io
