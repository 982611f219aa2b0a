#include "workbench/annotate/scene/described.h"

#include <fmt/format.h>

#include <array>
#include <fstream>

#include "pcednet/core/digest.h"
#include "pcednet/core/error.h"
#include "pcednet/core/output_file.h"
#include "pcednet/core/version.h"
#include "pcednet/detect/acute_edge.h"
#include "pcednet/detect/cloud_kind.h"

namespace pcednet::annotate {
namespace {

namespace fs = std::filesystem;

/// The beginning of a file; the scales, the rows' points and their values follow.
struct Header {
  std::array<char, 8> magic = {'p', 'c', 'e', 'd', 'd', 's', 'c', '2'};
  std::array<std::uint64_t, 2> key = {}, content = {};
  std::uint64_t points = 0, scales = 0, rows = 0, width = 0;
};

/// Everything that determines the description.
std::array<std::uint64_t, 2> key_of(const detect::PreparedCloud& cloud,
                                    const gls::ScaleSpaceOptions& descriptor) {
  const auto coordinates = [](std::span<const Vec3> values) {
    return std::span(values.empty() ? nullptr : values.front().data(), 3 * values.size());
  };
  return Digest()
      .add_values(coordinates(cloud.positions))
      .add_values(coordinates(cloud.normals))
      .add(fmt::format("{} {}", kVersion, gls::text_of(descriptor)))
      .lanes();
}

std::array<std::uint64_t, 2> content_of(const detect::DescribedCloud& cloud) {
  return Digest()
      .add_values(std::span<const double>(cloud.scales))
      .add_values(std::span<const std::uint32_t>(cloud.order))
      .add_values(std::span<const float>(cloud.values))
      .lanes();
}

/// True if the file matches `wanted`; then `cloud` is filled.
bool read_cache(const fs::path& path, const Header& wanted, detect::DescribedCloud& cloud) {
  std::ifstream file(path, std::ios::binary);
  Header header;
  if (!file.read(reinterpret_cast<char*>(&header), sizeof header)) return false;
  if (header.magic != wanted.magic || header.key != wanted.key || header.points != wanted.points ||
      header.scales != wanted.scales || header.width != wanted.width ||
      header.rows > header.points) {
    return false;
  }
  std::error_code error;
  if (fs::file_size(path, error) !=
      sizeof header + 8 * header.scales + header.rows * 4 * (1 + header.width)) {
    return false;
  }
  cloud.points = header.points;
  cloud.scales.resize(header.scales);
  cloud.order.resize(header.rows);
  cloud.values.resize(header.rows * header.width);
  const auto read = [&](auto& values) {
    file.read(reinterpret_cast<char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof values[0]));
  };
  read(cloud.scales);
  read(cloud.order);
  read(cloud.values);
  return file && content_of(cloud) == header.content;
}

void write_cache(const fs::path& path, Header header, const detect::DescribedCloud& cloud) {
  header.rows = cloud.order.size();
  header.content = content_of(cloud);
  fs::create_directories(path.parent_path());
  OutputFile file(path, Overwrite::kYes);
  file.write(std::as_bytes(std::span(&header, 1)));
  file.write(std::as_bytes(std::span(cloud.scales)));
  file.write(std::as_bytes(std::span(cloud.order)));
  file.write(std::as_bytes(std::span(cloud.values)));
  file.commit();
}

}  // namespace

std::shared_ptr<const Described> describe_once(const detect::PreparedCloud& cloud,
                                               const gls::ScaleSpaceOptions& descriptor,
                                               const fs::path& folder, const Progress* progress) {
  auto described = std::make_shared<Described>();
  described->descriptor = descriptor;
  Header header;
  header.key = key_of(cloud, descriptor);
  header.points = cloud.positions.size();
  header.scales = static_cast<std::uint64_t>(descriptor.scales);
  header.width = static_cast<std::uint64_t>(descriptor.scales) *
                 static_cast<std::uint64_t>(gls::column_count(descriptor));
  const fs::path file = folder / fmt::format("{:016x}.description", header.key[0]);
  described->from_cache = !folder.empty() && read_cache(file, header, described->cloud);
  if (described->from_cache) {
    described->cloud.traits = detect::traits_of(cloud, descriptor);
    described->cloud.acute_edges = detect::find_acute_edges(cloud, descriptor, progress);
  } else {
    described->cloud = detect::describe(cloud, descriptor, progress);
    try {
      if (!folder.empty()) write_cache(file, header, described->cloud);
    } catch (const Error&) {  // a full disk or a folder without the right to write costs time only
    } catch (const fs::filesystem_error&) {
    }
  }
  described->row_of.assign(cloud.positions.size(), kNoRow);
  for (std::size_t row = 0; row < described->cloud.order.size(); ++row) {
    const std::uint32_t point = described->cloud.order[row];
    if (point >= described->row_of.size()) {
      throw Error(ErrorKind::kFailure, fmt::format("{}: damaged", file.string()));
    }
    described->row_of[point] = static_cast<std::uint32_t>(row);
  }
  return described;
}

}  // namespace pcednet::annotate
