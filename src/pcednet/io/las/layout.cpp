#include "pcednet/io/las/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/io/las/copc.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

constexpr int kLeastDigits = 4, kMostDigits = 9;

/// Whether each coordinate is that of its step but for the rounding of doubles: of the coordinate
/// itself, of the step's product and of the sum. Decimals such as 512345.67 are.
bool is_exact(const PointCloud& cloud, const LasFile& file) {
  constexpr double kRounding = 2.0 * std::numeric_limits<double>::epsilon();
  for (const Vec3& p : cloud.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = p[static_cast<int>(axis)];
      const double distance = las_step(file, axis, value) * file.scale(axis);
      const double error = std::abs(distance + file.offset(axis) - value);
      const double allowed = kRounding * std::max(std::abs(value), std::abs(distance));
      if (std::isfinite(value) && !(error <= allowed)) return false;
    }
  }
  return true;
}

bool all_exact(const PartOutline& outline, const LasFile& file) {
  return all_parts(outline.each_part, [&](const PointCloud& part) { return is_exact(part, file); });
}

bool fits(const BoundingBox& box, const LasFile& file) {
  if (box.empty()) return true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double end : {box.min[static_cast<int>(axis)], box.max[static_cast<int>(axis)]}) {
      if (!std::isfinite(las_step(file, axis, end))) return false;
    }
  }
  return true;
}

BoundingBox box_of(const PartOutline& outline) {
  BoundingBox box;
  outline.each_part([&](const PointCloud& part) {
    box.add(bounding_box(part.positions));
    return true;
  });
  return box;
}

LasFile with_digits(LasFile file, int digits) {
  const double scale = 1.0 / std::pow(10.0, digits);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put_number(file.header, las_header::kScales + 8 * axis, scale);
  }
  return file;
}

/// Without this, one point far away, such as (1e30, 0, 0) for no data, takes all others the digits.
[[noreturn]] void refuse_extent(const std::filesystem::path& path, const BoundingBox& box) {
  int axis = 0;
  (box.max - box.min).maxCoeff(&axis);
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: LAS cannot hold coordinates from {} to {}, not even in steps of 1; "
                          "does one of them stand for no data?",
                          path.string(), box.min[axis], box.max[axis]));
}

/// Offsets at whole numbers, and the coarsest step of at most 0.1 mm that keeps every coordinate
/// exactly; if none does, the finest whose range 32 bits can hold. Coarser only if necessary for
/// the range, and never above 1.
bool choose_scale(const std::filesystem::path& path, const PartOutline& outline,
                  const BoundingBox& box, LasFile& file) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    const double middle = box.empty() ? 0.0 : std::round(box.min[a] / 2 + box.max[a] / 2);
    put_number(file.header, las_header::kOffsets + 8 * axis, middle);
  }
  std::vector<LasFile> candidates;
  for (int digits = kLeastDigits; digits <= kMostDigits; ++digits) {
    LasFile candidate = with_digits({.header = file.header}, digits);
    if (!fits(box, candidate)) break;
    candidates.push_back(std::move(candidate));
  }
  if (candidates.empty()) {
    int digits = kLeastDigits - 1;
    while (digits >= 0 && !fits(box, with_digits({.header = file.header}, digits))) --digits;
    if (digits < 0) refuse_extent(path, box);
    file = with_digits(std::move(file), digits);
    return all_exact(outline, file);
  }
  const std::string finest = candidates.back().header;
  outline.each_part([&](const PointCloud& part) {
    std::erase_if(candidates, [&](const LasFile& c) { return !is_exact(part, c); });
    return !candidates.empty();
  });
  file.header = candidates.empty() ? finest : candidates.front().header;
  return !candidates.empty();
}

/// For the clouds that name their coordinate system in a comment.
void add_system(const std::vector<std::string>& comments, LasFile& file) {
  const std::string wkt = wkt_of_comments(comments);
  if (wkt.empty() || wkt.size() >= UINT16_MAX) return;
  file.records.push_back(new_record(kWktRecord, "OGC WKT", wkt + '\0'));
}

LasFile new_file(bool with_colours) {
  LasFile file;
  file.header.assign(las_header::kBytes14, '\0');
  file.header.replace(las_header::kSignature, 4, "LASF");
  put_number<std::uint16_t>(file.header, las_header::kGlobalEncoding, las_header::kWktBit);
  put_number<std::uint8_t>(file.header, las_header::kMajorVersion, 1);
  put_number<std::uint8_t>(file.header, las_header::kMinorVersion, 4);
  file.header.replace(las_header::kSystem, 7, "pcednet");
  file.header.replace(las_header::kSoftware, 7, "pcednet");
  put_number<std::uint8_t>(file.header, las_header::kPointFormat, with_colours ? 7 : 6);
  return file;
}

/// A file for a cloud of another format: with colours if it has any, 8 or 16 bits a channel.
LasFile new_file_for(const PartOutline& outline) {
  LasFile file = new_file(true);
  const PointCloud& first = *outline.first;
  const bool with_colours =
      !first.colours.empty() ||
      (may_have_channels(first) &&
       las_channels(first, find_las_sources(file, true, outline))[0] != nullptr);
  if (!with_colours) file = new_file(false);
  add_system(first.comments, file);
  return file;
}

/// Whether the points of each class have one colour, so that the classes say as much as the
/// colours, as those that classify gives a cloud without colours.
bool colours_follow_classes(const PointCloud& cloud) {
  const Attribute* classes = find_attribute(cloud, "scalar_edge_class");
  if (!classes) classes = find_attribute(cloud, "scalar_class");
  if (!classes || classes->type != ScalarType::kUint8 || classes->components != 1) return false;
  std::array<std::optional<Rgb>, 256> colours = {};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::optional<Rgb>& colour = colours[std::to_integer<std::size_t>(classes->bytes[i])];
    if (!colour) colour = cloud.colours[i];
    if (*colour != cloud.colours[i]) return false;
  }
  return true;
}

bool labels_are_classes(const PartOutline& outline) {
  const auto is_class = [](const PointCloud& part) {
    const Attribute* edge_class = find_attribute(part, "scalar_edge_class");
    return edge_class && edge_class->type == ScalarType::kUint8 &&
           edge_class->bytes.size() == part.labels.size() &&
           std::memcmp(edge_class->bytes.data(), part.labels.data(), part.labels.size()) == 0;
  };
  if (!outline.first->has_labels() || !is_class(*outline.first)) return false;
  return all_parts(outline.each_part, is_class);
}

LasChoices choices_of(const std::filesystem::path& path, const PartOutline& outline) {
  LasChoices choices{.file = attached_las_file(*outline.first),
                     .label_is_class = labels_are_classes(outline)};
  const bool is_new = choices.is_new = choices.file.header.empty();
  if (!is_new && outline.is_las) return choices;
  if (is_new) choices.file = new_file_for(outline);
  const BoundingBox box = box_of(outline);
  if (is_new || !fits(box, choices.file)) {
    choices.exact = choose_scale(path, outline, box, choices.file);
  } else {
    choices.exact = all_exact(outline, choices.file);
  }
  return choices;
}

}  // namespace

double las_step(const LasFile& file, std::size_t axis, double coordinate) {
  const double step = std::round((coordinate - file.offset(axis)) / file.scale(axis));
  return step >= INT32_MIN && step <= INT32_MAX ? step : NAN;
}

LasChoices las_choices(const std::filesystem::path& path, const PartOutline& outline) {
  LasChoices choices = choices_of(path, outline);
  if (is_copc_name(path)) choose_copc(choices, *outline.first);
  if (outline.is_las) return choices;
  choices.sources = find_las_sources(choices.file, choices.is_new, outline);
  choices.new_colours = colours_are_new(outline, choices.sources);
  return choices;
}

std::vector<std::string> las_losses(const std::filesystem::path& path, const PointCloud& cloud) {
  const LasChoices choices = las_choices(path, outline_of(cloud));
  std::vector<std::string> losses = las_losses(cloud, choices);
  const LasLayout layout = las_layout(cloud, {.new_normals = false}, choices);
  losses.insert(losses.end(), layout.losses.begin(), layout.losses.end());
  return losses;
}

std::vector<std::string> las_losses(const PointCloud& first, const LasChoices& choices) {
  const LasFile& file = choices.file;
  std::vector<std::string> losses = choices.losses;
  losses.insert(losses.end(), choices.sources.losses.begin(), choices.sources.losses.end());
  if (!first.comments.empty() && !las_comment_record(first.comments)) {
    losses.emplace_back("comments of more than 64 KiB");
  }
  if (!choices.exact) {
    losses.push_back(fmt::format("digits of positions beyond steps of {}", file.scale(0)));
  }
  const bool has_colours = las_format_has(file.point_format(), "Red");
  if (!first.colours.empty() && !has_colours && !colours_follow_classes(first)) {
    losses.push_back(fmt::format("colours: {}point format {} has none",
                                 choices.promoted ? "" : "the input's ", file.point_format()));
  }
  return losses;
}

std::optional<LasRecord> las_comment_record(const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) text += comment + "\n";
  if (text.empty() || text.size() > UINT16_MAX) return std::nullopt;
  return new_record(kCommentsRecord, "comments", std::move(text));
}

std::vector<std::string> take_las_comments(LasFile& file) {
  std::vector<std::string> comments;
  for (LasRecord& record : file.records) {
    if (!record.is(kCommentsRecord)) continue;
    std::string text = std::move(record.data);
    std::replace_if(
        text.begin(), text.end(),
        [](unsigned char c) { return c != '\n' && (c < ' ' || c == 127); }, ' ');
    Lines lines(text);
    std::string_view line;
    while (lines.next(line)) comments.emplace_back(line);
  }
  std::erase_if(file.records, [](const LasRecord& r) { return r.is(kCommentsRecord); });
  return comments;
}

}  // namespace pcednet::io
