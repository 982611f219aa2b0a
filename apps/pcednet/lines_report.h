#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lines_arguments.h"
#include "pcednet/lines/curves/curve.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::app {

/// Says which labels of the file the lines come from.
void tell_labels(const std::string& file, std::span<const std::uint8_t> classes);

/// Keeps the curves that the user asked for, of those that find_lines() kept; says how many each
/// option leaves out, the first of several that do.
std::string filter_lines(const LinesArguments& arguments, const lines::LineScale& scale,
                         std::vector<lines::Curve>& curves);

/// Warns of a tolerance that no segment keeps in the noise of the points.
void warn_of_tolerance(const LinesArguments& arguments, const lines::LineScale& scale);

/// Says what was found and what was left out, by which lengths, and if nothing was found whether
/// points of these classes are of boundaries.
void report_lines(const LinesArguments& arguments, const lines::LineScale& scale,
                  const std::vector<lines::Curve>& curves, const std::string& left_out,
                  std::span<const std::uint8_t> classes);

/// Says what was written, and of DXF whether programs may misplace arcs.
void report_outputs(const LinesArguments& arguments, const std::vector<lines::Curve>& curves);

}  // namespace pcednet::app
