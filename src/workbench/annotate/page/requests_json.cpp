#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "workbench/annotate/page/json.h"

namespace pcednet::annotate {
namespace {

constexpr std::size_t kMostCentres = 20000, kMostCorners = 20000, kLongestId = 128;

void need(bool good, const char* what) {
  if (!good) throw Error(ErrorKind::kUsage, fmt::format("stroke: {}", what));
}

double number(const Json& value) {
  need(value.is_number(), "a number is missing");
  const double x = value.get<double>();
  need(std::isfinite(x) && std::abs(x) < 1e15, "a number is out of range");
  return x;
}

template <std::size_t N>
std::array<double, N> numbers(const Json& value, const char* what) {
  need(value.is_array() && value.size() == N, what);
  std::array<double, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = number(value[i]);
  return result;
}

Vec3 vector(const Json& value, const char* what) {
  const auto v = numbers<3>(value, what);
  return {v[0], v[1], v[2]};
}

/// -1 if it is none. Json::get() alone would cut off fractions, and higher bits.
std::int64_t whole_number(const Json& value) {
  return value.is_number_integer() ? value.get<std::int64_t>() : -1;
}

std::uint8_t edge_class(const Json& value) {
  const std::int64_t c = whole_number(value);
  need((c >= 0 && c < static_cast<std::int64_t>(kMostClasses)) || c == kUnlabelled,
       "a class is 0 to 7, or 255");
  return static_cast<std::uint8_t>(c);
}

template <typename Whole>
Whole whole(const Json& value, const char* what) {
  const std::int64_t number = whole_number(value);
  if (number < 0 || number > std::numeric_limits<Whole>::max()) {
    throw Error(ErrorKind::kUsage, fmt::format("decide: {}", what));
  }
  return static_cast<Whole>(number);
}

std::vector<std::uint32_t> line_numbers(const Json& lines) {
  std::vector<std::uint32_t> numbers;
  if (!lines.is_array()) throw Error(ErrorKind::kUsage, "decide: lines: a list of numbers");
  for (const Json& line : lines) {
    numbers.push_back(whole<std::uint32_t>(line, "lines: a list of numbers from 0"));
  }
  return numbers;
}

std::size_t cloud_in(const Json& json) {
  const auto found = json.find("cloud");
  if (found == json.end()) return 0;
  if (!found->is_number_unsigned()) throw Error(ErrorKind::kUsage, "cloud: a number from 0");
  return found->get<std::size_t>();
}

bool flag(const Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end() || found->is_null()) return false;
  need(found->is_boolean(), "protect and front_only are true or false");
  return found->get<bool>();
}

void read_brush(const Json& json, Stroke& stroke) {
  const Json& centres = json.at("centres");
  need(centres.is_array() && !centres.empty() && centres.size() <= kMostCentres,
       "centres: 1 to 20000 points");
  for (const Json& centre : centres) {
    stroke.centres.push_back(vector(centre, "a centre is [x, y, z]"));
  }
  stroke.radius = number(json.at("radius"));
  need(stroke.radius > 0, "the radius is above 0");
}

void read_polygon(const Json& json, Stroke& stroke) {
  const Json& corners = json.at("polygon");
  need(corners.is_array() && corners.size() >= 3 && corners.size() <= kMostCorners,
       "polygon: 3 to 20000 corners");
  for (const Json& corner : corners) {
    stroke.polygon.push_back(numbers<2>(corner, "a corner is [x, y]"));
  }
  stroke.matrix = numbers<16>(json.at("matrix"), "matrix: 16 numbers");
  stroke.front_only = flag(json, "front_only");
  if (!stroke.front_only) return;
  stroke.point_size = number(json.at("point_size"));
  stroke.viewport = numbers<2>(json.at("viewport"), "viewport: [width, height]");
  need(stroke.point_size > 0 && stroke.point_size <= 1000, "point_size: above 0, at most 1000");
  for (const double side : stroke.viewport) {
    need(side >= 1 && side <= 16384, "viewport: 1 to 16384 pixels a side");
  }
}

Stroke read_stroke(const Json& json) {
  need(json.is_object(), "an object is wanted");
  Stroke stroke;
  stroke.id = json.at("id").get<std::string>();
  need(!stroke.id.empty() && stroke.id.size() <= kLongestId, "id: 1 to 128 characters");
  stroke.edge_class = edge_class(json.at("class"));
  stroke.protect = flag(json, "protect");
  stroke.cloud = cloud_in(json);
  if (const auto hidden = json.find("hidden"); hidden != json.end() && !hidden->is_null()) {
    need(hidden->is_array() && hidden->size() <= kMostClasses + 1, "hidden: a list of classes");
    for (const Json& c : *hidden) stroke.hidden.push_back(edge_class(c));
  }
  if (const auto clip = json.find("clip"); clip != json.end() && !clip->is_null()) {
    stroke.clip = BoundingBox{.min = vector(clip->at("min"), "clip.min is [x, y, z]"),
                              .max = vector(clip->at("max"), "clip.max is [x, y, z]")};
  }
  const auto tool = json.at("tool").get<std::string>();
  need(tool == "brush" || tool == "polygon" || tool == "file", "tool: brush, polygon or file");
  if (tool == "brush") {
    read_brush(json, stroke);
  } else if (tool == "polygon") {
    stroke.tool = Tool::kPolygon;
    read_polygon(json, stroke);
  } else {
    stroke.tool = Tool::kFile;
  }
  return stroke;
}

Decision decision_of(const std::string& name) {
  for (const Decision decision : {Decision::kOpen, Decision::kAccepted, Decision::kRejected}) {
    if (name == decision_name(decision)) return decision;
  }
  throw Error(ErrorKind::kUsage, "decision: open, accepted or rejected");
}

/// What `read` makes of the request; its errors begin with `what`.
template <typename Read>
auto parsed(std::string_view text, const char* what, const Read& read) {
  try {
    return read(parse_json(text));
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::kUsage, fmt::format("{}: {}", what, words_of(error)));
  }
}

}  // namespace

Stroke parse_stroke(std::string_view text) {
  return parsed(text, "stroke", read_stroke);
}

LinesSearch parse_lines_search(std::string_view text) {
  return parsed(text, "lines", [](const Json& json) -> LinesSearch {
    return {.cloud = cloud_in(json), .boundaries = json.value("boundaries", false)};
  });
}

LinesDecided parse_decision(std::string_view text) {
  return parsed(text, "decide", [](const Json& json) -> LinesDecided {
    return {.version = whole<int>(json.at("version"), "version: a number from 0"),
            .decision = decision_of(json.at("decision").get<std::string>()),
            .lines = line_numbers(json.at("lines")),
            .cloud = cloud_in(json)};
  });
}

SaveRequest parse_save(std::string_view text) {
  return parsed(text, "save", [](const Json& json) -> SaveRequest {
    return {.what = json.at("what").get<std::string>(),
            .name = json.value("name", std::string()),
            .cloud = cloud_in(json),
            .overwrite = json.value("overwrite", false)};
  });
}

}  // namespace pcednet::annotate
