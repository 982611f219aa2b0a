#pragma once

#include <filesystem>
#include <string>

#include "pcednet/core/json.h"
#include "pcednet/detect/model.h"

namespace pcednet::app {

/// Whether the file name is that of a model.
bool is_model_file(const std::filesystem::path& path);

/// The output of `info` for a model, for programs and for people.
OrderedJson json_of(const std::filesystem::path& path, const detect::EdgeModel& model);
std::string text_of(const std::filesystem::path& path, const detect::EdgeModel& model);

}  // namespace pcednet::app
