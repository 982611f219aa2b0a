#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

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

}  // namespace pcednet::truth
