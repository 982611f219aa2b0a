#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "pcednet/cloud/class_table.h"

namespace pcednet::annotate {

/// The classes of a project. A class keeps its number permanently, since strokes refer to it: a
/// removed class stays in the table, as undo may restore its points.
struct ProjectClasses {
  ClassTable table = edge_classes();
  std::set<std::uint8_t> removed = {};
  bool operator==(const ProjectClasses&) const = default;

  bool has_edges() const { return pcednet::has_edges(table); }
  bool has_own() const { return has_own_classes(table); }

  /// Whether strokes may paint the class: boundary is found by geometry.
  bool may_paint(std::uint8_t id) const {
    return id < table.size() && !removed.contains(id) && !(id == kBoundary && has_edges());
  }
};

/// The number of painted points by class, from the `counts` of the labels: without boundary if all
/// classes are edge classes.
std::vector<std::size_t> counts_of(std::span<const std::size_t> counts,
                                   const ProjectClasses& classes);

/// Throws Error(kUsage), with the reason, if a project's classes cannot become `wanted`. `counts`
/// are the painted points by class, `ever` the classes that any stroke painted: before the first
/// stroke all changes are possible; later, classes may be added, renamed, recoloured and, where no
/// point is painted, removed. Names that differ only in case, spaces, hyphens and underscores count
/// as the same.
void check_change(const ProjectClasses& now, const ProjectClasses& wanted,
                  std::span<const std::size_t> counts, const std::set<std::uint8_t>& ever);

/// The classes that the user asks for by name: `now` if it begins with these classes, extended by
/// those that follow; otherwise `asked` itself.
ProjectClasses wanted_classes(const ProjectClasses& now, const ClassTable& asked);

}  // namespace pcednet::annotate
