#pragma once

#include <string>
#include <vector>

#include "lines_arguments.h"
#include "pcednet/lines/curve.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::app {

/// Keeps the curves that the user asked for, of those that find_lines() kept; says how many each
/// option leaves out, the first of several that do.
std::string filter_lines(const LinesArguments& arguments, const lines::LineScale& scale,
                         std::vector<lines::Curve>& curves);

/// Says what was found and what was left out, by which lengths.
void report_lines(const LinesArguments& arguments, const lines::LineScale& scale,
                  const std::vector<lines::Curve>& curves, const std::string& left_out);

}  // namespace pcednet::app
