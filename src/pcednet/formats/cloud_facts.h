#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/e57/header.h"
#include "pcednet/io/las/facts.h"

namespace pcednet::formats {

/// Distances between points, from at most 2000 of them drawn with a fixed seed.
struct SampledSpacing {
  double mean = 0.0;    ///< to the ten nearest others
  double median = 0.0;  ///< of the distances to the nearest other
};

struct AttributeFacts {
  std::string name;
  ScalarType type = ScalarType::kFloat64;
  std::size_t components = 1;
  double least = 0.0, largest = 0.0;  ///< NaN left out
  bool has_numbers = false;           ///< otherwise these mean nothing
};

/// What a point file holds.
struct CloudFacts {
  std::string_view format;  ///< its Format's name
  std::size_t points = 0;
  ScalarType position_type = ScalarType::kFloat64;
  BoundingBox bounds = {};
  std::optional<SampledSpacing> spacing = {};  ///< none unless eleven points are finite
  bool has_normals = false, has_colours = false;
  std::map<std::uint8_t, std::size_t> labels = {};  ///< points of each; empty without labels
  std::vector<AttributeFacts> attributes = {};
  std::vector<std::string> comments = {};
  std::vector<std::string> elements = {};  ///< foreign ones, by the first lines of their headers
  Defects defects = {};
  std::vector<std::string> problems = {};  ///< what may surprise, one sentence each
  std::optional<io::E57Document> e57 = {};
  std::optional<io::LasFacts> las = {};
  std::vector<std::string> warnings = {};  ///< of read_cloud
};

/// Reads the file. Throws as read_cloud.
CloudFacts cloud_facts(const std::filesystem::path& path);

}  // namespace pcednet::formats
