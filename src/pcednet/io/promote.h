#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/loaded_cloud.h"

namespace pcednet::io {

/// The names of a label column, and of the three colour columns, in lower case; earlier ones win.
const std::vector<std::string>& label_names();
const std::vector<std::vector<std::string>>& colour_names();

/// The label that a number of any type means: itself if it is whole and in 0 ... 255, kUnlabelled
/// if it is -1 or NaN, otherwise none.
std::optional<std::uint8_t> to_label(double value);

/// Makes the attribute named as labels the labels of `cloud`, if all its values mean labels.
void promote_labels(PointCloud& cloud);

/// Makes attributes named as colours the colours of `cloud`: whole numbers in 0 ... 255 as they
/// are; floating numbers in 0 ... 1 and 16-bit numbers scaled to 8 bits, with a warning if that
/// rounds; the packed rgb or rgba of PCD taken apart (an alpha other than 255 stays as attribute
/// `alpha`).
void promote_colours(PointCloud& cloud, std::vector<std::string>& warnings);

/// For a text file that calls its positions float but may spell them with more digits: `declared`,
/// read as the file says, unless a float moves a coordinate beyond 10,000, as in national grids;
/// then what `read_wide` reads with double positions.
LoadedCloud keep_spelled_digits(LoadedCloud declared,
                                const std::function<LoadedCloud()>& read_wide);

}  // namespace pcednet::io
