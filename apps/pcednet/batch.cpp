#include "batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <set>
#include <vector>

#include "common.h"
#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/virtual_cloud.h"
#include "pcednet/io/las/facts.h"
#include "pcednet/io/text/xyz.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

/// Whether a file of a folder is a text such as README.txt, which is there for people.
bool is_prose(const fs::path& file) {
  const std::string extension = io::extension_of(file);
  std::error_code ignored;  // a pipe can be read only once
  if (extension != ".txt" && extension != ".csv" && extension != ".asc") return false;
  if (!fs::is_regular_file(file, ignored)) return false;
  try {
    const io::InputFile text(file);
    if (text.size() == 0) return true;
    return formats::format_of(text).is_text() && !io::begins_as_points(text);
  } catch (const Error&) {
    return false;  // told where it is read
  }
}

/// Whether the file of a folder holds points: a mesh is often that of a cloud beside it, and a
/// hidden file something else, such as the "._scan.las" that macOS puts beside scan.las.
bool is_of_points(const fs::path& file) {
  const formats::Format* format = formats::find_format(file);
  return format && !format->is_mesh && !file.filename().string().starts_with('.');
}

std::vector<fs::path> files_in(const fs::path& folder, std::vector<fs::path>& passed_over) {
  std::vector<fs::path> files;
  std::error_code error, ignored;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!is_of_points(entry->path()) || entry->is_directory(ignored)) continue;
    (is_prose(entry->path()) ? passed_over : files).push_back(entry->path());
  }
  if (error) {
    throw Error(ErrorKind::kUnreadable,
                fmt::format("{}: cannot read the folder: {}", folder.string(), error.message()));
  }
  if (files.empty()) {
    throw Error(ErrorKind::kInsufficient, fmt::format("{}: no point files in it", folder.string()));
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> files_of(const std::string& argument, std::vector<fs::path>& passed_over) {
  std::error_code error;
  const fs::file_status status = fs::status(argument, error);
  if (fs::is_directory(status)) return files_in(argument, passed_over);
  if (status.type() == fs::file_type::not_found) {
    throw Error(ErrorKind::kUnreadable, fmt::format("{}: no such file", argument));
  }
  if (formats::is_virtual_cloud(argument)) return formats::files_of_virtual_cloud(argument);
  return {argument};
}

void warn_of_passed_over(const Inputs& inputs) {
  for (const fs::path& file : inputs.passed_over) {
    warn(fmt::format("{}: does not look like a text of points: skipped", file.string()));
  }
}

/// A file, and the square of the plane of x and y that its points take.
struct Footprint {
  fs::path file;
  BoundingBox box;

  double side() const { return std::max(along(0), along(1)); }
  double along(int axis) const { return box.max[axis] - box.min[axis]; }
};

std::vector<Footprint> footprints(std::span<const fs::path> files) {
  std::vector<Footprint> found;
  for (const fs::path& path : files) {
    const formats::Format* format = formats::find_format(path);
    std::error_code error;
    if (!format || !format->is_las() || !fs::is_regular_file(path, error)) continue;
    try {
      const io::LasOutline las = io::las_outline(io::InputFile(path));
      if (las.points > 0 && !las.bounds.empty()) found.push_back({path, las.bounds});
    } catch (const Error&) {
      continue;  // told where it is read
    }
  }
  return found;
}

/// The length that both have in common along an axis; below 0: the gap between them.
double overlap(const Footprint& a, const Footprint& b, int axis) {
  return std::min(a.box.max[axis], b.box.max[axis]) - std::max(a.box.min[axis], b.box.min[axis]);
}

bool adjoin(const Footprint& a, const Footprint& b) {
  // A gap is that between points. Files that overlap more are of the same place.
  constexpr double kGap = 0.01, kMostOverlap = 0.25, kLeastEdge = 0.1;
  const double side = std::min(a.side(), b.side());
  for (const int across : {0, 1}) {
    const double common = overlap(a, b, across), edge = overlap(a, b, 1 - across);
    const double most = std::min(a.along(1 - across), b.along(1 - across));
    if (common >= -kGap * side && common <= kMostOverlap * side && edge > kLeastEdge * most) {
      return true;
    }
  }
  return false;
}

}  // namespace

Inputs find_inputs(const std::vector<std::string>& arguments) {
  Inputs inputs;
  std::set<fs::path> seen;
  for (const std::string& argument : arguments) {
    try {
      for (const fs::path& file : files_of(argument, inputs.passed_over)) {
        if (seen.insert(fs::absolute(file).lexically_normal()).second) inputs.files.push_back(file);
      }
    } catch (const Error& error) {
      inputs.failures.push_back({argument, error});
    }
  }
  return inputs;
}

std::vector<fs::path> expand_inputs(const std::vector<std::string>& arguments) {
  Inputs inputs = find_inputs(arguments);
  if (!inputs.failures.empty()) throw inputs.failures.front().error;
  warn_of_passed_over(inputs);
  return std::move(inputs.files);
}

void check_not_inputs(const fs::path& output, const std::vector<std::string>& arguments) {
  if (output.empty()) return;
  for (const std::string& argument : arguments) check_not_input(output, argument);
  for (const fs::path& file : find_inputs(arguments).files) check_not_input(output, file);
}

Batch::Batch(const Inputs& inputs) : inputs_(inputs.count()) {
  warn_of_passed_over(inputs);
  for (const Failure& failure : inputs.failures) add(failure);
}

void Batch::add(const Failure& failure) {
  if (inputs_ == 1) throw failure.error;
  say_error(failure.error.what());
  failures_.push_back(failure);
}

bool Batch::run(const fs::path& file, const std::function<void()>& work) {
  try {
    with_name_in_errors(file, work);
    return true;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kCancelled) throw;
    add({file.string(), error});
    return false;
  }
}

void Batch::finish() const {
  if (failures_.empty()) return;
  std::string names;
  for (const Failure& failure : failures_) names += "\n  " + failure.input;
  throw Error(failures_.front().error.kind(),
              fmt::format("{} of {} inputs failed, for the reasons above:{}", failures_.size(),
                          inputs_, names));
}

void with_name_in_errors(const fs::path& file, const std::function<void()>& work) {
  const std::string name = file.string();
  try {
    work();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kCancelled) throw;
    // Explained here: the rethrown error no longer has the type ExistsAlready.
    const std::string message = explain(error);
    const bool is_named = message.find(name) != std::string::npos;
    throw Error(error.kind(), is_named ? message : name + ": " + message);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::kFailure, name + ": not enough memory");
  }
}

std::optional<std::pair<fs::path, fs::path>> find_adjoining(std::span<const fs::path> files) {
  if (files.size() < 2) return std::nullopt;
  std::vector<Footprint> all = footprints(files);
  // Only files that begin before another ends along x can touch it.
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b) { return a.box.min.x() < b.box.min.x(); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double end = all[i].box.max.x() + all[i].side();
    for (std::size_t k = i + 1; k < all.size() && all[k].box.min.x() <= end; ++k) {
      if (adjoin(all[i], all[k])) return std::pair(all[i].file, all[k].file);
    }
  }
  return std::nullopt;
}

}  // namespace pcednet::app
