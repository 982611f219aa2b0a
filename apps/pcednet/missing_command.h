#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace pcednet::app {

/// After a parsing that failed: what stands in place of a command, with the command that it may be
/// meant for; empty if no command is missing.
std::string missing_command(const CLI::App& app);

/// After a parsing that failed: the option that there is not, with the one that it may be meant
/// for; empty if the first word that was not expected is no option.
std::string unknown_option(const CLI::App& app);

/// After a parsing that failed: the first word that is one input too many; empty if the command
/// takes several.
std::string surplus_input(const CLI::App& app);

}  // namespace pcednet::app
