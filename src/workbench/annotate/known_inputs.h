#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "workbench/annotate/project.h"

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

}  // namespace pcednet::annotate
