#pragma once

#include <filesystem>
#include <string>

namespace pcednet::app {

/// The file behind `--model`: a file as it is, or the shipped model of that name, looked for beside
/// the installed program and in the source tree. Throws Error(kUsage) with the names there are.
std::filesystem::path find_model(const std::string& name_or_file);

}  // namespace pcednet::app
