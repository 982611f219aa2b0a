#include "pcednet/io/promote.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pcednet/core/bytes.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

std::optional<std::size_t> find_plain(const PointCloud& cloud, const std::string& name) {
  for (std::size_t a = 0; a < cloud.attributes.size(); ++a) {
    const Attribute& attribute = cloud.attributes[a];
    if (attribute.components == 1 && lower_case(attribute.name) == name) return a;
  }
  return std::nullopt;
}

void remove_attributes(PointCloud& cloud, std::vector<std::size_t> indices) {
  std::sort(indices.rbegin(), indices.rend());
  for (const std::size_t a : indices) {
    cloud.attributes.erase(cloud.attributes.begin() + static_cast<std::ptrdiff_t>(a));
  }
}

/// The meaning of the numbers in colour columns.
enum class ColourScale { kNone, kBytes, kUnit, kWords };

ColourScale find_scale(const std::array<const Attribute*, 3>& channels, std::size_t points) {
  bool whole = true, all_word = true;
  double largest = 0.0;
  for (const Attribute* channel : channels) {
    all_word = all_word && channel->type == ScalarType::kUint16;
    for (std::size_t i = 0; i < points; ++i) {
      const double value = channel->value(i);
      if (!(value >= 0.0 && value <= 65535.0)) return ColourScale::kNone;
      whole = whole && value == std::floor(value);
      largest = std::max(largest, value);
    }
  }
  if (is_floating(channels[0]->type) && largest <= 1.0) return ColourScale::kUnit;
  if (whole && largest <= 255.0) return ColourScale::kBytes;
  return all_word ? ColourScale::kWords : ColourScale::kNone;
}

/// The factor that scales a number to 0 ... 255.
double factor_of(ColourScale scale) {
  if (scale == ColourScale::kUnit) return 255.0;
  return scale == ColourScale::kWords ? 1.0 / 257.0 : 1.0;
}

/// Unpacks 0xAARRGGBB.
void unpack_colours(PointCloud& cloud, std::size_t packed_index, bool with_alpha) {
  const Attribute packed = cloud.attributes[packed_index];
  std::vector<std::uint8_t> alphas(cloud.size());
  cloud.colours.resize(cloud.size());
  bool alpha_matters = false;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto argb = load<std::uint32_t>(&packed.bytes[i * sizeof(std::uint32_t)]);
    const auto byte = [argb](int place) { return static_cast<std::uint8_t>(argb >> (8 * place)); };
    cloud.colours[i] = {byte(2), byte(1), byte(0)};
    alphas[i] = byte(3);
    alpha_matters = alpha_matters || alphas[i] != 255;
  }
  remove_attributes(cloud, {packed_index});
  if (with_alpha && alpha_matters) cloud.attributes.push_back(make_attribute("alpha", alphas));
}

bool promote_channels(PointCloud& cloud, const std::vector<std::string>& names,
                      std::vector<std::string>& warnings) {
  std::array<const Attribute*, 3> channels = {};
  std::vector<std::size_t> indices;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto found = find_plain(cloud, names[c]);
    if (!found) return false;
    indices.push_back(*found);
    channels[c] = &cloud.attributes[*found];
  }
  const ColourScale scale = find_scale(channels, cloud.size());
  if (scale == ColourScale::kNone) {
    warnings.push_back(names[0] + ", " + names[1] + " and " + names[2] +
                       " are not colours in 0 ... 255 or 0 ... 1: kept as attributes");
    return false;
  }
  const double factor = factor_of(scale);
  bool rounded = false;
  cloud.colours.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double exact = channels[c]->value(i) * factor;
      cloud.colours[i][c] = static_cast<std::uint8_t>(std::lround(exact));
      rounded = rounded || std::abs(exact - cloud.colours[i][c]) > 1e-3;
    }
  }
  if (rounded) warnings.emplace_back("colours were rounded to 8 bits");
  remove_attributes(cloud, indices);
  return true;
}

bool promote_packed(PointCloud& cloud) {
  for (const char* name : {"rgb", "rgba"}) {
    const auto found = find_plain(cloud, name);
    if (!found || size_of(cloud.attributes[*found].type) != 4) continue;
    unpack_colours(cloud, *found, std::string(name) == "rgba");
    return true;
  }
  return false;
}

/// Whether there are colours of 16 bits, which those of 8 bits beside them do not replace.
bool has_wide_channels(const PointCloud& cloud) {
  const auto& names = colour_names().front();
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    const auto found = find_plain(cloud, name);
    return found && cloud.attributes[*found].type == ScalarType::kUint16;
  });
}

}  // namespace

const std::vector<std::string>& label_names() {
  static const std::vector<std::string> names = {"label", "scalar_label"};
  return names;
}

const std::vector<std::vector<std::string>>& colour_names() {
  static const std::vector<std::vector<std::string>> names = {
      {"red", "green", "blue"},
      {"diffuse_red", "diffuse_green", "diffuse_blue"},
      {"r", "g", "b"},
      {"rf", "gf", "bf"}};  // CloudCompare: from 0 to 1
  return names;
}

bool is_called(const Attribute& attribute, const std::string& name) {
  const std::string its = lower_case(attribute.name);
  return attribute.components == 1 && (its == name || its == "scalar_" + name);
}

const Attribute* find_called(const PointCloud& cloud, const std::string& name) {
  const auto found = std::ranges::find_if(
      cloud.attributes, [&](const Attribute& attribute) { return is_called(attribute, name); });
  return found == cloud.attributes.end() ? nullptr : &*found;
}

std::optional<std::uint8_t> to_label(double value) {
  if (std::isnan(value) || value == -1.0) return kUnlabelled;
  if (!(value >= 0.0 && value <= 255.0 && value == std::floor(value))) return std::nullopt;
  return static_cast<std::uint8_t>(value);
}

std::optional<std::vector<std::uint8_t>> to_labels(const Attribute& attribute, std::size_t points) {
  std::vector<std::uint8_t> labels(points);
  for (std::size_t i = 0; i < points; ++i) {
    const auto label = to_label(attribute.value(i));
    if (!label) return std::nullopt;
    labels[i] = *label;
  }
  return labels;
}

void promote_labels(PointCloud& cloud) {
  for (const std::string& name : label_names()) {
    const auto found = find_plain(cloud, name);
    if (!found) continue;
    auto labels = to_labels(cloud.attributes[*found], cloud.size());
    if (!labels) continue;
    cloud.labels = std::move(*labels);
    remove_attributes(cloud, {*found});
    return;
  }
}

void promote_colours(PointCloud& cloud, std::vector<std::string>& warnings) {
  if (has_wide_channels(cloud) && promote_packed(cloud)) return;
  for (const auto& names : colour_names()) {
    if (promote_channels(cloud, names, warnings)) return;
  }
  promote_packed(cloud);
}

void add_colours(const std::array<std::vector<double>, 3>& columns, PointCloud& cloud,
                 std::vector<std::string>& warnings) {
  constexpr const char* kNames[] = {"red", "green", "blue"};
  for (std::size_t c = 0; c < columns.size(); ++c) {
    cloud.attributes.push_back(make_attribute(kNames[c], columns[c]));
  }
  promote_colours(cloud, warnings);
}

LoadedCloud keep_spelled_digits(LoadedCloud declared,
                                const std::function<LoadedCloud()>& read_wide) {
  const auto is_far = [](double v) { return std::isfinite(v) && std::abs(v) >= 1e4; };
  const std::vector<Vec3>& floats = declared.cloud.positions;
  const auto has_far = [&](const Vec3& p) {
    return is_far(p.x()) || is_far(p.y()) || is_far(p.z());
  };
  if (declared.cloud.position_type != ScalarType::kFloat32 ||
      std::none_of(floats.begin(), floats.end(), has_far)) {
    return declared;
  }
  LoadedCloud wide = read_wide();
  for (std::size_t i = 0; i < floats.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double spelled = wide.cloud.positions[i][axis];
      if (!is_far(spelled) || floats[i][axis] == spelled) continue;
      wide.warnings.emplace_back(
          "positions are declared as float but have more digits: kept as double");
      return wide;
    }
  }
  return declared;
}

}  // namespace pcednet::io
