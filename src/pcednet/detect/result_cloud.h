#pragma once

#include "pcednet/detect/classify.h"

namespace pcednet::detect {

struct ResultOptions {
  bool class_colours = false;  ///< colour by class even if the cloud has colours
};

struct KeptInput {
  bool labels = false;   ///< as scalar_input_label
  bool colours = false;  ///< in place of those of the classes
};

/// Names own classes in the cloud's comments, which classes_of() reads.
void add_class_comments(PointCloud& cloud, const ClassTable& table);

/// Puts a classification into the cloud it was made of, under the names that viewers understand:
///
///     quality             p_sharp + p_smooth, for MeshLab
///     scalar_edge_class   the class, for CloudCompare
///     scalar_p_sharp, scalar_p_smooth
///     label               the class again, for CGAL and others
///
/// With own classes quality and scalar_p_class are the probability of the class; where none of the
/// classes are edges, scalar_class takes the place of scalar_edge_class and of p_sharp and
/// p_smooth.
///
/// with the colours of the paper where the cloud has none, normals that were estimated, and
/// comments on version and model. Labels that the cloud had move to scalar_input_label. Returns
/// what of the cloud's own was kept so.
KeptInput add_result(PointCloud& cloud, const PreparedCloud& prepared, const Classification& result,
                     const EdgeModel& model, const ResultOptions& options = {});

}  // namespace pcednet::detect
