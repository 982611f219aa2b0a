#pragma once

#include <cstdint>
#include <vector>

#include "lines_arguments.h"
#include "pcednet/cloud/point_cloud.h"
#include "pcednet/detect/classify.h"

namespace pcednet::app {

/// The labels that lines are drawn of: those of the codes of --las-classification, otherwise the
/// cloud's own, otherwise those in a column of edges. Says which, but for its own. Empty if there
/// are none. Throws Error(kInsufficient) if no point has one of the codes, or for labels that are
/// no numbers of classes.
std::vector<std::uint8_t> labels_to_draw(const LinesArguments& arguments, const PointCloud& cloud);

/// These classes and the probabilities of the file, if it has any. Throws Error(kInsufficient) for
/// one that is not in [0, 1].
detect::Classification with_probabilities(const LinesArguments& arguments, const PointCloud& cloud,
                                          std::vector<std::uint8_t> classes);

/// The labels that a part of the cloud carries, with probabilities in any case.
detect::Classification labels_of_part(const LinesArguments& arguments, const PointCloud& part);

}  // namespace pcednet::app
