#include "workbench/annotate/project/classes.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"

namespace pcednet::annotate {
namespace {

[[noreturn]] void refuse_classes(const std::string& why) {
  throw Error(ErrorKind::kUsage, "classes: " + why);
}

/// Names that look alike are equal in it: "Sharp edge" is "sharp-edge".
std::string alike(std::string name) {
  for (char& c : name) {
    if (c == '-' || c == '_') c = ' ';
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return name;
}

void check_names_differ(const ProjectClasses& classes) {
  std::set<std::string> names;
  for (std::size_t id = 0; id < classes.table.size(); ++id) {
    const std::string& name = classes.table[id].name;
    if (classes.removed.contains(static_cast<std::uint8_t>(id))) continue;
    if (names.insert(alike(name)).second) continue;
    refuse_classes(fmt::format("another one is named nearly as \"{}\"", name));
  }
}

}  // namespace

std::vector<std::size_t> counts_of(std::span<const std::size_t> counts,
                                   const ProjectClasses& classes) {
  const std::size_t size = classes.has_own() ? classes.table.size() : std::size_t{kBoundary};
  return {counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(size)};
}

void check_change(const ProjectClasses& now, const ProjectClasses& wanted,
                  std::span<const std::size_t> counts, const std::set<std::uint8_t>& ever) {
  check_classes(wanted.table);
  if (wanted.table != now.table) check_names_differ(wanted);
  for (const std::uint8_t id : wanted.removed) {
    if (id >= wanted.table.size()) refuse_classes("there is no such class to remove");
    const std::string& name = wanted.table[id].name;
    if (wanted.has_edges() && id <= kBoundary) refuse_classes(name + " stays: edges go together");
    if (counts[id] > 0) refuse_classes(name + " is painted: erase its points before removing it");
  }
  if (ever.empty()) return;
  if (now.has_edges() != wanted.has_edges() || wanted.table.size() < now.table.size()) {
    refuse_classes(
        "after the first stroke they can be added to, renamed and removed; --project FILE "
        "begins another project");
  }
  for (const std::uint8_t id : now.removed) {
    const bool renamed = wanted.table[id].name != now.table[id].name;
    if (renamed && ever.contains(id) && !wanted.removed.contains(id)) {
      refuse_classes(now.table[id].name +
                     " was painted before: it can come back, but not as another");
    }
  }
}

ProjectClasses wanted_classes(const ProjectClasses& now, const ClassTable& asked) {
  const auto same = [](const PointClass& a, const PointClass& b) { return a.name == b.name; };
  const std::size_t known = now.table.size();
  if (asked.size() < known ||
      !std::equal(now.table.begin(), now.table.end(), asked.begin(), same)) {
    return {.table = asked};
  }
  ProjectClasses wanted = now;
  wanted.table.insert(wanted.table.end(), asked.begin() + static_cast<std::ptrdiff_t>(known),
                      asked.end());
  return wanted;
}

}  // namespace pcednet::annotate
