#include <algorithm>
#include <set>

#include "pcednet/io/ply/body.h"
#include "pcednet/io/ply/ply.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/scanners.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// Bytes beside the vertices that are read with part 0.
constexpr std::uint64_t kMostBesides = std::uint64_t{1} << 24;

/// Whether the roles of all columns follow from their names and types, for any numbers.
bool speak_for_themselves(const std::vector<Column>& columns) {
  std::set<std::string> decided;  // names that columns of bytes have taken, as LAS colours do
  return std::all_of(columns.begin(), columns.end(), [&](const Column& column) {
    const std::string name = lower_case(column.name);
    if (column.type == ScalarType::kUint8) {
      decided.insert(name);
      return true;
    }
    const auto names_it = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    if (names_it(label_names()) || names_it({"rgb", "rgba"})) return false;
    return decided.contains(name) ||
           std::none_of(colour_names().begin(), colour_names().end(), names_it);
  });
}

bool is_readable_in_parts(const InputFile& file, const PlyHeader& header) {
  const auto vertices = std::count_if(header.elements.begin(), header.elements.end(), is_vertex);
  if (header.encoding == PlyEncoding::kAscii || vertices != 1) return false;
  const auto& vertex = *std::find_if(header.elements.begin(), header.elements.end(), is_vertex);
  const auto columns = scalar_columns(vertex);
  if (vertex.has_lists() || vertex.fixed_bytes() == 0 || !speak_for_themselves(columns)) {
    return false;
  }
  const std::uint64_t rest = file.size() - header.bytes;
  return vertex.count <= rest / vertex.fixed_bytes() &&
         rest - vertex.count * vertex.fixed_bytes() <= kMostBesides;
}

class PlyPartReader : public PartReader {
 public:
  PlyPartReader(std::unique_ptr<InputFile> file, PlyHeader header, std::size_t most)
      : file_(std::move(file)), header_(std::move(header)), most_(most) {
    PlyBinaryBody body(*file_, header_);
    for (const PlyElement& element : header_.elements) {
      check_fits(*file_, element, body.offset(), false);
      if (is_vertex(element)) {
        vertex_ = &element;
        vertex_offset_ = body.offset();
        body.skip(element);
      } else {
        foreign_.push_back({element.text, body.read_foreign(element)});
      }
    }
    warn_of_unread(body.unread(), warnings);
  }

  std::size_t points() const override { return vertex_->count; }
  std::size_t parts() const override { return (points() + most_ - 1) / most_; }

  PointCloud read(std::size_t part) const override {
    const std::size_t begin = part * most_;
    CloudBuilder builder(file_->path(), scalar_columns(*vertex_),
                         std::min(most_, points() - begin));
    PlyBinaryBody(*file_, header_).read_rows(*vertex_, vertex_offset_, begin, builder);
    PointCloud cloud = builder.finish().cloud;
    if (part == 0) {
      cloud.comments = header_.comments;
      cloud.foreign_elements = foreign_;
      cloud.scanners = scanners_of_comments(cloud.comments);
    }
    return cloud;
  }

 private:
  std::unique_ptr<InputFile> file_;
  PlyHeader header_;
  std::size_t most_;
  const PlyElement* vertex_ = nullptr;
  std::uint64_t vertex_offset_ = 0;
  std::vector<ForeignElement> foreign_ = {};
};

}  // namespace

std::unique_ptr<PartReader> open_ply_parts(std::unique_ptr<InputFile> file, std::size_t most) {
  PlyHeader header = read_ply_header(*file);
  if (!is_readable_in_parts(*file, header)) return nullptr;
  return std::make_unique<PlyPartReader>(std::move(file), std::move(header), most);
}

}  // namespace pcednet::io
