#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/e57/header.h"
#include "pcednet/io/las/facts.h"

namespace pcednet::formats {

/// Distances between points, measured at no more than 2000 points drawn with a fixed seed.
struct SampledSpacing {
  double mean = 0.0;    ///< to the ten nearest others
  double median = 0.0;  ///< of the distances to the nearest other
  double side = 0.0;    ///< of the square that holds one point, median
  bool uneven = false;  ///< as of clouds that are described at larger scales, too

  /// About the largest scale of the default model, beyond which points are outliers.
  double reach() const { return (uneven ? 80.0 : 10.0) * side; }
};

/// Measures it from the nearest neighbours of the points of a sample.
class SpacingSample {
 public:
  static constexpr std::size_t kNearest = 11;  ///< of a point, itself among them

  /// The squared distances from a point to its nearest, ascending. It does not count if there are
  /// fewer than kNearest, or infinite ones.
  void add(std::span<const double> sq_distances);
  /// None if no point counts.
  std::optional<SampledSpacing> spacing() const;

 private:
  double sum_ = 0.0;
  std::vector<double> nearest_ = {}, sides_ = {};
};

struct AttributeFacts {
  std::string name;
  ScalarType type = ScalarType::kFloat64;
  std::size_t components = 1;
  double least = INFINITY, largest = -INFINITY;  ///< NaN left out

  bool has_numbers() const { return least <= largest; }
};

/// The content of a point file. Counts and measurements are over the points that were read.
struct CloudFacts {
  std::string_view format;  ///< name of its Format
  std::size_t points = 0;
  std::size_t read = 0;  ///< fewer than `points` if sampled
  /// Parts that were read one by one, of a file that need not fit into memory: copies in different
  /// parts do not count as duplicates. 0: the file was read whole.
  std::size_t parts = 0;
  ScalarType position_type = ScalarType::kFloat64;
  BoundingBox bounds = {};
  std::optional<SampledSpacing> spacing = {};  ///< none unless eleven points are finite
  bool has_normals = false, has_colours = false;
  /// Points of each, of the column of edge classes where there are no others.
  std::map<std::uint8_t, std::size_t> labels = {};
  std::vector<AttributeFacts> attributes = {};
  std::vector<std::string> comments = {};
  std::vector<std::string> elements = {};  ///< foreign ones, by the first lines of their headers
  Defects defects = {};
  /// Points with fewer than three others within SampledSpacing::reach(); none if read in parts.
  std::optional<std::size_t> outliers = {};
  std::size_t withheld = 0;  ///< points that LAS marks as deleted
  std::size_t rescaled_normals = 0;
  std::vector<std::string> problems = {};  ///< possible surprises, one sentence each
  std::optional<io::E57Document> e57 = {};
  std::optional<io::LasFacts> las = {};
  std::vector<std::string> warnings = {};  ///< of read_cloud
};

/// Reads the whole file. Throws as read_cloud.
CloudFacts cloud_facts(const std::filesystem::path& path);

/// The facts that the header gives, without points. Throws as read_cloud.
CloudFacts facts_of_header(const io::InputFile& file);

/// Adds the counts of a finished part; the first part also gives what all have in common.
void add_part(const PointCloud& part, CloudFacts& facts);

/// A note that float32 coordinates within `bounds` are rounded to more than the points are apart;
/// empty if they are not. `apart` is the distance of neighbouring places. Rounding along all axes
/// leaves places that are further apart than its steps: there the share of the points at places of
/// their own, `distinct`, gives the distance of the points.
std::string note_on_float(const BoundingBox& bounds, double apart, double distinct = 1.0);

/// The possible surprises in otherwise complete facts.
std::vector<std::string> find_problems(const CloudFacts& facts);

}  // namespace pcednet::formats
