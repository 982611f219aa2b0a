#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "workbench/annotate/project/project.h"

namespace pcednet::annotate {

/// The file of input `number` (from 0) of those that `project` knows, at its place from `folder`,
/// that of the first. Throws Error(kUnreadable), naming the project, the file and what to do, if it
/// is not there.
std::filesystem::path place_of_input(const std::filesystem::path& project,
                                     std::span<const InputIdentity> known, std::size_t number,
                                     const std::filesystem::path& folder);

/// Throws Error(kInsufficient), naming `file`, which is of the inputs `known`, the first that
/// differs and what to do, unless `inputs` begins with the same files; others may follow, and names
/// may differ.
void check_known(const std::filesystem::path& file, std::span<const InputIdentity> known,
                 std::span<const InputIdentity> inputs);

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
