#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "pcednet/cloud/class_table.h"

namespace pcednet::annotate {

/// The classes of a project. A class keeps its number for good, since strokes name it: one that the
/// user removes stays in the table, as undo may bring its points back.
struct ProjectClasses {
  ClassTable table = edge_classes();
  std::set<std::uint8_t> removed = {};
  bool operator==(const ProjectClasses&) const = default;

  bool has_edges() const { return pcednet::has_edges(table); }
  bool has_own() const { return has_own_classes(table); }

  /// Whether strokes may give points the class: boundary is found by geometry.
  bool may_paint(std::uint8_t id) const {
    return id < table.size() && !removed.contains(id) && !(id == kBoundary && has_edges());
  }
};

/// How many points are painted, by class, of labels that have `counts`: without boundary if all
/// classes are edges.
std::vector<std::size_t> counts_of(std::span<const std::size_t> counts,
                                   const ProjectClasses& classes);

/// Throws Error(kUsage) that says why a project's classes cannot become `wanted`. `counts` are the
/// painted points by class, `ever` the classes that a stroke ever painted: until the first one any
/// classes will do, later others may be added, renamed, recoloured and, where no point is painted,
/// removed.
void check_change(const ProjectClasses& now, const ProjectClasses& wanted,
                  std::span<const std::size_t> counts, const std::set<std::uint8_t>& ever);

/// What the user asks for by name: `now` if it has these classes already, with those added that
/// come after them; otherwise `asked` itself.
ProjectClasses wanted_classes(const ProjectClasses& now, const ClassTable& asked);

}  // namespace pcednet::annotate
