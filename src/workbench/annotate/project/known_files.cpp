#include "workbench/annotate/project/known_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/formats/file_name.h"

namespace pcednet::annotate {

namespace fs = std::filesystem;

fs::path place_of_input(const fs::path& project, std::span<const InputIdentity> known,
                        std::size_t number, const fs::path& folder) {
  fs::path place = formats::find_written((folder / known[number].name).lexically_normal());
  std::error_code ignored;
  if (fs::is_regular_file(place, ignored)) return place;
  const std::string what =
      known.size() == 1
          ? fmt::format("its cloud, {}, is missing: put it back, or name its place", place.string())
          : fmt::format(
                "cloud {} of {}, {}, is missing: put it back, or name all clouds in their "
                "order",
                number + 1, known.size(), place.string());
  throw Error(ErrorKind::kUnreadable, fmt::format("{}: {}", project.string(), what));
}

void check_known(const fs::path& file, std::span<const InputIdentity> known,
                 std::span<const InputIdentity> inputs) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorKind::kInsufficient, fmt::format("{}: {}", file.string(), what));
  };
  const auto same = [](const InputIdentity& a, const InputIdentity& b) {
    return a.digest == b.digest;
  };
  const auto at = std::mismatch(known.begin(), known.end(), inputs.begin(), inputs.end(), same);
  if (at.first == known.end()) return;
  if (at.second == inputs.end()) {
    refuse(fmt::format("of {} clouds, here are {}: name all in their order", known.size(),
                       inputs.size()));
  }
  const std::string which = fmt::format("cloud {} of {}, {},", at.first - known.begin() + 1,
                                        known.size(), at.first->name);
  const bool is_elsewhere = std::any_of(inputs.begin(), inputs.end(),
                                        [&](const auto& input) { return same(input, *at.first); });
  if (is_elsewhere) {
    refuse(fmt::format("{} has another place here: name the clouds in their order", which));
  }
  const std::string its = at.second->name;
  refuse(
      fmt::format("{} is another input now{}: put back the file that was painted, or start afresh "
                  "with --project FILE, which keeps these strokes as they are",
                  which, its == at.first->name ? "" : ", " + its));
}

namespace {

fs::path folder_of(const fs::path& project) {
  return fs::weakly_canonical(fs::absolute(project)).parent_path();
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

}  // namespace

std::string start_name(const fs::path& file, const fs::path& project,
                       const ShippedModels& shipped) {
  const fs::path whole = fs::weakly_canonical(fs::absolute(file));
  const fs::path within = whole.lexically_relative(folder_of(project));
  const bool is_within = !within.empty() && *within.begin() != "..";
  return as_utf8((is_within && !shipped.contains(within.string()) ? within : whole).string());
}

fs::path start_place(const std::string& name, const fs::path& project,
                     const ShippedModels& shipped) {
  if (const auto found = shipped.find(name); found != shipped.end()) return found->second;
  fs::path place = formats::find_written(folder_of(project) / name);
  if (is_file(place)) return place;
  const fs::path here = formats::find_written(name);
  return is_file(here) ? fs::absolute(here) : place;
}

fs::path start_file(const std::string& name, const fs::path& project,
                    const ShippedModels& shipped) {
  fs::path place = start_place(name, project, shipped);
  if (is_file(place)) return place;
  throw Error(ErrorKind::kUnreadable,
              fmt::format("{}: its start, the model {}, is missing: put it back; annotate --model "
                          "begins from another",
                          project.string(), place.string()));
}

}  // namespace pcednet::annotate
