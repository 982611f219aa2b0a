#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "result_plan.h"

namespace CLI {
class App;
}

namespace pcednet::app {

/// Codes for the LAS field Classification: pairs of a class and its code.
using LasCodes = std::vector<std::pair<std::uint8_t, std::uint8_t>>;

/// Those of --las-classification, comma-separated pairs class=code; there are `classes` classes.
/// Throws Error(kUsage) for others.
LasCodes las_codes(const std::string& pairs, std::size_t classes);

/// Adds --las-classification, which tells how labels are coded in the field Classification.
void add_label_codes_option(CLI::App& command, std::string& pairs);

/// Those of --las-classification for edge classes, to read labels. Throws Error(kUsage) as
/// las_codes(), and if a code stands for two classes.
LasCodes label_codes(const std::string& pairs);

/// Throws Error(kUsage) if an output would keep a point format of its input that cannot hold the
/// codes. Reads only the beginnings of the inputs; those that cannot be read are passed over.
void check_codes_fit(const LasCodes& codes, const std::vector<Job>& jobs);

/// The same for an input that has been read.
void check_codes_fit(const LasCodes& codes, const Job& job, const PointCloud& cloud);

/// Sets the field of the points of these classes; the others keep what they have.
void set_las_codes(const LasCodes& codes, const std::vector<std::uint8_t>& classes,
                   PointCloud& cloud);

}  // namespace pcednet::app
