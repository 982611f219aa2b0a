#pragma once

#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"
#include "pcednet/detect/classify.h"

namespace CLI {
class App;
}

namespace pcednet::app {

/// A method that needs no model, and its settings; 0 and negative: the method's default.
struct MethodArguments {
  std::string name;
  int neighbours = 0;
  double threshold = -1.0;
  double offset_radius = 0.0, convolution_radius = 0.0;
};

/// Adds --method, --neighbours, --threshold, --offset-radius and --convolution-radius.
void add_method_options(CLI::App& command, MethodArguments& arguments);

/// Classes by the method: sharp-edge or non-edge. p_sharp is v / (v + threshold) for its value v,
/// so that 0.5 is the threshold. Throws Error(kUsage) where an option does not go with the method.
detect::Classification classify_by_method(const PointCloud& cloud, const MethodArguments& arguments,
                                          const Progress* progress);

}  // namespace pcednet::app
