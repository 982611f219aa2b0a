#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/loaded_cloud.h"

namespace pcednet::io {

/// The names of a label column, and of the three colour columns, in lower case; earlier ones take
/// precedence.
const std::vector<std::string>& label_names();
const std::vector<std::vector<std::string>>& colour_names();

/// Whether the attribute holds one number a point and is called `name` (in lower case) or, as in
/// CloudCompare, scalar_`name`, in any case.
bool is_called(const Attribute& attribute, const std::string& name);

/// The first attribute that is; nullptr if there is none.
const Attribute* find_called(const PointCloud& cloud, const std::string& name);

/// The label that a number of any type denotes: itself if it is whole and in 0 ... 255, kUnlabelled
/// if it is -1 or NaN, otherwise none.
std::optional<std::uint8_t> to_label(double value);

/// The labels of an attribute of one number a point; none if a number denotes no label.
std::optional<std::vector<std::uint8_t>> to_labels(const Attribute& attribute, std::size_t points);

/// Makes the attribute with a label name the labels of `cloud`, if all its values denote labels.
void promote_labels(PointCloud& cloud);

/// Makes attributes with colour names the colours of `cloud`: whole numbers in 0 ... 255 as they
/// are; floating numbers in 0 ... 1 and 16-bit numbers scaled to 8 bits, with a warning if that
/// rounds; the packed rgb or rgba of PCD unpacked (an alpha other than 255 becomes the attribute
/// `alpha`). Beside packed colours 16-bit ones stay attributes.
void promote_colours(PointCloud& cloud, std::vector<std::string>& warnings);

/// Adds columns of red, green and blue, and makes them colours as promote_colours() does.
void add_colours(const std::array<std::vector<double>, 3>& columns, PointCloud& cloud,
                 std::vector<std::string>& warnings);

/// For a text file that declares its positions float but may give them more digits: `declared`,
/// read with the declared type, unless float changes a coordinate beyond 10,000, as in national
/// grids; then the result of `read_wide`, with double positions.
LoadedCloud keep_spelled_digits(LoadedCloud declared,
                                const std::function<LoadedCloud()>& read_wide);

}  // namespace pcednet::io
