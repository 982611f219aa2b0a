#pragma once

#include <filesystem>

namespace pcednet::app {

/// The folder that holds the running program.
std::filesystem::path program_folder();

/// Where PROJ's database came with the program, as in the static one, PROJ uses it and no other.
/// Called before anything else reads the environment.
void use_own_proj_database();

}  // namespace pcednet::app
