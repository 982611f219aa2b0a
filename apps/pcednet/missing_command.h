#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace pcednet::app {

/// After a parsing that failed: what stands in place of a command, with the command that it may be
/// meant for; empty if no command is missing.
std::string missing_command(const CLI::App& app);

}  // namespace pcednet::app
