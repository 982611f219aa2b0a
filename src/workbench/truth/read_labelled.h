#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/loaded_cloud.h"

namespace pcednet::truth {

/// The file of features that belongs to a mesh of the ABC data set (Koch et al. 2019): of
/// NAME_trimesh_NNN.obj it is NAME_features_NNN.yml, in the same folder or where `obj` or `stl2` in
/// the path is `feat`; of any other X.obj it is X.yml. Empty if there is no such file.
std::filesystem::path find_abc_features(const std::filesystem::path& mesh);

/// Labels of a mesh's `points` vertices from its ABC features: sharp-edge for the vertices
/// (`vert_indices`, from 0) of `curves` that are `sharp`, non-edge for the others. Throws
/// Error(kUnreadable) for a file that is not YAML, has no curves, or names a vertex that does not
/// exist.
std::vector<std::uint8_t> read_abc_labels(const std::filesystem::path& features,
                                          std::size_t points);

/// A point file with labels, read as by read_cloud(). Missing labels come from the ABC features of
/// an OBJ (find_abc_features) or from the colours (labels_of_colours), with a warning. Of a result
/// of pcednet they are those that were painted or those of its input, with a warning. Throws
/// Error(kInsufficient), naming the file, if there are none, and as the readers do. An empty file
/// gives an empty cloud.
io::LoadedCloud read_labelled(const std::filesystem::path& path);

/// Pairs of a class and a code of the LAS field Classification that stands for it.
using LabelCodes = std::vector<std::pair<std::uint8_t, std::uint8_t>>;

/// A point file whose labels are in its field Classification, of any format; points of other codes
/// are unlabelled. Without codes, read_labelled(). Throws Error(kInsufficient), naming the file, if
/// it has no such field, or no point of these codes, and as the readers do.
io::LoadedCloud read_labelled(const std::filesystem::path& path, const LabelCodes& codes);

/// These labels of a cloud that was read, with points. Throws as that.
std::vector<std::uint8_t> coded_labels(const PointCloud& cloud, const LabelCodes& codes,
                                       const std::filesystem::path& path);

/// The same of a part of a cloud, of which all may be unlabelled.
std::vector<std::uint8_t> coded_labels_of_part(const PointCloud& part, const LabelCodes& codes,
                                               const std::filesystem::path& path);

/// The classes that colours mean in clouds published with painted results: greys non-edge, yellows
/// and oranges smooth-edge, reds sharp-edge, as in the figures of Himeur et al. 2021. Empty unless
/// the cloud has two or three colours, one of which is a red, and each means another class.
std::vector<std::uint8_t> labels_of_colours(const PointCloud& cloud);

}  // namespace pcednet::truth
