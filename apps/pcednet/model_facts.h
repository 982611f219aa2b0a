#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "pcednet/detect/model.h"

namespace pcednet::app {

/// Whether a file is a model by its name.
bool is_model_file(const std::filesystem::path& path);

/// What `info` says of a model, for programs and for people.
nlohmann::ordered_json json_of(const std::filesystem::path& path, const detect::EdgeModel& model);
std::string text_of(const std::filesystem::path& path, const detect::EdgeModel& model);

}  // namespace pcednet::app
