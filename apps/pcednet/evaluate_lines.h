#pragma once

#include <string>
#include <vector>

#include "common.h"

namespace pcednet::app {

struct LineEvaluation {
  std::vector<std::string> inputs;  ///< files of lines, or folders of them
  std::string truth;                ///< a file of curves, or a folder
  std::string cloud;                ///< the cloud, or a folder; may be empty
  std::string json;
};

/// `pcednet evaluate --truth`: scores of lines against true curves.
void evaluate_lines(const LineEvaluation& arguments, const Common& common);

}  // namespace pcednet::app
