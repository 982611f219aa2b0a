#pragma once

#include <string>
#include <vector>

#include "pcednet/detect/classify.h"

namespace pcednet::detect {

/// Begins the comment of a result that names its model.
inline constexpr std::string_view kModelComment = "pcednet model ";

struct ResultOptions {
  bool class_colours = false;  ///< colour by class even if the cloud has colours
};

struct KeptInput {
  bool labels = false;                     ///< as scalar_input_label
  bool colours = false;                    ///< instead of the class colours
  std::vector<std::string> replaced = {};  ///< see replaced_attributes()
};

/// The cloud's own attributes that a result replaces, without "scalar_": they have names of the
/// result's, in a cloud that names no model.
std::vector<std::string> replaced_attributes(const PointCloud& cloud);

/// Names own classes in the cloud's comments, which classes_of() reads.
void add_class_comments(PointCloud& cloud, const ClassTable& table);

/// Adds a classification to its cloud, under names that viewers understand:
///
///     quality             p_sharp + p_smooth, for MeshLab
///     scalar_edge_class   the class, for CloudCompare
///     scalar_p_sharp, scalar_p_smooth
///     label               the class again, for CGAL and others
///
/// Adds the colours of the paper where the cloud has none, normals that were estimated, and
/// comments on version and model. Labels that the cloud had move to scalar_input_label. Returns
/// which of the cloud's own labels and colours were kept, and which attributes were replaced.
///
/// A result of averages (averages.h) is that of their points. Throws Error(kUsage) for one of
/// another number of points.
///
/// With own classes, quality and scalar_p_class are the probability of the class; if no class is an
/// edge class, scalar_class replaces scalar_edge_class, scalar_p_sharp and scalar_p_smooth.
KeptInput add_result(PointCloud& cloud, const PreparedCloud& prepared, const Classification& result,
                     const EdgeModel& model, const ResultOptions& options = {});

/// The same with the normals that were made, which are those of PreparedCloud: one per point, or
/// none.
KeptInput add_result(PointCloud& cloud, std::span<const Vec3> made, const Classification& result,
                     const EdgeModel& model, const ResultOptions& options = {});

}  // namespace pcednet::detect
