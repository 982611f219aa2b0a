#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::io {

using Triangle = std::array<std::uint32_t, 3>;

/// The foreign element that holds these faces, given by their numbers of corners and the
/// concatenated corners, as in PLY.
ForeignElement make_face_element(const std::vector<std::uint32_t>& sizes,
                                 const std::vector<std::uint32_t>& corners);

/// The foreign element `edge` that holds these lines, given by the vertices at their two ends, as
/// in PLY.
ForeignElement make_edge_element(const std::vector<std::uint32_t>& ends);

/// The number of faces that the element `face` of the cloud declares; 0 if there is none.
std::size_t face_count(const PointCloud& cloud);

/// For the user, where the vertices are taken for the points, which they seldom are meant to be;
/// empty if there are no faces.
std::string note_on_faces(const PointCloud& cloud);

/// The faces of the mesh whose vertices `cloud` holds, from its foreign element `face`: its list
/// vertex_indices or vertex_index, polygons cut into triangles from their first corner. Empty if
/// there is no such element. Throws Error(kUnreadable) for a corner that is not a vertex.
std::vector<Triangle> triangles_of(const PointCloud& cloud);

}  // namespace pcednet::io
