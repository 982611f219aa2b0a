#include "workbench/annotate/start_file.h"

#include <fmt/format.h>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/formats/file_name.h"

namespace pcednet::annotate {

namespace fs = std::filesystem;

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
