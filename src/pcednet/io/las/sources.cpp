#include "pcednet/io/las/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// Whole numbers up to here are doubles.
constexpr double kLargestWhole = 9007199254740992.0;

/// The whole numbers that a field holds.
struct WholeRange {
  double least = 0.0, largest = 0.0;
};

struct Candidate {
  LasField field;
  std::string attribute = {};
  std::optional<WholeRange> range = {};  ///< absent: any number
  std::optional<double> misfit = {};     ///< the first value that does not fit
  bool has_own_type = false;

  bool holds(double value) const {
    if (!range) return std::abs(value) <= kLargestWhole || !std::isfinite(value);
    return value >= range->least && value <= range->largest && value == std::floor(value);
  }
};

template <typename T>
WholeRange range_of_type() {
  return {std::max(static_cast<double>(std::numeric_limits<T>::min()), -kLargestWhole),
          std::min(static_cast<double>(std::numeric_limits<T>::max()), kLargestWhole)};
}

std::optional<WholeRange> range_of(const LasField& field) {
  if (field.bits > 0) return WholeRange{0.0, std::exp2(field.bits) - 1.0};
  if (is_floating(field.type)) return std::nullopt;
  return visit_scalar(field.type, [](auto zero) { return range_of_type<decltype(zero)>(); });
}

/// A name without the differences between programs: CloudCompare calls GpsTime `scalar_Gps_Time`.
std::string plain_name(std::string_view name) {
  constexpr std::string_view kScalar = "scalar_";
  if (name.starts_with(kScalar)) name.remove_prefix(kScalar.size());
  std::string plain = lower_case(name);
  std::erase_if(plain, [](char c) { return c == '_' || c == ' '; });
  return plain;
}

/// The attribute of one number a point with that name; where names repeat, of that type if one is.
const Attribute* find_single(const PointCloud& cloud, const std::string& name, ScalarType type) {
  const Attribute* found = nullptr;
  for (const Attribute& attribute : cloud.attributes) {
    if (attribute.components != 1 || attribute.name != name) continue;
    if (!found || (found->type != type && attribute.type == type)) found = &attribute;
  }
  return found;
}

/// The same for a field, otherwise with its name as other programs write it; `own`: names that are
/// none.
const Attribute* find_named(const PointCloud& cloud, const std::string& name, ScalarType type,
                            const std::set<std::string>& own) {
  const Attribute* found = own.count(name) == 0 ? find_single(cloud, name, type) : nullptr;
  for (std::size_t a = 0; !found && a < cloud.attributes.size(); ++a) {
    const Attribute& attribute = cloud.attributes[a];
    const bool is_similar = attribute.components == 1 && own.count(attribute.name) == 0 &&
                            plain_name(attribute.name) == plain_name(name);
    if (is_similar) found = find_single(cloud, attribute.name, type);
  }
  return found;
}

std::vector<Candidate> candidates_of(const LasFile& file, bool is_new, const PointCloud& first) {
  std::vector<std::string> ignored;
  std::set<std::string> own;  // extra bytes of the file remain such
  for (const LasField& field : las_extra_fields(file, ignored)) own.insert(field.name);
  std::vector<LasField> fields = las_standard_fields(file.point_format());
  fields.erase(fields.begin(), fields.begin() + 3);
  std::vector<Candidate> candidates;
  for (const LasField& field : fields) {
    Candidate candidate{.field = field, .range = range_of(field)};
    const Attribute* found = find_named(first, field.name, field.type, own);
    if (!found && field.name == "ScanAngle") {  // in whole degrees
      found = find_named(first, "ScanAngleRank", field.type, own);
      candidate.range = range_of_type<std::int8_t>();
    }
    if (!found || (field.type == ScalarType::kFloat32 && found->type != field.type)) continue;
    candidate.attribute = found->name;
    candidate.has_own_type = found->name == field.name && found->type == field.type;
    if (candidate.has_own_type && (!is_new || field.bits == 0)) continue;
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

void look_for_misfits(const PointCloud& part, Candidate& candidate) {
  const Attribute* attribute = find_single(part, candidate.attribute, candidate.field.type);
  if (!attribute) return;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const double value = attribute->value(i);
    if (candidate.holds(value)) continue;
    candidate.misfit = value;
    return;
  }
}

std::string misfit_text(const Candidate& candidate) {
  const std::string what = candidate.range
                               ? fmt::format("is not a whole number in {} ... {}",
                                             candidate.range->least, candidate.range->largest)
                               : "has more digits than it";
  return fmt::format("{} in the field {} of LAS, since {} {}: extra bytes keep all values",
                     candidate.attribute, candidate.field.name, *candidate.misfit, what);
}

}  // namespace

LasSources find_las_sources(const LasFile& file, bool is_new, const PartOutline& outline) {
  std::vector<Candidate> candidates = candidates_of(file, is_new, *outline.first);
  const auto fits = [](const Candidate& candidate) { return !candidate.misfit; };
  if (!candidates.empty()) {
    outline.each_part([&](const PointCloud& part) {
      for (Candidate& candidate : candidates) {
        if (fits(candidate)) look_for_misfits(part, candidate);
      }
      return std::any_of(candidates.begin(), candidates.end(), fits);
    });
  }
  LasSources sources;
  for (const Candidate& candidate : candidates) {
    if (!fits(candidate)) {
      sources.losses.push_back(misfit_text(candidate));
      sources.unfit.insert(candidate.field.name);
    } else if (!candidate.has_own_type) {
      sources.attributes.emplace(candidate.field.name, candidate.attribute);
    }
  }
  return sources;
}

const Attribute* las_source(const PointCloud& cloud, const LasSources& sources,
                            const std::string& field, ScalarType type) {
  if (sources.unfit.count(field) != 0) return nullptr;
  if (const auto source = sources.attributes.find(field); source != sources.attributes.end()) {
    return find_single(cloud, source->second, type);
  }
  const Attribute* attribute = find_single(cloud, field, type);
  return attribute && attribute->type == type ? attribute : nullptr;
}

std::array<const Attribute*, 3> las_channels(const PointCloud& cloud, const LasSources& sources) {
  std::array<const Attribute*, 3> channels = {};
  for (std::size_t c = 0; c < 3; ++c) {
    channels[c] = las_source(cloud, sources, kLasChannels[c], ScalarType::kUint16);
    if (!channels[c]) return {};
  }
  return channels;
}

bool may_have_channels(const PointCloud& first) {
  return std::all_of(std::begin(kLasChannels), std::end(kLasChannels), [&](const char* name) {
    return find_named(first, name, ScalarType::kUint16, {}) != nullptr;
  });
}

bool colours_are_new(const PartOutline& outline, const LasSources& sources) {
  if (outline.first->colours.empty()) return false;
  if (!las_channels(*outline.first, sources)[0]) return true;
  /// Whether `holds(number, colour)` is true for all channels of the part.
  const auto in_all = [&](const PointCloud& part, const auto& holds) {
    const auto channels = las_channels(part, sources);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < part.size(); ++i) {
        const auto number = static_cast<unsigned>(channels[c]->value(i));
        if (!holds(number, part.colours[i][c])) return false;
      }
    }
    return true;
  };
  const bool narrow = all_parts(outline.each_part, [&](const PointCloud& part) {
    return in_all(part, [](unsigned number, unsigned) { return number <= 255; });
  });
  return !all_parts(outline.each_part, [&](const PointCloud& part) {
    return in_all(part, [&](unsigned number, unsigned colour) {
      if (narrow) return number == colour;
      return (number + 128) / 257 == colour || number >> 8 == colour;
    });
  });
}

}  // namespace pcednet::io
