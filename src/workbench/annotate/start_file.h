#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace pcednet::annotate {

/// The files of the shipped models by name.
using ShippedModels = std::map<std::string, std::filesystem::path>;

/// The name under which a project keeps the user's model file `file` as a start, the same from
/// every working folder: its path from the project's folder if it is in there, which may then move,
/// otherwise its absolute path, bytes that are not UTF-8 replaced. Never the name of a shipped
/// model.
std::string start_name(const std::filesystem::path& file, const std::filesystem::path& project,
                       const ShippedModels& shipped);

/// Where the file of a start is, or would be. Names of older projects may be relative to the
/// working folder.
std::filesystem::path start_place(const std::string& name, const std::filesystem::path& project,
                                  const ShippedModels& shipped);

/// The same, but throws Error(kUnreadable), naming the project and the model, if it is not there.
std::filesystem::path start_file(const std::string& name, const std::filesystem::path& project,
                                 const ShippedModels& shipped);

}  // namespace pcednet::annotate
