#include "pcednet/tiles/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/detect/prepare.h"
#include "pcednet/io/las/file.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/scanners.h"

namespace pcednet::tiles {
namespace {

[[noreturn]] void refuse_pair(const IndexedInput& a, const IndexedInput& b,
                              const std::string& difference) {
  throw Error(ErrorKind::kUsage,
              fmt::format("{} and {} {}. Convert them to one form first, or plan them one by one",
                          a.input.path.string(), b.input.path.string(), difference));
}

/// The columns of `a` that `b` does not have.
std::string only_in(const IndexedInput& a, const IndexedInput& b) {
  constexpr std::size_t kMost = 5;
  std::vector<std::string> only;
  for (const std::string& column : a.columns) {
    const bool is_there = std::find(b.columns.begin(), b.columns.end(), column) != b.columns.end();
    if (!is_there) only.push_back(column);
  }
  if (only.empty()) return {};
  const std::size_t more = only.size() - std::min(only.size(), kMost);
  only.resize(only.size() - more);
  return fmt::format("; only {} has {}{}", a.input.path.string(), fmt::join(only, ", "),
                     more == 0 ? "" : fmt::format(" and {} more", more));
}

void check_columns(const IndexedInput& a, const IndexedInput& b) {
  if (a.columns == b.columns) return;
  const std::string difference = only_in(a, b) + only_in(b, a);
  refuse_pair(a, b,
              difference.empty() ? "have their columns in different orders"
                                 : "have different columns" + difference);
}

/// What decides the values that the numbers of an extra field stand for (LASF_Spec 4).
struct ExtraMeaning {
  std::uint8_t type = 0;
  std::string no_data = {};                     ///< bytes; empty: every number is data
  std::vector<double> scale = {}, offset = {};  ///< of each number

  bool operator==(const ExtraMeaning&) const = default;
};

ExtraMeaning meaning_of(const io::LasField& field, std::string_view descriptor) {
  using namespace io::las_descriptor;
  constexpr std::size_t kNumber = 8;
  ExtraMeaning meaning{.type = io::number_at<std::uint8_t>(descriptor, kType)};
  if (meaning.type == 0) return meaning;  // bytes, and the options are how many
  const auto options = io::number_at<std::uint8_t>(descriptor, kOptions);
  if (options & kNoDataBit)
    meaning.no_data = descriptor.substr(kNoData, kNumber * field.components);
  for (std::size_t at = 0; at < kNumber * field.components; at += kNumber) {
    meaning.scale.push_back(options & kScaleBit ? io::number_at<double>(descriptor, kScale + at)
                                                : 1.0);
    meaning.offset.push_back(options & kOffsetBit ? io::number_at<double>(descriptor, kOffset + at)
                                                  : 0.0);
  }
  return meaning;
}

/// The meaning of each extra field that is described.
std::map<std::string, ExtraMeaning> extra_meanings(const io::LasFile& file) {
  std::vector<std::string> known;
  std::map<std::string, ExtraMeaning> meanings;
  const auto record =
      std::find_if(file.records.begin(), file.records.end(),
                   [](const io::LasRecord& r) { return r.is(io::kExtraBytesRecord); });
  for (const io::LasField& field : io::las_extra_fields(file, known)) {
    if (!field.descriptor) continue;
    const std::string_view data = record->data;
    meanings[field.name] =
        meaning_of(field, data.substr(*field.descriptor, io::las_descriptor::kBytes));
  }
  return meanings;
}

/// What the records say on the coordinate system, verbatim.
std::map<std::uint16_t, std::string> system_records(const io::LasFile& file) {
  std::map<std::uint16_t, std::string> found;
  for (const auto* records : {&file.records, &file.extended_records}) {
    for (const io::LasRecord& record : *records) {
      if (record.user_id == io::kWktRecord.user_id) found[record.record_id] = record.data;
    }
  }
  return found;
}

/// The part of a WKT on heights, without blanks and in capitals; empty if there is none.
std::string heights_in(const std::string& wkt) {
  std::string text;
  for (const char c : wkt) {
    const auto byte = static_cast<unsigned char>(c);
    if (!std::isspace(byte)) text += static_cast<char>(std::toupper(byte));
  }
  std::size_t begin = std::string::npos;
  for (const char* keyword : {"VERT_CS[", "VERTCS[", "VERTCRS[", "VERTICALCRS["}) {
    begin = std::min(begin, text.find(keyword));
  }
  return begin == std::string::npos ? "" : text.substr(begin);
}

/// Whether two systems are the same by their codes, written as they may be.
bool are_same(const io::CoordinateSystem& a, const io::CoordinateSystem& b) {
  if (a.epsg == 0 || a.epsg != b.epsg || a.vertical_epsg != b.vertical_epsg) return false;
  return a.vertical_epsg > 0 || heights_in(a.wkt) == heights_in(b.wkt);
}

std::string name_of(const io::CoordinateSystem& system) {
  if (system.epsg == 0) return system.wkt.empty() ? "none that is known" : "one without a code";
  if (system.vertical_epsg > 0) return fmt::format("{}+{}", system.epsg, system.vertical_epsg);
  return fmt::format("{}{}", system.epsg,
                     heights_in(system.wkt).empty() ? "" : " and heights without a code");
}

void check_systems(const IndexedInput& a, const IndexedInput& b, const io::LasFile& first,
                   const io::LasFile& other) {
  if (system_records(first) == system_records(other)) return;
  const auto its = io::las_coordinate_system(a.outline);
  const auto others = io::las_coordinate_system(b.outline);
  if (are_same(its, others)) return;
  refuse_pair(a, b,
              fmt::format("have different coordinate systems: EPSG {}, and {}", name_of(its),
                          name_of(others)));
}

/// How GPS times count: from the week or adjusted, and by which offset (LAS 1.5).
auto time_of(const io::LasFile& file) {
  using namespace io::las_header;
  const auto encoding = io::number_at<std::uint16_t>(file.header, kGlobalEncoding);
  const bool has_offset = file.has_time_range() && (encoding & kTimeOffsetBit) != 0;
  return std::tuple((encoding & kStandardTimeBit) != 0, has_offset,
                    has_offset ? io::number_at<std::uint16_t>(file.header, kTimeOffset) : 0);
}

bool has_waveforms(const io::LasFile& file) {
  // The records 100 to 354 describe them, the last holds them.
  const auto is_of_waveforms = [](const io::LasRecord& record) {
    return record.user_id == io::kWaveformsRecord.user_id &&
           (record.record_id == io::kWaveformsRecord.record_id ||
            (record.record_id >= 100 && record.record_id <= 354));
  };
  return std::any_of(file.records.begin(), file.records.end(), is_of_waveforms) ||
         std::any_of(file.extended_records.begin(), file.extended_records.end(), is_of_waveforms);
}

void check_las(const IndexedInput& a, const IndexedInput& b, const io::LasFile& first,
               const io::LasFile& other) {
  const auto meanings = extra_meanings(first), others = extra_meanings(other);
  for (const auto& [name, meaning] : meanings) {
    const auto found = others.find(name);
    if (found == others.end() || found->second == meaning) continue;
    refuse_pair(a, b, fmt::format("give {} different scales, offsets or no-data values", name));
  }
  check_systems(a, b, first, other);
  const auto is_timed = [](const Attribute& column) { return column.name == "GpsTime"; };
  const bool timed =
      std::any_of(a.outline.attributes.begin(), a.outline.attributes.end(), is_timed);
  if (timed && time_of(first) != time_of(other)) {
    refuse_pair(a, b, "use different GPS time bases (global encoding)");
  }
  if (has_waveforms(first) || has_waveforms(other)) {
    refuse_pair(a, b, "have waveforms, and the tiles could keep those of one file only");
  }
}

/// The records beside points that `file` has and the first input has not, or otherwise.
void add_lost(const io::LasFile& first, const io::LasFile& file, std::vector<std::string>& lost) {
  const auto all_of = [](const io::LasFile& las) {
    std::vector<io::LasRecord> all = las.records;
    all.insert(all.end(), las.extended_records.begin(), las.extended_records.end());
    // These were compared, or are written anew, or are comments.
    std::erase_if(all, [](const io::LasRecord& r) {
      return r.user_id == io::kWktRecord.user_id || r.is(io::kExtraBytesRecord) ||
             r.is(io::kLaszipRecord) || r.is(io::kCommentsRecord);
    });
    return all;
  };
  const std::vector<io::LasRecord> kept = all_of(first);
  for (const io::LasRecord& record : all_of(file)) {
    const bool is_kept = std::any_of(kept.begin(), kept.end(), [&](const io::LasRecord& other) {
      return other.user_id == record.user_id && other.record_id == record.record_id &&
             other.data == record.data;
    });
    std::string name = fmt::format("{} {}", record.user_id, record.record_id);
    if (!is_kept && std::find(lost.begin(), lost.end(), name) == lost.end()) {
      lost.push_back(std::move(name));
    }
  }
}

void note_lost_records(const IndexedInput& first, std::vector<std::string> lost, Plan& plan) {
  constexpr std::size_t kMost = 5;
  if (lost.empty()) return;
  const bool more = lost.size() > kMost;
  lost.resize(std::min(lost.size(), kMost));
  plan.notes.push_back(
      fmt::format("the tiles have the records of {}; those of other inputs are "
                  "left out: {}{}",
                  first.input.path.string(), fmt::join(lost, ", "), more ? ", ..." : ""));
}

/// Puts the scanners of input after input in the plan's list, an unknown one for inputs without.
void join_scanners(std::vector<IndexedInput>& inputs, Plan& plan) {
  for (IndexedInput& input : inputs) {
    std::vector<Vec3>& its = input.outline.scanners;
    if (its.empty()) its.push_back(Vec3::Constant(NAN));
    input.input.first_scan = static_cast<std::int32_t>(plan.scanners.size());
    input.input.scans = static_cast<std::int32_t>(its.size());
    plan.scanners.insert(plan.scanners.end(), its.begin(), its.end());
    std::erase_if(input.columns, [](const auto& column) { return column.starts_with("scan ("); });
  }
  plan.notes.push_back(fmt::format(
      "{} scans, numbered by `scan` in the tiles, with the scanners that the inputs name",
      plan.scanners.size()));
}

}  // namespace

void check_agreement(const std::vector<IndexedInput>& inputs, Plan& plan) {
  const IndexedInput& first = inputs.front();
  const io::LasFile las = io::attached_las_file(first.outline);
  bool besides = false;
  std::vector<std::string> lost;
  for (const IndexedInput& input : inputs) {
    const PointCloud& outline = input.outline;
    besides = besides || !std::all_of(outline.foreign_elements.begin(),
                                      outline.foreign_elements.end(), io::is_las_element);
    if (&input == &first) continue;
    check_columns(first, input);
    if (detect::declares_estimated_normals(first.outline) !=
        detect::declares_estimated_normals(outline)) {
      refuse_pair(first, input, "differ in whether pcednet estimated their normals");
    }
    const io::LasFile other = io::attached_las_file(outline);
    check_las(first, input, las, other);
    add_lost(las, other, lost);
  }
  if (besides) plan.notes.emplace_back("other elements than points, such as faces, are left out");
  note_lost_records(first, std::move(lost), plan);
}

void choose_scanners(std::vector<IndexedInput>& inputs, const std::optional<Vec3>& viewpoint,
                     Plan& plan) {
  const std::vector<Vec3>& first = inputs.front().outline.scanners;
  bool differ = false, any = false;
  for (const IndexedInput& input : inputs) {
    const std::vector<Vec3>& its = input.outline.scanners;
    if (viewpoint && io::has_several_scans(input.outline)) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("{}: is of several scans, and one scanner saw all points",
                              input.input.path.string()));
    }
    differ = differ || !io::are_same(its, first);
    any = any || std::any_of(its.begin(), its.end(), [](const Vec3& at) { return at.allFinite(); });
  }
  if (viewpoint) {
    plan.scanners = {*viewpoint};
  } else if (!differ) {
    plan.scanners = first;
  } else if (any) {
    join_scanners(inputs, plan);
  }
}

}  // namespace pcednet::tiles
