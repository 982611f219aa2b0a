#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/class_table.h"
#include "pcednet/core/vec3.h"

namespace pcednet::eval {

/// The file in `folder` with another program's predictions for the cloud `stem`: STEM, STEM_edges
/// or STEM_output, with an extension that read_predictions() knows, but not the file `cloud`
/// itself. Empty if there is none.
std::filesystem::path find_predictions(const std::filesystem::path& folder, const std::string& stem,
                                       const std::filesystem::path& cloud);

struct Predictions {
  std::vector<std::uint8_t> classes;  ///< per position
  std::string note;                   ///< how they were assigned; empty: in order
};

/// The classes of a cloud at `positions` from another program's file:
/// - a class per point in the cloud's order: what formats::read_labels() reads, or, for edge
///   classes, formats::edge_column_of();
/// - .npy: classes of shape (points) or (points, 1), of which true is sharp-edge, or scores of
///   shape (points, classes) for at most 255 classes, where the largest score wins, the lower class
///   on ties;
/// - a point file with labels and other points, as from a method that resamples, or with the points
///   of the cloud in another order: every position gets the label of its nearest point in the file,
///   as in Himeur et al. 2021. Of as many points in other coordinates, the order is that of the
///   cloud;
/// - for edge classes, a point file without labels, with points on edges only: the position nearest
///   to each is sharp-edge.
/// Throws what the readers throw, and Error(kInsufficient) where labels are missing, numbers do not
/// fit, or are neither a class of `table` nor unlabelled; it names the line, the row or the point,
/// from 0 but for lines.
Predictions read_predictions(const std::filesystem::path& path, std::span<const Vec3> positions,
                             const ClassTable& table = edge_classes());

}  // namespace pcednet::eval
