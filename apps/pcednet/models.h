#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace pcednet::app {

/// The shipped models by name, looked for beside the installed program and in the source tree.
std::map<std::string, std::filesystem::path> shipped_models();

/// "cad, scan, worn".
std::string names_of(const std::map<std::string, std::filesystem::path>& models);

/// The file behind `--model`: a file as it is, or the shipped model of that name. Throws
/// Error(kUsage) with the names there are.
std::filesystem::path find_model(const std::string& name_or_file);

}  // namespace pcednet::app
