#include "pcednet/formats/virtual_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <set>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/formats/file_name.h"
#include "pcednet/formats/format.h"
#include "pcednet/io/column_names.h"
#include "pcednet/io/las/facts.h"
#include "pcednet/io/las/offsets.h"
#include "pcednet/io/projection.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::formats {
namespace {

namespace fs = std::filesystem;
using Ring = std::vector<std::array<double, 2>>;

const char* stac_type(ScalarType type) {
  switch (type) {
    case ScalarType::kFloat32:
    case ScalarType::kFloat64:
      return "floating";
    case ScalarType::kInt8:
    case ScalarType::kInt16:
    case ScalarType::kInt32:
    case ScalarType::kInt64:
      return "signed";
    default:
      return "unsigned";
  }
}

/// The fields of a LAS record by PDAL's names and types.
std::vector<VirtualFile::Field> fields_of(const std::vector<io::LasField>& fields) {
  std::vector<VirtualFile::Field> named;
  for (const io::LasField& field : fields) {
    const bool is_axis = field.name == "X" || field.name == "Y" || field.name == "Z";
    const bool is_angle = field.name == "ScanAngle" || field.name == "ScanAngleRank";
    if (is_axis) {
      named.push_back({field.name, ScalarType::kFloat64});
    } else if (is_angle) {
      named.push_back({"ScanAngleRank", ScalarType::kFloat32});
    } else {
      const bool ours = field.name.starts_with("scalar_");
      named.push_back({ours ? field.name.substr(7) : field.name, field.type});
    }
  }
  return named;
}

Ring corners_of(const BoundingBox& box) {
  return {{box.min.x(), box.min.y()},
          {box.max.x(), box.min.y()},
          {box.max.x(), box.max.y()},
          {box.min.x(), box.max.y()},
          {box.min.x(), box.min.y()}};
}

OrderedJson polygon(const Ring& ring) {
  return {{"type", "Polygon"}, {"coordinates", OrderedJson::array({ring})}};
}

OrderedJson box_around(const Ring& ring, const BoundingBox& heights) {
  const auto [west, east] = std::minmax_element(ring.begin(), ring.end());
  const auto by_latitude = [](const auto& a, const auto& b) { return a[1] < b[1]; };
  const auto [south, north] = std::minmax_element(ring.begin(), ring.end(), by_latitude);
  return {(*west)[0], (*south)[1], heights.min.z(), (*east)[0], (*north)[1], heights.max.z()};
}

/// The day as STAC writes it; null if it is invalid.
OrderedJson day_of(const VirtualFile& file) {
  using namespace std::chrono;
  if (file.created_year == 0 || file.created_day == 0 || file.created_day > 366) return nullptr;
  const sys_days first = year(static_cast<int>(file.created_year)) / January / 1;
  const year_month_day date(first + days(file.created_day - 1));
  return fmt::format("{:04}-{:02}-{:02}T00:00:00Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

/// A URL relative to the folder; readers recognise it by the prefix "./".
std::string reference_to(const fs::path& file, const fs::path& folder) {
  std::error_code fault;
  const fs::path relative = fs::relative(file, folder, fault);
  const bool is_relative = !fault && !relative.empty();
  check_is_utf8(is_relative ? relative : fs::absolute(file));
  return is_relative ? "./" + relative.generic_string() : fs::absolute(file).generic_string();
}

OrderedJson properties_of(const VirtualFile& file, const std::string& definition) {
  OrderedJson schemas = OrderedJson::array();
  for (const VirtualFile::Field& field : file.fields) {
    schemas.push_back(
        {{"name", field.name}, {"size", size_of(field.type)}, {"type", stac_type(field.type)}});
  }
  const BoundingBox& box = file.bounds;
  // Not proj:epsg: QGIS takes its number for an internal id.
  return {{"datetime", day_of(file)},
          {"pc:count", file.points},
          {"pc:type", "lidar"},
          {"pc:encoding", file.encoding},
          {"pc:schemas", std::move(schemas)},
          {"proj:wkt2", definition},
          {"proj:geometry", polygon(corners_of(box))},
          {"proj:bbox",
           {box.min.x(), box.min.y(), box.min.z(), box.max.x(), box.max.y(), box.max.z()}}};
}

OrderedJson item_of(const VirtualFile& file, const std::string& id, const fs::path& folder) {
  Ring ring = corners_of(file.bounds);
  const auto on_earth = io::to_wgs84(file.coordinate_system, ring);
  std::string definition;
  if (on_earth) {
    ring = *on_earth;
    definition = io::definition_of(file.coordinate_system, io::WktVersion::k2);
  }
  return {
      {"type", "Feature"},
      {"stac_version", "1.0.0"},
      {"stac_extensions",
       {"https://stac-extensions.github.io/pointcloud/v1.0.0/schema.json",
        "https://stac-extensions.github.io/projection/v1.1.0/schema.json"}},
      {"id", id},
      {"geometry", polygon(ring)},
      {"bbox", box_around(ring, file.bounds)},
      {"properties", properties_of(file, definition)},
      {"links", OrderedJson::array()},
      {"assets",
       {{"data",
         {{"href", reference_to(file.path, folder)}, {"roles", OrderedJson::array({"data"})}}}}}};
}

std::vector<std::string> remarks_on(std::span<const VirtualFile> files, std::size_t empty,
                                    const OrderedJson& items) {
  std::vector<std::string> remarks;
  if (empty > 0)
    remarks.push_back(fmt::format("{} of {} files have no points", empty, files.size()));
  std::set<std::string> systems;
  for (std::size_t i = 0, item = 0; i < files.size(); ++i) {
    if (files[i].points == 0) continue;  // it has no item
    const std::string wkt = items[item++]["properties"]["proj:wkt2"];
    const std::string codes = io::code_text(files[i].coordinate_system);
    systems.insert(wkt.empty() || codes.empty() ? wkt : codes);  // texts of one code may differ
  }
  if (systems.size() > 1) {
    remarks.emplace_back("the files are not all of one coordinate system: QGIS takes the first");
  }
  const auto is_unnamed = [](const VirtualFile& file) {
    const io::CoordinateSystem& system = file.coordinate_system;
    return file.points > 0 && system.epsg == 0 && system.wkt.empty();
  };
  const auto unnamed = static_cast<std::size_t>(std::ranges::count_if(files, is_unnamed));
  const auto unknown =
      static_cast<std::size_t>(std::ranges::count_if(
          items, [](const OrderedJson& item) { return item["properties"]["proj:wkt2"] == ""; })) -
      unnamed;
  if (unknown > 0) {
    remarks.emplace_back(io::has_projections()
                             ? "PROJ does not know the coordinate system: it is left out"
                             : "without PROJ: the coordinate system is left out");
  }
  if (unnamed > 0 && unnamed < items.size()) {
    const std::string first = std::ranges::find_if(files, is_unnamed)->path.string();
    remarks.push_back(fmt::format("{} of {} files name no coordinate system, such as {}", unnamed,
                                  files.size(), first));
  }
  return remarks;
}

/// The assets of an item that are point data: by role, otherwise by name.
std::vector<std::string> references_in(const Json& item) {
  std::vector<std::string> references;
  const Json assets = item.is_object() ? item.value("assets", Json::object()) : Json::object();
  for (const auto& [name, asset] : assets.items()) {
    const Json roles = asset.is_object() ? asset.value("roles", Json()) : Json();
    const bool is_data = roles.is_array()
                             ? std::find(roles.begin(), roles.end(), "data") != roles.end()
                             : name == "data";
    if (!is_data || !asset.is_object() || !asset.contains("href")) continue;
    if (asset["href"].is_string()) references.push_back(asset["href"]);
  }
  return references;
}

/// The file that an item of `cloud` refers to.
fs::path file_behind(const std::string& reference, const fs::path& cloud) {
  constexpr std::string_view kFile = "file://";
  const bool is_file = reference.starts_with(kFile);
  if (!is_file && reference.find("://") != std::string::npos) {
    throw io::unreadable(cloud, reference + " is remote: only local files are read");
  }
  const std::string name = is_file ? reference.substr(kFile.size()) : reference;
  const fs::path path = cloud.parent_path() / name;
  std::error_code error;
  if (!fs::exists(path, error)) {
    // Some programs write names as they are, others as in a URL.
    const fs::path decoded = cloud.parent_path() / io::percent_decoded(name);
    if (fs::exists(decoded, error)) return decoded.lexically_normal();
    throw io::unreadable(cloud, fmt::format("refers to {}, but {} does not exist", reference,
                                            path.lexically_normal().string()));
  }
  return path.lexically_normal();
}

/// Null where the file holds none.
Json json_in(const fs::path& path) {
  try {
    return parse_json(io::InputFile(path).text());
  } catch (const Json::parse_error&) {
    return {};
  }
}

}  // namespace

bool is_virtual_cloud(const fs::path& path) {
  return io::extension_of(path) == ".vpc";
}

std::vector<fs::path> files_of_virtual_cloud(const fs::path& path) {
  const Json whole = json_in(path);
  const auto items = whole.is_object() ? whole.find("features") : whole.end();
  if (!whole.is_object() || items == whole.end() || !items->is_array()) {
    throw io::unreadable(path, "not a virtual point cloud: no JSON with features");
  }
  std::vector<fs::path> files;
  for (const Json& item : *items) {
    for (const std::string& reference : references_in(item)) {
      files.push_back(file_behind(reference, path));
    }
  }
  if (files.empty()) {
    throw Error(ErrorKind::kInsufficient, path.string() + ": names no point files");
  }
  return files;
}

VirtualFile virtual_file(const fs::path& path) {
  const io::InputFile file(path);
  if (!format_of(file).is_las()) {
    throw Error(ErrorKind::kInsufficient,
                path.string() + ": a virtual point cloud can list only LAS, LAZ and COPC files");
  }
  const io::LasOutline las = io::las_outline(file);
  if (las.points > 0 && las.bounds.empty()) {
    throw io::unreadable(path, fmt::format("byte {}: the header has no bounds of the points; "
                                           "pcednet convert writes them",
                                           io::las_header::kBounds));
  }
  return {.path = path,
          .points = las.points,
          .bounds = las.bounds,
          .coordinate_system = las.coordinate_system,
          .encoding = las.copc         ? "copc"
                      : las.compressed ? "laz"
                                       : "las",
          .created_day = las.created_day,
          .created_year = las.created_year,
          .fields = fields_of(las.fields)};
}

std::vector<std::string> write_virtual_cloud(const fs::path& path,
                                             std::span<const VirtualFile> files,
                                             Overwrite overwrite) {
  const fs::path folder = fs::absolute(path).parent_path();
  OrderedJson items = OrderedJson::array();
  std::set<std::string> ids;
  for (const VirtualFile& file : files) {
    if (file.points == 0) continue;
    const std::string stem = file.path.stem().string();
    std::string id = stem;
    for (int i = 2; !ids.insert(id).second; ++i) id = fmt::format("{}-{}", stem, i);
    items.push_back(item_of(file, id, folder));
  }
  if (items.empty()) {
    throw Error(ErrorKind::kInsufficient, path.string() + ": none of its files has points");
  }
  std::vector<std::string> remarks = remarks_on(files, files.size() - items.size(), items);
  const OrderedJson whole = {{"type", "FeatureCollection"}, {"features", std::move(items)}};
  // Names of systems and of extra bytes need not be UTF-8.
  write_text_file(path, to_text(whole, 2, NotUtf8::kReplace) + "\n", overwrite);
  return remarks;
}

}  // namespace pcednet::formats
