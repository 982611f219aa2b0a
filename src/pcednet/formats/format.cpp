#include "pcednet/formats/format.h"

#include <fmt/format.h>

#include "pcednet/core/error.h"
#include "pcednet/io/e57/e57.h"
#include "pcednet/io/las/facts.h"
#include "pcednet/io/las/file.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/mesh/obj.h"
#include "pcednet/io/mesh/off.h"
#include "pcednet/io/mesh/stl.h"
#include "pcednet/io/pcd/header.h"
#include "pcednet/io/pcd/pcd.h"
#include "pcednet/io/ply/header.h"
#include "pcednet/io/ply/ply.h"
#include "pcednet/io/text/ptx.h"
#include "pcednet/io/text/xyz.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::formats {
namespace {

namespace fs = std::filesystem;

std::uint64_t ply_points(const io::InputFile& file) {
  std::uint64_t points = 0;
  for (const io::PlyElement& element : io::read_ply_header(file).elements) {
    if (element.name == "vertex") points += element.count;
  }
  return points;
}

/// The whole table, in the order in which messages list it.
std::vector<Format> make_formats() {
  return {
      {.name = "PLY",
       .extensions = {".ply"},
       .begins = io::begins_as_ply,
       .points = ply_points,
       .read = io::read_ply,
       .open_parts = io::open_ply_parts,
       .create_parts = io::create_ply_parts,
       .keeps = [](const ForeignElement&) { return true; }},
      {.name = "PCD",
       .extensions = {".pcd"},
       .begins = io::begins_as_pcd,
       .points = [](const auto& file) -> std::uint64_t { return io::read_pcd_header(file).points; },
       .read = io::read_pcd,
       .write = io::write_pcd},
      {.name = "LAS",
       .extensions = {".las", ".laz", ".copc.laz"},
       .begins = io::begins_as_las,
       .points = [](const auto& file) -> std::uint64_t { return io::las_outline(file).points; },
       .read = io::read_las,
       .open_parts = io::open_las_parts,
       .create_parts = io::create_las_parts,
       .check_positions = io::check_las_positions,
       .losses = io::las_losses,
       .keeps = io::is_las_element},
      {.name = "E57",
       .extensions = {".e57"},
       .begins = io::begins_as_e57,
       .read = io::read_e57,
       .open_parts = [](auto file, std::size_t) { return io::open_e57_parts(std::move(file)); }},
      {.name = "PTX", .extensions = {".ptx"}, .read = io::read_ptx},
      {.name = "OBJ",
       .extensions = {".obj"},
       .read = io::read_obj,
       .write = io::write_obj,
       .losses = [](const fs::path&, const PointCloud& cloud) { return io::obj_losses(cloud); }},
      {.name = "OFF", .extensions = {".off"}, .read = io::read_off},
      {.name = "STL", .extensions = {".stl"}, .is_mesh = true, .read = io::read_stl},
      {.name = "text",
       .extensions = {".xyz", ".txt", ".asc", ".pts", ".csv"},
       .read = io::read_xyz,
       .open_parts = io::open_xyz_parts,
       .create_parts = io::create_xyz_parts,
       .losses =
           [](const fs::path& path, const PointCloud& cloud) {
             return io::xyz_losses(path, io::outline_of(cloud));
           }},
  };
}

std::string list_extensions(std::string_view last, bool (*has)(const Format&)) {
  std::string list;
  std::size_t end = 0;
  for (const Format& format : all_formats()) {
    if (!has(format)) continue;
    for (const std::string_view extension : format.extensions) {
      end = list.size();
      list += fmt::format("{}{}", list.empty() ? "" : " ", extension);
    }
  }
  return list.replace(end, 1, last);
}

}  // namespace

std::span<const Format> all_formats() {
  static const std::vector<Format> formats = make_formats();
  return formats;
}

const Format* find_format(const fs::path& path) {
  const std::string extension = io::extension_of(path);
  for (const Format& format : all_formats()) {
    for (const std::string_view other : format.extensions) {
      if (extension == other) return &format;
    }
  }
  return nullptr;
}

std::string stem_of(const fs::path& path) {
  const fs::path stem = path.stem();
  const bool is_copc = io::extension_of(path) == ".laz" && io::extension_of(stem) == ".copc";
  return is_copc ? stem.stem().string() : stem.string();
}

const Format& format_of(const io::InputFile& file) {
  if (file.size() == 0) throw io::unreadable(file.path(), "the file is empty");
  const std::string start = file.text(0, 16);
  for (const Format& format : all_formats()) {
    if (format.begins && format.begins(start)) return format;
  }
  if (const Format* format = find_format(file.path())) return *format;
  throw io::unreadable(file.path(),
                       fmt::format("not a format known here; accepted: {}", extensions_read()));
}

const Format& format_for(const fs::path& path) {
  const Format* format = find_format(path);
  if (format && format->is_written()) return *format;
  throw Error(ErrorKind::kUsage,
              fmt::format("{}: points are written as {}", path.string(), extensions_written()));
}

void add_lost_elements(const PointCloud& cloud, const Format& format,
                       std::vector<std::string>& lost) {
  // A format that keeps any elements keeps those of LAS.
  const auto of_las = format.keeps ? std::vector<std::string>() : io::las_element_losses(cloud);
  lost.insert(lost.end(), of_las.begin(), of_las.end());
  for (const ForeignElement& element : cloud.foreign_elements) {
    if (io::is_las_element(element) || (format.keeps && format.keeps(element))) continue;
    lost.push_back(fmt::format("{:.60}", element.header.substr(0, element.header.find('\n'))));
  }
}

std::string extensions_read(std::string_view last) {
  return list_extensions(last, [](const Format&) { return true; });
}

std::string extensions_written(std::string_view last) {
  return list_extensions(last, [](const Format& format) { return format.is_written(); });
}

}  // namespace pcednet::formats
