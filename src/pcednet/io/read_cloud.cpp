#include "pcednet/io/read_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "pcednet/io/e57.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/las.h"
#include "pcednet/io/obj.h"
#include "pcednet/io/parts.h"
#include "pcednet/io/pcd.h"
#include "pcednet/io/ply.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/io/xyz.h"

namespace pcednet::io {
namespace {

constexpr const char* kAccepted =
    "accepted: .ply .pcd .las .laz .e57 .obj .xyz .txt .asc .pts .csv";

enum class Format { kPly, kPcd, kObj, kText, kLas, kE57 };

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

Format find_format(const InputFile& file) {
  const std::string start = file.text(0, 16);
  const std::string extension = lower_case(file.path().extension().string());
  const auto begins_with = [&](std::string_view magic) { return start.starts_with(magic); };
  if (begins_with("ply") && start.size() > 3 && (start[3] == '\n' || kBlankSeparators(start[3]))) {
    return Format::kPly;
  }
  if (begins_with("# .PCD") || begins_with("VERSION ") || begins_with("FIELDS ")) {
    return Format::kPcd;
  }
  if (begins_with("LASF")) return Format::kLas;
  if (is_one_of(extension, {".las", ".laz"})) {
    throw unreadable(file.path(), "not a LAS file: it must begin with LASF");
  }
  if (begins_with("ASTM-E57") || extension == ".e57") return Format::kE57;
  if (extension == ".ply") {
    throw unreadable(file.path(), "not a PLY file: the first line must be ply");
  }
  if (extension == ".pcd") {
    throw unreadable(file.path(), "not a PCD file: no header with VERSION and FIELDS", 1);
  }
  if (extension == ".obj") return Format::kObj;
  if (is_one_of(extension, {".xyz", ".txt", ".asc", ".pts", ".csv"})) return Format::kText;
  throw unreadable(file.path(), fmt::format("not a format known here; {}", kAccepted));
}

LoadedCloud read_format(const InputFile& file) {
  switch (find_format(file)) {
    case Format::kPly:
      return read_ply(file);
    case Format::kPcd:
      return read_pcd(file);
    case Format::kObj:
      return read_obj(file);
    case Format::kLas:
      return read_las(file);
    case Format::kE57:
      return read_e57(file);
    case Format::kText:
      break;
  }
  return read_xyz(file);
}

/// Then they are taken as absent, which a part cannot know by itself.
bool all_normals_unusable(const PartReader& reader) {
  for (std::size_t part = 0; part < reader.parts(); ++part) {
    PartTally tally;
    PointCloud points = reader.read(part);
    if (!points.has_normals()) return false;
    finish_part(points, tally);
    if (tally.unusable_normals < tally.points) return false;
  }
  return true;
}

}  // namespace

LoadedCloud read_cloud(const std::filesystem::path& path) {
  LoadedCloud loaded = read_format(InputFile(path));
  PointCloud& cloud = loaded.cloud;
  if (cloud.scanners.empty()) cloud.scanners = scanners_of_comments(cloud.comments);
  PartTally tally;
  finish_part(cloud, tally);
  if (tally.unusable_normals == tally.points) cloud.normals.clear();
  loaded.rescaled_normals = tally.rescaled_normals;
  for (std::string& warning : warnings_of(tally)) loaded.warnings.push_back(std::move(warning));
  return loaded;
}

std::unique_ptr<PartReader> open_parts(const std::filesystem::path& path, std::size_t most) {
  auto file = std::make_unique<InputFile>(path);
  std::unique_ptr<PartReader> reader;
  const Format format = find_format(*file);
  if (format == Format::kPly) reader = open_ply_parts(std::move(file), most);
  if (format == Format::kE57) reader = open_e57_parts(std::move(file));
  if (format == Format::kLas) reader = open_las_parts(std::move(file), most);
  if (!reader || reader->parts() == 0 || all_normals_unusable(*reader)) return nullptr;
  return reader;
}

const char* format_name(const std::filesystem::path& path) {
  static constexpr std::array kNames = {"PLY", "PCD", "OBJ", "text", "LAS", "E57"};
  return kNames[static_cast<std::size_t>(find_format(InputFile(path)))];
}

}  // namespace pcednet::io
