#pragma once

#include <CLI/CLI.hpp>

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pcednet/core/error.h"
#include "pcednet/core/output_file.h"
#include "pcednet/core/progress.h"
#include "pcednet/io/loaded_cloud.h"

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

/// The values of an option, by name.
template <typename Value>
using Choices = std::vector<std::pair<std::string, Value>>;

/// Adds an option that sets `value`, which must outlive the parsing, to one of the choices.
template <typename Value>
CLI::Option* add_choice(CLI::App& command, const std::string& option, Value& value,
                        const Choices<Value>& choices, const std::string& help) {
  std::vector<std::string> names;
  std::string preset;
  for (const auto& [name, choice] : choices) {
    names.push_back(name);
    if (choice == value) preset = name;
  }
  const auto choose = [&value, choices](const std::string& wanted) {
    for (const auto& [name, choice] : choices) {
      if (name == wanted) value = choice;
    }
  };
  return command.add_option_function<std::string>(option, choose, help)
      ->default_str(preset)
      ->check(CLI::IsMember(names));
}

/// The same for a table of names.
template <typename Value, std::size_t kCount>
CLI::Option* add_choice(CLI::App& command, const std::string& option, Value& value,
                        const std::array<std::pair<std::string_view, Value>, kCount>& names,
                        const std::string& help) {
  return add_choice(command, option, value, Choices<Value>(names.begin(), names.end()), help);
}

/// Progress on stderr in the form the user chose; a signal cancels.
Progress console_progress(const Common& common);

/// Makes SIGINT (Ctrl-C), SIGTERM and SIGHUP (a closing terminal; not under nohup) a request to
/// stop, which console_progress() passes on; a second SIGINT ends the program at once. SIGXFSZ and
/// SIGPIPE are ignored so that they surface as write errors; SIGCHLD is not, whatever the parent
/// ignored.
void install_signal_handlers();

/// Makes a signal that is a request to stop end the program at once, with the exit code of a stop:
/// for work that cannot be interrupted, where nothing is written.
class EndsAtOnce {
 public:
  EndsAtOnce();
  EndsAtOnce(const EndsAtOnce&) = delete;
  EndsAtOnce& operator=(const EndsAtOnce&) = delete;
  ~EndsAtOnce();
};

/// formats::read_cloud() that a signal ends at once, for commands that have written nothing yet.
io::LoadedCloud read_whole(const std::filesystem::path& file);

/// Throws Error(kUsage) if none of the outputs, of which there are some, is .ply or .pcd: the
/// others have no --ascii.
void check_ascii(bool ascii, const std::vector<std::filesystem::path>& outputs);

/// Throws Error(kUsage) if the input of `command`, which takes one cloud, is a folder or a list of
/// files.
void check_one_cloud(const char* command, const std::string& input);

/// Throws Error(kUsage) if two of the outputs, of which some may be empty, are one file.
void check_distinct(const std::vector<std::filesystem::path>& outputs);

/// The message of an error, with the option that avoids it.
std::string explain(const Error& error);

/// One line on stderr, after any progress line.
void say(const std::string& line);

/// The same, as "pcednet: ..." and as "pcednet: warning: ...".
void say_error(const std::string& line);
void warn(const std::string& line);

/// Warns of each of a file's warnings.
void warn_all(const std::filesystem::path& file, const std::vector<std::string>& warnings);

/// Warns of each thing that the format of `output` cannot hold.
void warn_of_losses(const std::string& output, const std::vector<std::string>& losses);

/// A folder for results, with its missing parents. Unless keep() is called, those that it made and
/// that are still empty go with it: a command that is refused leaves none behind.
class MadeFolder {
 public:
  /// Throws as make_folder() does. An empty path makes nothing.
  explicit MadeFolder(const std::filesystem::path& folder);
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;
  ~MadeFolder();

  void keep() { made_.clear(); }

 private:
  std::vector<std::filesystem::path> made_;  ///< the deepest first
};

}  // namespace pcednet::app
