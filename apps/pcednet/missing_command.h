#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace pcednet::app {

/// The message of an error of usage, in better words than the parser's where there are any: what
/// stands in place of a command, an option that there is not, each with the one that it may be
/// meant for, or an input too many.
std::string why_refused(const CLI::ParseError& error, const CLI::App& app);

}  // namespace pcednet::app
