#include "pcednet/io/scanners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

struct NumberedScanner {
  std::size_t index = 0;
  Vec3 place = Vec3::Zero();
};

/// The scanner of a comment that add_scanner() made.
std::optional<NumberedScanner> scanner_in(const std::string& comment) {
  constexpr std::size_t kMostScanners = 1 << 16;
  std::vector<std::string_view> words;
  split(comment, words);
  if (words.size() != 5 || words[0] != "scanner" || !words[1].ends_with(':')) return std::nullopt;
  const auto index = parse_count(words[1].substr(0, words[1].size() - 1));
  const auto x = parse_double(words[2]), y = parse_double(words[3]), z = parse_double(words[4]);
  if (!index || *index >= kMostScanners || !x || !y || !z) return std::nullopt;
  return NumberedScanner{*index, {*x, *y, *z}};
}

}  // namespace

void add_scanner(const Vec3& position, PointCloud& cloud) {
  if (position.allFinite()) {
    cloud.comments.push_back(fmt::format("scanner {}: {} {} {}", cloud.scanners.size(),
                                         position.x(), position.y(), position.z()));
  }
  cloud.scanners.push_back(position);
}

std::vector<Vec3> scanners_of_comments(const std::vector<std::string>& comments) {
  std::vector<Vec3> scanners;
  for (const std::string& comment : comments) {
    const auto scanner = scanner_in(comment);
    if (!scanner) continue;
    if (scanners.size() <= scanner->index) {
      scanners.resize(scanner->index + 1, Vec3::Constant(NAN));
    }
    scanners[scanner->index] = scanner->place;
  }
  return scanners;
}

bool are_same(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Vec3& one, const Vec3& other) {
    return one == other || !(one.allFinite() || other.allFinite());
  });
}

void set_scanners(const std::vector<Vec3>& scanners, PointCloud& cloud) {
  std::erase_if(cloud.comments, [](const auto& one) { return scanner_in(one).has_value(); });
  cloud.scanners.clear();
  for (const Vec3& place : scanners) add_scanner(place, cloud);
}

bool has_several_scans(const PointCloud& cloud) {
  return cloud.scanners.size() > 1 || find_attribute(cloud, "scan");
}

}  // namespace pcednet::io
