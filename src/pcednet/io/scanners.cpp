#include "pcednet/io/scanners.h"

#include <fmt/format.h>

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

}  // namespace pcednet::io
