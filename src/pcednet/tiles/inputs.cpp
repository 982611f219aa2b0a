#include "pcednet/tiles/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "pcednet/core/blocks.h"
#include "pcednet/core/digest.h"
#include "pcednet/core/error.h"
#include "pcednet/core/output_file.h"
#include "pcednet/core/parallel.h"
#include "pcednet/formats/format.h"
#include "pcednet/io/las/facts.h"
#include "pcednet/io/las/file.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/scanners.h"
#include "pcednet/tiles/forms.h"

namespace pcednet::tiles {
namespace {

namespace fs = std::filesystem;

/// The digest of all data of a part's points.
std::string digest_of(const PointCloud& part) {
  Digest digest;
  digest.add(std::as_bytes(std::span(part.positions)));
  digest.add_values(std::span<const std::uint8_t>(part.labels));
  for (const auto* columns : {&part.stored_normals, &part.attributes}) {
    for (const Attribute& column : *columns) digest.add(column.name).add(column.bytes);
  }
  digest.add(std::as_bytes(std::span(part.colours)));
  return digest.hex();
}

[[noreturn]] void changed(const fs::path& path, const std::string& what) {
  throw Error(ErrorKind::kUnreadable,
              fmt::format("{}: has changed since the plan: {}; plan again", path.string(), what));
}

Chunk chunk_of(const PointCloud& part, std::string digest) {
  Chunk chunk{.points = part.size(), .digest = std::move(digest)};
  for (const Vec3& position : part.positions) {
    if (has_place(position)) {
      chunk.box.add(position);
    } else {
      ++chunk.without_place;
    }
  }
  return chunk;
}

/// The columns of a cloud, as texts to compare.
std::vector<std::string> columns_of(const PointCloud& cloud) {
  std::vector<std::string> columns;
  if (cloud.has_normals()) columns.emplace_back("normals");
  if (!cloud.colours.empty()) columns.emplace_back("colours");
  if (cloud.has_labels()) columns.emplace_back("labels");
  for (const Attribute& attribute : cloud.attributes) {
    columns.push_back(fmt::format("{} ({} of {} bytes)", attribute.name, attribute.components,
                                  size_of(attribute.type)));
  }
  return columns;
}

/// Takes the least and largest numbers out of the description of extra bytes: those of one input
/// are not those of several.
void forget_extra_ranges(io::LasFile& file) {
  using namespace io::las_descriptor;
  for (io::LasRecord& record : file.records) {
    if (!record.is(io::kExtraBytesRecord)) continue;
    for (std::size_t at = 0; at + kBytes <= record.data.size(); at += kBytes) {
      if (record.data[at + kType] == 0) continue;  // bytes, and the options are how many
      const auto options = io::number_at<std::uint8_t>(record.data, at + kOptions);
      io::put_number(record.data, at + kOptions,
                     static_cast<std::uint8_t>(options & ~(kLeastBit | kMostBit)));
      record.data.replace(at + kLeast, kScale - kLeast, kScale - kLeast, '\0');
    }
  }
}

bool has_times(const PointCloud& part) {
  const Attribute* times = find_attribute(part, "GpsTime");
  return times && std::ranges::any_of(times->bytes, [](std::byte b) { return b != std::byte{0}; });
}

/// A part as read_cloud() gives a whole file, without its warnings.
PointCloud finished(PointCloud part) {
  io::PartTally known;
  io::finish_part(part, known);
  return part;
}

/// `part` without its points.
PointCloud without_points(PointCloud part) {
  part.positions.clear(), part.normals.clear(), part.colours.clear(), part.labels.clear();
  for (auto* columns : {&part.stored_normals, &part.attributes}) {
    for (Attribute& column : *columns) column.bytes.clear();
  }
  return part;
}

template <typename T>
void append_rows(const std::vector<T>& from, std::span<const std::uint32_t> chosen,
                 std::vector<T>& to) {
  if (from.empty()) return;
  to.reserve(to.size() + chosen.size());
  for (const std::uint32_t i : chosen) to.push_back(from[i]);
}

void append_rows(const Attribute& from, std::span<const std::uint32_t> chosen, Attribute& to) {
  const std::size_t stride = from.stride();
  std::size_t end = to.bytes.size();
  to.bytes.resize(end + chosen.size() * stride);
  for (const std::uint32_t i : chosen) {
    std::copy_n(from.bytes.data() + i * stride, stride, to.bytes.data() + end);
    end += stride;
  }
}

void append_rows(const std::vector<Attribute>& from, std::span<const std::uint32_t> chosen,
                 std::vector<Attribute>& to) {
  for (std::size_t a = 0; a < std::min(from.size(), to.size()); ++a) {
    append_rows(from[a], chosen, to[a]);
  }
}

/// Throws Error(kUnreadable) if the size or chunks are not those of the planned file.
std::unique_ptr<io::PartReader> open_planned(const PlannedInput& input) {
  check_size(input);
  auto reader = open_chunks(input.path);
  if (reader->points() != input.points() || reader->parts() != input.chunks.size()) {
    changed(input.path, fmt::format("{} points instead of {}", reader->points(), input.points()));
  }
  reader->set_narrow_colours(input.narrow_colours);
  return reader;
}

/// Gives the points of an input the numbers of their scans in the plan's list, -1 if unknown.
void number_scans(const PlannedInput& input, PointCloud& part) {
  std::vector<std::int32_t> scans(part.size(), input.scans == 1 ? input.first_scan : -1);
  if (const Attribute* own = find_attribute(part, "scan")) {
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const double scan = own->value(i);
      const bool is_known = scan >= 0.0 && scan < static_cast<double>(input.scans);
      scans[i] = is_known ? input.first_scan + static_cast<std::int32_t>(scan) : -1;
    }
    erase_attribute(part, "scan");
  }
  part.attributes.push_back(make_attribute("scan", scans));  // last, where the others have none
}

/// Throws Error(kUnreadable) if the chunk has changed since the plan.
PointCloud read_chunk(const io::PartReader& reader, const PlannedInput& input, std::size_t chunk) {
  PointCloud part = reader.read(chunk);
  if (digest_of(part) != input.chunks[chunk].digest) {
    changed(input.path, fmt::format("other points in chunk {}", chunk));
  }
  for (const std::string& column : input.left_out) erase_attribute(part, column);
  if (input.scans > 0) number_scans(input, part);
  return finished(std::move(part));
}

}  // namespace

void read_in_turn(std::span<const std::size_t> parts,
                  const std::function<PointCloud(std::size_t)>& read,
                  const std::function<void(PointCloud&, std::size_t part)>& use) {
  const auto together = 2 * static_cast<std::size_t>(thread_count());
  for_each_block(parts.size(), together, [&](std::size_t begin, std::size_t end) {
    std::vector<PointCloud> some(end - begin);
    parallel_blocks(some.size(), 1,
                    [&](std::size_t i, std::size_t) { some[i] = read(parts[begin + i]); });
    for (std::size_t i = 0; i < some.size(); ++i) {
      use(some[i], parts[begin + i]);
      some[i] = {};
    }
  });
}

std::unique_ptr<io::PartReader> open_chunks(const fs::path& path) {
  auto file = std::make_unique<io::InputFile>(path);
  const formats::Format& format = formats::format_of(*file);
  auto reader = format.is_tiled() ? format.open_parts(std::move(file), kChunkPoints) : nullptr;
  if (reader) return reader;
  fs::path readable = path;
  readable.replace_extension(".laz");
  throw Error(ErrorKind::kUsage,
              fmt::format("{0}: tiles are read from LAS, LAZ and binary PLY without lists: "
                          "pcednet convert {0} -o {1} makes one",
                          path.string(), readable.string()));
}

void check_not_input(const fs::path& output, std::span<const PlannedInput> inputs) {
  std::error_code ignored;
  if (!fs::exists(output, ignored)) return;  // one look instead of one for each input
  for (const PlannedInput& input : inputs) pcednet::check_not_input(output, input.path);
}

void check_size(const PlannedInput& input) {
  const std::uint64_t bytes = io::InputFile(input.path).size();
  if (bytes != input.bytes) {
    changed(input.path, fmt::format("{} bytes instead of {}", bytes, input.bytes));
  }
}

PointCloud read_finished(const io::PartReader& reader, std::size_t chunk) {
  return finished(reader.read(chunk));
}

void for_each_chunk(const PlannedInput& input, const std::function<bool(const Chunk&)>& is_wanted,
                    const Progress* progress,
                    const std::function<void(PointCloud&, std::size_t first)>& use) {
  std::vector<std::size_t> wanted, first(input.chunks.size());
  for (std::size_t c = 0, before = 0; c < input.chunks.size(); ++c) {
    if (is_wanted(input.chunks[c])) wanted.push_back(c);
    first[c] = before;
    before += input.chunks[c].points;
  }
  if (wanted.empty()) return;
  const auto reader = open_planned(input);
  read_in_turn(
      wanted, [&](std::size_t c) { return read_chunk(*reader, input, c); },
      [&](PointCloud& part, std::size_t c) {
        throw_if_cancelled(progress);
        use(part, first[c]);
      });
}

IndexedInput index_input(const fs::path& path, const Progress* progress,
                         std::vector<std::string>& notes,
                         const std::function<void(const PointCloud&)>& see,
                         std::optional<bool> narrow_colours) {
  const auto reader = open_chunks(path);
  if (narrow_colours) reader->set_narrow_colours(*narrow_colours);
  IndexedInput indexed;
  indexed.input = {.path = path,
                   .bytes = io::InputFile(path).size(),
                   .narrow_colours = reader->narrow_colours(),
                   .chunks = {}};
  io::PartTally tally;
  std::size_t withheld = 0;
  Stage stage(progress, "index", reader->points());
  std::vector<std::size_t> parts(reader->parts());
  std::iota(parts.begin(), parts.end(), std::size_t{0});
  const auto take = [&](PointCloud& part, std::size_t) {
    std::string digest = digest_of(part);
    io::finish_part(part, tally);
    with_name_in_errors(path.string(), [&] { check_extent(part.positions); });
    withheld += io::count_withheld(part);
    indexed.has_times = indexed.has_times || has_times(part);
    see(part);
    stage.advance(part.size());
    const bool is_first = indexed.input.chunks.empty();
    indexed.input.chunks.push_back(chunk_of(part, std::move(digest)));
    if (!is_first) return;
    indexed.columns = columns_of(part);
    indexed.outline = without_points(std::move(part));
  };
  read_in_turn(
      parts, [&](std::size_t p) { return reader->read(p); }, take);
  std::vector<std::string> warnings = reader->warnings;
  std::ranges::copy(io::warnings_of(tally), std::back_inserter(warnings));
  if (withheld > 0) warnings.push_back(io::note_on_withheld(withheld, tally.points));
  for (const std::string& warning : warnings) {
    notes.push_back(fmt::format("{}: {}", path.string(), warning));
  }
  return indexed;
}

PointCloud outline_of(const Plan& plan) {
  std::vector<PointCloud> outlines;
  for (const std::size_t form : plan.forms) {
    const PlannedInput& input = plan.inputs[form];
    outlines.push_back(without_points(read_chunk(*open_planned(input), input, 0)));
  }
  const auto timed = std::ranges::find(plan.forms, plan.timed) - plan.forms.begin();
  PointCloud outline = outlines.size() == 1
                           ? std::move(outlines.front())
                           : merge_outlines(std::move(outlines), static_cast<std::size_t>(timed));
  if (plan.estimates) detect::set_estimated_normals(outline, true);
  if (!io::are_same(plan.scanners, outline.scanners)) io::set_scanners(plan.scanners, outline);
  std::erase_if(outline.foreign_elements,
                [](const ForeignElement& element) { return !io::is_las_element(element); });
  if (plan.las_steps.size() != 6) return outline;
  io::LasFile file = io::attached_las_file(outline);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double* const steps = &plan.las_steps[2 * axis];
    io::put_number(file.header, io::las_header::kScales + 8 * axis, steps[0]);
    io::put_number(file.header, io::las_header::kOffsets + 8 * axis, steps[1]);
  }
  if (plan.inputs.size() > 1) forget_extra_ranges(file);
  std::erase_if(outline.foreign_elements, io::is_las_element);
  io::attach_las_file(outline, file);
  return outline;
}

void append_scans(const PointCloud& from, std::span<const std::uint32_t> chosen, PointCloud& to) {
  const Attribute* scans = find_attribute(from, "scan");
  if (!scans) return;
  if (to.attributes.empty()) to.attributes = {{scans->name, scans->type, scans->components, {}}};
  append_rows(*scans, chosen, to.attributes.front());
}

void append_surface(const PointCloud& from, std::span<const std::uint32_t> chosen, PointCloud& to) {
  append_rows(from.positions, chosen, to.positions);
  append_rows(from.normals, chosen, to.normals);
  append_scans(from, chosen, to);
}

void append_points(const PointCloud& from, std::span<const std::uint32_t> chosen, PointCloud& to) {
  append_rows(from.positions, chosen, to.positions);
  append_rows(from.normals, chosen, to.normals);
  append_rows(from.colours, chosen, to.colours);
  append_rows(from.labels, chosen, to.labels);
  append_rows(from.stored_normals, chosen, to.stored_normals);
  append_rows(from.attributes, chosen, to.attributes);
}

}  // namespace pcednet::tiles
