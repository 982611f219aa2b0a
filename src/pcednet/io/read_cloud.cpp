#include "pcednet/io/read_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pcednet/io/e57.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/las.h"
#include "pcednet/io/obj.h"
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

}  // namespace

LoadedCloud read_cloud(const std::filesystem::path& path) {
  LoadedCloud loaded = read_format(InputFile(path));
  PointCloud& cloud = loaded.cloud;
  if (cloud.scanners.empty()) cloud.scanners = scanners_of_comments(cloud.comments);
  loaded.rescaled_normals = static_cast<std::size_t>(
      std::count_if(cloud.normals.begin(), cloud.normals.end(), [](const Vec3& normal) {
        const double length = normal.norm();
        return std::isfinite(length) && length > 0.0 && std::abs(length - 1.0) > 1e-3;
      }));
  const std::size_t unusable = make_normals_unit(cloud);
  if (unusable > 0 && unusable == cloud.size()) {
    cloud.normals.clear();
    loaded.warnings.emplace_back("all normals are zero or not finite: taken as absent");
  } else if (unusable > 0) {
    loaded.warnings.push_back(
        fmt::format("{} of {} normals are zero or not finite", unusable, cloud.size()));
  }
  const auto not_finite = [](const Vec3& position) { return !position.allFinite(); };
  const auto lost = std::count_if(cloud.positions.begin(), cloud.positions.end(), not_finite);
  if (lost > 0) {
    loaded.warnings.push_back(fmt::format("{} of {} positions are not finite", lost, cloud.size()));
  }
  return loaded;
}

const char* format_name(const std::filesystem::path& path) {
  static constexpr std::array kNames = {"PLY", "PCD", "OBJ", "text", "LAS", "E57"};
  return kNames[static_cast<std::size_t>(find_format(InputFile(path)))];
}

}  // namespace pcednet::io
