#pragma once

#include <filesystem>

namespace pcednet::app {

/// The folder that holds the running program.
std::filesystem::path program_folder();

/// Makes PROJ use the database shipped with the program, if there is one, as in the static build.
/// Must be called before anything else reads the environment.
void use_own_proj_database();

}  // namespace pcednet::app
