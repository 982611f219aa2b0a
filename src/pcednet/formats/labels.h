#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::formats {

/// Reads a file of nothing but one label per point, an EdgeClass each: .u8 (a byte per point), or a
/// text with one whole number a line (.txt, .csv, .lbl, .seg; -1 is unlabelled). None if it may
/// hold points. Throws Error(kUnreadable) like read_cloud, also for a number that is no label. Of
/// `classes`, where they are given, 255 and -1 are unlabelled and no other number, nor NaN, is a
/// label.
std::optional<std::vector<std::uint8_t>> read_bare_labels(
    const std::filesystem::path& path, std::optional<std::size_t> classes = std::nullopt);

/// The same, or the labels of any point file, see labels_of. Throws Error(kInsufficient) if that
/// has none.
std::vector<std::uint8_t> read_labels(const std::filesystem::path& path);

/// The classes that `cloud` carries: its attribute scalar_edge_class or edge_class, which a
/// classification leaves, otherwise its labels; empty if it has neither. Throws
/// Error(kInsufficient), naming `path`, if that attribute holds numbers outside 0 ... 255.
std::vector<std::uint8_t> labels_of(const PointCloud& cloud, const std::filesystem::path& path);

/// Classes in a column that is not the labels of its format, as in LAS a label of another type than
/// a byte, or that has one of the names that other programs give to edges.
struct ColumnLabels {
  std::vector<std::uint8_t> classes;
  std::string column;
};

/// The first of label, is_edge, edge and edge_label in `cloud`, in any case, also after `scalar_`.
/// Numbers are EdgeClass, but 1 is kSharpEdge if there are 0 and 1 alone in any but the first. -1,
/// 255 and NaN are unlabelled. None with other numbers, such as probabilities.
std::optional<ColumnLabels> edge_column_of(const PointCloud& cloud);

/// The name of a column whose numbers could be EdgeClass but need not: class or classification, in
/// any case, where other programs hold the classes of LAS. Empty if there is none.
std::string doubtful_column_of(const PointCloud& cloud);

/// Whether a point has one: not all are kUnlabelled.
bool have_labels(std::span<const std::uint8_t> labels);

}  // namespace pcednet::formats
