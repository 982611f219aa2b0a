#include "pcednet/tiles/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/io/las/file.h"
#include "pcednet/io/scanners.h"
#include "pcednet/tiles/las_meaning.h"

namespace pcednet::tiles {
namespace {

[[noreturn]] void refuse_pair(const IndexedInput& a, const IndexedInput& b,
                              const std::string& difference,
                              const std::string& way_out = "plan them one by one") {
  throw Error(ErrorKind::kUsage, fmt::format("{} and {} {}: {}", a.input.path.string(),
                                             b.input.path.string(), difference, way_out));
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

bool is_las(const IndexedInput& input) {
  return !io::attached_las_file(input.outline).header.empty();
}

bool has(const IndexedInput& input, std::string_view column) {
  return std::ranges::any_of(input.columns,
                             [&](const auto& its) { return its.starts_with(column); });
}

/// Whether columns that one of them has can be 0 in the other: not so normals, labels, numbers of
/// scans, and places of waveforms.
bool can_be_zero(const IndexedInput& a, const IndexedInput& b) {
  constexpr std::string_view kNever[] = {"normals", "labels", "scan (", "WavePacket"};
  return std::ranges::all_of(
      kNever, [&](std::string_view column) { return has(a, column) == has(b, column); });
}

/// Whether its colours are those of fields of LAS, if it has any.
bool has_las_columns(const IndexedInput& input) {
  return is_las(input) &&
         has(input, "colours") == (find_attribute(input.outline, "Red") != nullptr);
}

void check_columns(const IndexedInput& a, const IndexedInput& b) {
  if (a.columns == b.columns) return;
  const bool can = can_be_zero(a, b);
  if (can && has_las_columns(a) && has_las_columns(b)) return;
  std::string difference = only_in(a, b) + only_in(b, a);
  difference = difference.empty() ? "have their columns in different orders"
                                  : "have different columns" + difference;
  const IndexedInput& other = is_las(a) ? b : a;
  if (!can || is_las(other)) refuse_pair(a, b, difference);
  std::filesystem::path las = other.input.path;
  las.replace_extension(".laz");
  refuse_pair(a, b, difference,
              fmt::format("columns of LAZ may differ, and pcednet convert {} -o {} makes one",
                          other.input.path.string(), las.string()));
}

constexpr const char* kTimes = "GpsTime";

/// The first of these, and how many there are.
std::string some_of(const std::vector<std::string>& names) {
  return names.front() + (names.size() == 1 ? "" : fmt::format(" and {} more", names.size() - 1));
}

/// The statements of the inputs so far, and which input made each.
struct Said {
  std::vector<std::size_t> forms = {};              ///< see Plan
  std::map<std::string, std::size_t> columns = {};  ///< how many inputs have each
  std::map<std::string, std::pair<const IndexedInput*, ExtraMeaning>> meanings = {};
  const IndexedInput* bytes = nullptr;    ///< has extra bytes without description
  std::optional<std::size_t> timed = {};  ///< the first with GPS times
  std::vector<int> system_ranks = {};     ///< system_rank() of each input
  std::size_t system = 0;                 ///< the first input of the highest rank
};

/// Throws unless two systems are the same, as far as both are named.
void check_systems(const IndexedInput& a, const IndexedInput& b) {
  const std::string different = different_systems(a.outline, b.outline);
  if (!different.empty()) refuse_pair(a, b, "have different coordinate systems: " + different);
}

void compare_extra_bytes(IndexedInput& input, const io::LasFile& file, Said& said) {
  std::vector<std::string> known;
  const auto fields = io::las_extra_fields(file, known);
  const bool all_described =
      std::ranges::all_of(fields, [](const auto& field) { return field.descriptor.has_value(); });
  if (!all_described && !said.bytes) said.bytes = &input;
  for (auto& [name, meaning] : extra_meanings(file)) {
    const auto [found, is_new] = said.meanings.try_emplace(name, &input, meaning);
    if (!is_new && found->second.second != meaning) input.input.left_out.push_back(name);
  }
}

/// The offset of LAS 1.5 can only be that of the first input, whose header the tiles have.
void compare_times(std::vector<IndexedInput>& inputs, std::size_t i, Said& said) {
  if (!inputs[i].has_times) return;
  const auto base_of = [&](std::size_t input) {
    return time_base(io::attached_las_file(inputs[input].outline));
  };
  const TimeBase base = base_of(i);
  if (!said.timed && (!base.has_offset || base == base_of(0))) said.timed = i;
  if (!said.timed || base != base_of(*said.timed)) inputs[i].input.left_out.emplace_back(kTimes);
}

/// Compares input number `i` with those before.
void check_las(std::vector<IndexedInput>& inputs, std::size_t i, Said& said) {
  IndexedInput& input = inputs[i];
  const io::LasFile file = io::attached_las_file(input.outline);
  compare_extra_bytes(input, file, said);
  compare_times(inputs, i, said);
  check_systems(inputs[said.system], input);
  said.system_ranks.push_back(system_rank(file));
  if (said.system_ranks[i] > said.system_ranks[said.system]) said.system = i;
  if (i > 0 && (has_waveforms(file) || has_waveforms(io::attached_las_file(inputs[0].outline)))) {
    refuse_pair(inputs[0], input,
                "have waveforms, and the tiles could keep those of one file only");
  }
}

/// Counts the columns; an input that brings a new one is a form.
void count_columns(const std::vector<IndexedInput>& inputs, std::size_t i, Said& said) {
  bool is_form = i == 0;
  for (const Attribute& column : inputs[i].outline.attributes) {
    if (column.name == "scan" && inputs[i].input.scans > 0) continue;  // all have numbers
    // Undescribed bytes of another number are another column.
    const std::string name = column.components == 1
                                 ? column.name
                                 : fmt::format("{} ({} numbers)", column.name, column.components);
    is_form = ++said.columns[name] == 1 || is_form;
  }
  if (is_form) said.forms.push_back(i);
}

/// Notes the columns that are 0 in places.
void note_columns(const std::vector<IndexedInput>& inputs, const Said& said, Plan& plan) {
  constexpr std::string_view kOfVersions[] = {"ScanAngle", "ScanAngleRank", "Overlap",
                                              "ScanChannel"};  // 0 means nothing, or are converted
  std::vector<std::string> missing;
  for (const auto& [name, count] : said.columns) {
    const bool is_told = std::ranges::find(kOfVersions, name) == std::end(kOfVersions);
    if (count < inputs.size() && is_told) missing.push_back(name);
  }
  if (missing.empty()) return;
  plan.notes.push_back(
      fmt::format("the inputs have different columns: the tiles have all, with 0 where an input "
                  "has none: {}",
                  fmt::join(missing, ", ")));
}

/// Notes the columns that an input gives another meaning than the first that has them.
void note_left_out(const std::vector<IndexedInput>& inputs, const Said& said, Plan& plan) {
  std::map<std::string, std::vector<std::string>> names;
  for (const IndexedInput& input : inputs) {
    for (const std::string& column : input.input.left_out) {
      names[column].push_back(input.input.path.string());
    }
  }
  for (const auto& [column, its] : names) {
    const bool is_time = column == kTimes;
    const IndexedInput& first =
        is_time ? inputs[said.timed.value_or(0)] : *said.meanings.at(column).first;
    plan.notes.push_back(fmt::format("{}: {} {} than in {}: 0 in the tiles", some_of(its), column,
                                     is_time ? "has another base (seconds of the week, or adjusted)"
                                             : "has another type, scale, offset or no-data value",
                                     first.input.path.string()));
  }
}

/// Notes the inputs that name less of the coordinate system than another.
void note_systems(const std::vector<IndexedInput>& inputs, const Said& said, Plan& plan) {
  for (int rank = 0; rank < said.system_ranks[said.system]; ++rank) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      if (said.system_ranks[i] == rank) names.push_back(inputs[i].input.path.string());
    }
    if (names.empty()) continue;
    plan.notes.push_back(fmt::format("{}: no {} named: taken for that of {}", some_of(names),
                                     rank == 0 ? "coordinate system is" : "system of heights is",
                                     inputs[said.system].input.path.string()));
  }
}

/// Chooses the forms of the plan.
void choose_forms(const std::vector<IndexedInput>& inputs, Said said, Plan& plan) {
  plan.timed = said.timed.value_or(0);
  for (const std::size_t input : {said.system, plan.timed}) {
    if (std::ranges::count(said.forms, input) == 0) said.forms.push_back(input);
  }
  if (said.forms.size() > 1 && said.bytes) {
    refuse_pair(inputs[said.forms[0]], inputs[said.forms[1]],
                fmt::format("have different columns or headers, and {} has extra bytes that it "
                            "does not describe",
                            said.bytes->input.path.string()));
  }
  note_columns(inputs, said, plan);
  note_left_out(inputs, said, plan);
  note_systems(inputs, said, plan);
  plan.forms = std::move(said.forms);
}

/// The records beside points that `file` has and the first input has not, or otherwise.
void add_lost(const io::LasFile& first, const io::LasFile& file, std::vector<std::string>& lost) {
  const auto all_of = [](const io::LasFile& las) {
    std::vector<const io::LasRecord*> all = io::all_records(las);
    // These were compared, or are written anew, or are comments.
    std::erase_if(all, [](const io::LasRecord* r) {
      return r->user_id == io::kWktRecord.user_id || r->is(io::kExtraBytesRecord) ||
             r->is(io::kLaszipRecord) || r->is(io::kCommentsRecord);
    });
    return all;
  };
  const std::vector<const io::LasRecord*> kept = all_of(first);
  for (const io::LasRecord* record : all_of(file)) {
    const bool is_kept = std::any_of(kept.begin(), kept.end(), [&](const io::LasRecord* other) {
      return other->user_id == record->user_id && other->record_id == record->record_id &&
             other->data == record->data;
    });
    std::string name = fmt::format("{} {}", record->user_id, record->record_id);
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

void check_agreement(std::vector<IndexedInput>& inputs, Plan& plan) {
  const IndexedInput& first = inputs.front();
  const io::LasFile las = io::attached_las_file(first.outline);
  bool besides = false;
  std::vector<std::string> lost;
  Said said;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const PointCloud& outline = inputs[i].outline;
    besides = besides || !std::all_of(outline.foreign_elements.begin(),
                                      outline.foreign_elements.end(), io::is_las_element);
    check_columns(first, inputs[i]);
    if (detect::declares_estimated_normals(first.outline) !=
        detect::declares_estimated_normals(outline)) {
      refuse_pair(first, inputs[i], "differ in whether pcednet estimated their normals");
    }
    count_columns(inputs, i, said);
    check_las(inputs, i, said);
    add_lost(las, io::attached_las_file(outline), lost);
  }
  if (besides) plan.notes.emplace_back("other elements than points, such as faces, are left out");
  note_lost_records(first, std::move(lost), plan);
  choose_forms(inputs, std::move(said), plan);
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
