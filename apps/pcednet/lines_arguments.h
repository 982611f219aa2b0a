#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "las_codes.h"
#include "models.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/io/coordinate_system.h"
#include "pcednet/io/drawing/drawing.h"
#include "pcednet/lines/find_lines.h"
#include "view_options.h"

namespace pcednet::app {

/// The arguments of `pcednet lines`.
struct LinesArguments {
  std::string input, memory, las_classification;
  LasCodes codes;  ///< of las_classification, by which labels are read
  PreviewArguments preview;
  std::vector<std::string> outputs, kinds;
  std::vector<std::string> classes = {"sharp", "boundary"};
  bool classify = false;
  ModelArguments model{.name = kDefaultModel};
  detect::PrepareOptions preparation;
  std::vector<double> viewpoint;  ///< of the scanner, if it is told
  lines::LineOptions lines;
  double min_confidence = 0.0, min_dihedral = 0.0;
  std::size_t min_points = 0;
  io::DrawingOptions drawing;
  std::optional<io::CoordinateSystem> crs;  ///< absent: that of the file
  /// Options of some formats that were given, each with the extensions of these.
  std::vector<std::pair<std::string, std::vector<std::string>>> of_formats;
};

/// Adds the options of finding curves.
void add_line_options(CLI::App& command, lines::LineOptions& options);

/// Throws Error(kUsage) for an option of a format that no output is of, or that its version lacks.
void check_format_options(const LinesArguments& arguments);

/// Adds the options of choosing curves and writing them.
void add_drawing_options(CLI::App& command, LinesArguments& arguments);

}  // namespace pcednet::app
