#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "pcednet/core/output_file.h"
#include "pcednet/core/progress.h"

namespace pcednet::app {

/// Options that every subcommand takes.
struct Common {
  int threads = 0;
  std::string progress = "auto";
  bool overwrite_files = false;

  Overwrite overwrite() const { return overwrite_files ? Overwrite::kYes : Overwrite::kNo; }
};

/// Lists a subcommand by the first line of its description alone.
struct HelpFormatter : CLI::Formatter {
  std::string make_subcommand(const CLI::App* command) const override;
};

/// Adds a subcommand whose help shows `examples` (one command a line) before its options, with the
/// common options. `common` must outlive the parsing.
CLI::App* add_command(CLI::App& app, Common& common, const std::string& name,
                      const std::string& description, const std::string& examples);

/// Progress on stderr in the form the user asked for, and Ctrl-C as its cancellation.
Progress console_progress(const Common& common);

/// Makes Ctrl-C (SIGINT, SIGTERM) a request to stop that console_progress hands on; a second one
/// ends the program at once. A file that grows beyond its limit, or a reader that goes away, is an
/// error to report, not a signal to die of.
void install_signal_handlers();

/// One line on stderr, after whatever progress line is there.
void say(const std::string& line);

/// The same, as "pcednet: warning: ...".
void warn(const std::string& line);

/// The point files that the arguments name: a folder stands for every point file in it, in name
/// order. Throws Error(kUnreadable) for a path that does not exist, Error(kInsufficient) for a
/// folder without point files.
std::vector<std::filesystem::path> expand_inputs(const std::vector<std::string>& arguments);

/// Runs `work`; an Error from it gets the file's name in front of its message, unless it is there.
void with_name_in_errors(const std::filesystem::path& file, const std::function<void()>& work);

}  // namespace pcednet::app
