#include "point_filter.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <utility>

#include "number_options.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/text_scan.h"
#include "workbench/shapes/perturb.h"

namespace pcednet::app {
namespace {

constexpr const char* kCodes = "Classification";

const std::vector<std::string>& flag_names() {
  static const std::vector<std::string> names = {"withheld", "overlap", "synthetic"};
  return names;
}

const Attribute& field_of(const PointCloud& cloud, const std::string& name) {
  if (const Attribute* field = io::find_called(cloud, io::lower_case(name))) return *field;
  throw Error(ErrorKind::kInsufficient, fmt::format("has no field {} to choose points by", name));
}

bool holds(const std::vector<std::uint8_t>& codes, double value) {
  return std::ranges::find(codes, value) != codes.end();
}

std::vector<std::uint32_t> points_kept(const PointCloud& cloud, const PointFilter& filter) {
  const bool by_code = !filter.kept.empty() || !filter.dropped.empty();
  const Attribute* codes = by_code ? &field_of(cloud, kCodes) : nullptr;
  std::vector<const Attribute*> flags;
  for (const std::string& name : filter.flags) flags.push_back(&field_of(cloud, name));
  std::vector<std::uint32_t> points;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (!filter.kept.empty() && !holds(filter.kept, codes->value(i))) continue;
    if (!filter.dropped.empty() && holds(filter.dropped, codes->value(i))) continue;
    const auto is_set = [&](const Attribute* flag) { return flag->value(i) != 0.0; };
    if (std::ranges::none_of(flags, is_set)) points.push_back(i);
  }
  return points;
}

}  // namespace

void add_filter_options(CLI::App& command, PointFilter& filter) {
  CLI::Option* kept =
      command
          .add_option("--keep-class", filter.kept,
                      "Keep the points of these codes of the LAS field Classification alone, with "
                      "commas between: 6 (buildings) or 2,6")
          ->delimiter(',')
          ->transform(whole_number(0, 255));
  command
      .add_option("--drop-class", filter.dropped,
                  "Leave out the points of these codes, such as 7,18 (noise)")
      ->delimiter(',')
      ->transform(whole_number(0, 255))
      ->excludes(kept);
  command
      .add_option("--drop-flag", filter.flags,
                  "Leave out the points with one of these flags of LAS: withheld (deleted), "
                  "overlap, synthetic, with commas between")
      ->delimiter(',')
      ->check(CLI::IsMember(flag_names()));
}

PointCloud filtered(PointCloud cloud, const PointFilter& filter) {
  if (!filter.is_on()) return cloud;
  detect::set_estimated_normals(cloud, false);  // estimates are of the points before
  return shapes::select(cloud, points_kept(cloud, filter));
}

FilteredParts::FilteredParts(const io::PartReader& reader, const PointFilter& filter,
                             const Progress& progress)
    : reader_(reader), filter_(filter) {
  Stage stage(filter.is_on() ? &progress : nullptr, "count", reader.points());
  for (std::size_t p = 0; p < reader.parts(); ++p) {
    if (filter.is_on()) {
      const PointCloud part = reader.read(p);
      const std::size_t kept = points_kept(part, filter).size();
      points_ += kept;
      stage.advance(part.size());
      if (kept == 0) continue;
    }
    parts_.push_back(p);
  }
  if (!filter.is_on()) points_ = reader.points();
  check_some_kept(points_, filter);
}

PointCloud FilteredParts::read(std::size_t part) const {
  PointCloud kept = filtered(reader_.read(parts_[part]), filter_);
  if (part > 0 || parts_[0] == 0) return kept;
  PointCloud first = filtered(reader_.read(0), filter_);  // of which no point is kept
  kept.comments = std::move(first.comments);
  kept.foreign_elements = std::move(first.foreign_elements);
  kept.scanners = std::move(first.scanners);
  return kept;
}

void check_some_kept(std::size_t points, const PointFilter& filter) {
  if (points > 0 || !filter.is_on()) return;
  throw Error(ErrorKind::kInsufficient,
              "no point is left by --keep-class, --drop-class or --drop-flag; pcednet info lists "
              "the points by class");
}

}  // namespace pcednet::app
