#pragma once

#include <vector>

#include "pcednet/detect/classify.h"

namespace pcednet::detect {

// In noise thicker than the spacing no scale near the spacing shows an edge. Where a cloud has no
// normals and PrepareOptions::average_noise is set, prepare() puts averages in place of such
// points, which are fewer: classify() and find_boundary() are about these, and each point of the
// cloud has what was found of its average. In the same way points stand for those that crowd around
// them at the poles of a scanner whose place is known.

/// Whether thick noise is averaged before this model classifies. A model without experts knows the
/// points as they are from its training, and so do those who give s_min.
bool averages_noise(const EdgeModel& model);

/// What was found of every point of the cloud; `found` itself unless points were averaged.
Classification of_all_points(const PreparedCloud& prepared, Classification found);

/// The same for normals, or none: (0,0,0) for points that are not finite.
std::vector<Vec3> of_all_points(const PreparedCloud& prepared, std::vector<Vec3> normals);

/// The other way, from the edge classes of all points: each average has that of most of its points
/// (others than these four are non-edge) and their mean probabilities, if there are any; `found`
/// itself unless points were averaged.
Classification of_averages(const PreparedCloud& prepared, Classification found);

}  // namespace pcednet::detect
