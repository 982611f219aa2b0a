#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "pcednet/io/coordinate_system.h"
#include "pcednet/io/e57/e57.h"
#include "pcednet/io/e57/points.h"
#include "pcednet/io/e57/scans.h"
#include "pcednet/io/scanners.h"

namespace pcednet::io {
namespace {

void describe_scans(const E57Document& document, PointCloud& cloud) {
  if (!document.coordinate_system.empty()) {
    cloud.comments.push_back(std::string(kSystemComment) + document.coordinate_system);
  }
  for (std::size_t s = 0; s < document.scans.size(); ++s) {
    const E57Scan& scan = document.scans[s];
    const std::string by = scan.sensor.empty() ? "" : ", " + scan.sensor;
    cloud.comments.push_back(fmt::format("scan {}: {}{}", s, scan.name, by));
    add_scanner(scan.knows_scanner() ? scan.translation : Vec3::Constant(NAN), cloud);
  }
}

/// A part is a scan; those without points are passed over.
class E57PartReader : public PartReader {
 public:
  explicit E57PartReader(std::unique_ptr<InputFile> file)
      : file_(std::move(file)), pages_(*file_), document_(read_e57_document(pages_)) {
    const auto& scans = document_.scans;
    check_e57_sizes(pages_, scans);
    for (const E57Scan& scan : scans) check_e57_fields(*file_, scan);
    silent_ = E57Collector(scans).silent();
    const bool any_state = std::any_of(scans.begin(), scans.end(), has_invalid_points);
    const bool must_look = any_state || !silent_.empty();
    std::uint64_t promised = 0;
    for (std::size_t s = 0; s < scans.size(); ++s) {
      promised += scans[s].points;
      std::size_t valid = scans[s].points;
      if (must_look && valid > 0) {
        const E57Collector looked = collect(s);
        std::erase_if(silent_, [&](const auto& name) { return looked.silent().count(name) == 0; });
        valid = looked.size();
      }
      if (valid > 0) with_points_.push_back(s);
      points_ += valid;
    }
    warnings = e57_warnings(scans, promised - points_);
  }

  std::size_t points() const override { return points_; }
  std::size_t parts() const override { return with_points_.size(); }

  PointCloud read(std::size_t part) const override {
    PointCloud cloud = collect(with_points_[part]).finish(silent_).cloud;
    if (part == 0) describe_scans(document_, cloud);
    return cloud;
  }

 private:
  E57Collector collect(std::size_t scan) const {
    E57Collector collector(document_.scans);
    collector.append(pages_, scan);
    return collector;
  }

  std::unique_ptr<InputFile> file_;
  E57Pages pages_;
  E57Document document_;
  std::set<std::string> silent_ = {};  ///< attributes that say nothing of any point
  std::vector<std::size_t> with_points_ = {};
  std::size_t points_ = 0;
};

}  // namespace

LoadedCloud read_e57(const InputFile& file) {
  const E57Pages pages(file);
  const E57Document document = read_e57_document(pages);
  check_e57_sizes(pages, document.scans);
  E57Collector collector(document.scans);
  for (std::size_t s = 0; s < document.scans.size(); ++s) {
    check_e57_fields(file, document.scans[s]);
    collector.append(pages, s);
  }
  LoadedCloud loaded = collector.finish(collector.silent());
  describe_scans(document, loaded.cloud);
  return loaded;
}

std::unique_ptr<PartReader> open_e57_parts(std::unique_ptr<InputFile> file) {
  return std::make_unique<E57PartReader>(std::move(file));
}

}  // namespace pcednet::io
