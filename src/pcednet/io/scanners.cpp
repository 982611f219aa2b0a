#include "pcednet/io/scanners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/io/text_scan.h"

namespace pcednet::io {

void add_scanner(const Vec3& position, PointCloud& cloud) {
  if (position.allFinite()) {
    cloud.comments.push_back(fmt::format("scanner {}: {} {} {}", cloud.scanners.size(),
                                         position.x(), position.y(), position.z()));
  }
  cloud.scanners.push_back(position);
}

std::vector<Vec3> scanners_of_comments(const std::vector<std::string>& comments) {
  constexpr std::size_t kMostScanners = 1 << 16;
  std::vector<Vec3> scanners;
  std::vector<std::string_view> words;
  for (const std::string& comment : comments) {
    split(comment, words);
    if (words.size() != 5 || words[0] != "scanner" || !words[1].ends_with(':')) continue;
    const auto index = parse_count(words[1].substr(0, words[1].size() - 1));
    const auto x = parse_double(words[2]), y = parse_double(words[3]), z = parse_double(words[4]);
    if (!index || *index >= kMostScanners || !x || !y || !z) continue;
    if (scanners.size() <= *index) scanners.resize(*index + 1, Vec3::Constant(NAN));
    scanners[*index] = {*x, *y, *z};
  }
  return scanners;
}

bool are_same(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Vec3& one, const Vec3& other) {
    return one == other || !(one.allFinite() || other.allFinite());
  });
}

void set_scanners(const std::vector<Vec3>& scanners, PointCloud& cloud) {
  std::erase_if(cloud.comments, [](const auto& one) { return one.starts_with("scanner "); });
  cloud.scanners.clear();
  for (const Vec3& place : scanners) add_scanner(place, cloud);
}

bool has_several_scans(const PointCloud& cloud) {
  return cloud.scanners.size() > 1 || find_attribute(cloud, "scan");
}

}  // namespace pcednet::io
