#include "las_codes.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "pcednet/cloud/class_table.h"
#include "pcednet/core/error.h"
#include "pcednet/formats/format.h"
#include "pcednet/io/las/copc.h"
#include "pcednet/io/las/file.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/tiles/inputs.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kField = "Classification";

/// COPC is of a format that holds every code.
bool keeps_format(const fs::path& output) {
  return formats::format_for(output).is_las() && !io::is_copc_name(output);
}

/// The LAS header that a file is, or carries, without its points.
io::LasFile las_file_of(const fs::path& input) {
  const io::InputFile file(input);
  const formats::Format& format = formats::format_of(file);
  std::vector<std::string> ignored;
  if (format.is_las()) return io::read_las_file(file, ignored);
  if (!format.is_tiled()) return {};
  return io::attached_las_file(tiles::read_finished(*tiles::open_chunks(input), 0));
}

void check_fits(const LasCodes& codes, const Job& job, const io::LasFile& las) {
  if (las.header.empty()) return;
  const unsigned format = las.point_format();
  for (const io::LasField& field : io::las_standard_fields(format)) {
    if (field.name != kField || field.bits == 0) continue;
    const int most = (1 << field.bits) - 1;
    for (const auto& [edge_class, code] : codes) {
      if (code <= most) continue;
      throw Error(
          ErrorKind::kUsage,
          fmt::format("{}: --las-classification {}={} does not fit point format {}, which "
                      "{} keeps: its codes are 0 to {}. Point formats 6 to 10, and "
                      ".copc.laz, hold codes up to 255",
                      job.input.string(), edge_class, code, format, job.output.string(), most));
    }
  }
}

}  // namespace

LasCodes las_codes(const std::string& pairs, std::size_t classes) {
  LasCodes codes;
  if (pairs.empty()) return codes;
  for (const std::string& pair : CLI::detail::split(pairs, ',')) {
    const std::vector<std::string> words = CLI::detail::split(CLI::detail::trim_copy(pair), '=');
    const auto edge_class = io::parse_count(words.front()), code = io::parse_count(words.back());
    if (words.size() != 2 || !edge_class || *edge_class >= classes || !code || *code > 255) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("--las-classification: \"{}\" is not class=code, class 0 to {}, code "
                              "0 to 255",
                              pair, classes - 1));
    }
    codes.emplace_back(static_cast<int>(*edge_class), static_cast<int>(*code));
  }
  return codes;
}

void add_label_codes_option(CLI::App& command, std::string& pairs) {
  command.add_option("--las-classification", pairs,
                     "Take the labels from the LAS field Classification: class=code,..., such as "
                     "0=2,0=6,2=64; points of other codes are unlabelled");
}

LasCodes label_codes(const std::string& pairs) {
  const LasCodes codes = las_codes(pairs, edge_classes().size());
  for (auto pair = codes.begin(); pair != codes.end(); ++pair) {
    const auto same = std::find_if(codes.begin(), pair, [&](const auto& before) {
      return before.second == pair->second && before.first != pair->first;
    });
    if (same == pair) continue;
    throw Error(ErrorKind::kUsage,
                fmt::format("--las-classification: code {} stands for the classes {} and {}",
                            pair->second, same->first, pair->first));
  }
  return codes;
}

void check_codes_fit(const LasCodes& codes, const std::vector<Job>& jobs) {
  if (codes.empty()) return;
  for (const Job& job : jobs) {
    std::error_code ignored;  // a pipe can be read only once
    if (!keeps_format(job.output) || !fs::is_regular_file(job.input, ignored)) continue;
    io::LasFile las;
    try {
      las = las_file_of(job.input);
    } catch (const Error&) {
      continue;  // told where the input is read
    }
    check_fits(codes, job, las);
  }
}

void check_codes_fit(const LasCodes& codes, const Job& job, const PointCloud& cloud) {
  if (codes.empty() || !keeps_format(job.output)) return;
  check_fits(codes, job, io::attached_las_file(cloud));
}

void set_las_codes(const LasCodes& codes, const std::vector<std::uint8_t>& classes,
                   PointCloud& cloud) {
  if (codes.empty()) return;
  const Attribute* present = find_attribute(cloud, kField);
  std::vector<std::uint8_t> values(cloud.size());
  if (present && present->type == ScalarType::kUint8 && present->components == 1) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<std::uint8_t>(present->bytes[i]);
    }
  }
  for (const auto& [edge_class, code] : codes) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (classes[i] == edge_class) values[i] = code;
    }
  }
  set_attribute(cloud, make_attribute(kField, values));
}

}  // namespace pcednet::app
