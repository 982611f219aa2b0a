#pragma once

#include <CLI/CLI.hpp>

#include <string>

#include "pcednet/core/output_file.h"
#include "pcednet/core/progress.h"
#include "pcednet/gls/scale_space_options.h"

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

/// Adds --s-min and --s-max. `options` must outlive the parsing.
void add_scale_range_options(CLI::App& command, gls::ScaleSpaceOptions& options);

/// Progress on stderr in the form the user asked for, and a signal as its cancellation.
Progress console_progress(const Common& common);

/// Makes SIGINT (Ctrl-C), SIGTERM and SIGHUP (a terminal that closes; not under nohup) a request to
/// stop that console_progress hands on; a second SIGINT ends the program at once. A file that grows
/// beyond its limit, or a reader that goes away, is an error to report, not a signal to die of.
void install_signal_handlers();

/// One line on stderr, after whatever progress line is there.
void say(const std::string& line);

/// The same, as "pcednet: warning: ...".
void warn(const std::string& line);

}  // namespace pcednet::app
