#include "common.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <memory>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>

#include "number_options.h"
#include "pcednet/core/exists_already.h"
#include "pcednet/core/output_file.h"
#include "pcednet/core/stopwatch.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/formats/virtual_cloud.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::app {
namespace {

// Set by the signal handler, read by every thread.
std::atomic<int> interrupted = 0, ends_at_once = 0;
static_assert(std::atomic<int>::is_always_lock_free);  // or a handler may not use it

[[noreturn]] void end_at_once() {
  constexpr std::string_view kSaid = "pcednet: stopped by the user\n";
  static_cast<void>(!write(STDERR_FILENO, kSaid.data(), kSaid.size()));
  std::_Exit(static_cast<int>(ErrorKind::kCancelled));
}

void on_signal(int signal) {
  // The others may arrive twice by themselves: from a closing terminal and its shell, or from
  // timeout.
  if (interrupted && signal == SIGINT) std::_Exit(128 + signal);
  interrupted = 1;
  if (ends_at_once) end_at_once();
}

/// Whether anybody reads it does not matter: no work is lost with a terminal, or behind `| head`.
void put_on_stderr(const std::string& text) {
  static_cast<void>(std::fputs(text.c_str(), stderr));
}

bool progress_line_open = false;

/// Estimates how long a stage still takes, from its time so far.
class TimeLeft {
 public:
  /// Such as ", 3 min left"; nothing before it can be told.
  std::string text(const std::string& stage, double fraction) {
    if (stage != stage_ || fraction < last_) *this = TimeLeft(stage, fraction);
    last_ = fraction;
    constexpr double kSoonest = 2.0, kLeast = 0.02;
    const double seconds = watch_.elapsed(), done = fraction - first_;
    if (seconds < kSoonest || done < kLeast || fraction >= 1.0) return {};
    const double left = seconds * (1.0 - fraction) / done;
    return left < 100.0 ? fmt::format(", {:.0f} s left", left)
                        : fmt::format(", {:.0f} min left", left / 60.0);
  }

  TimeLeft() = default;

 private:
  TimeLeft(std::string stage, double fraction)
      : stage_(std::move(stage)), first_(fraction), last_(fraction) {}

  std::string stage_ = {};
  double first_ = 0.0, last_ = 0.0;
  Stopwatch watch_ = {};
};

void report_on_terminal(const std::string& stage, double fraction, const std::string& left) {
  constexpr int kWidth = 30;
  constexpr std::size_t kLeftWidth = 14;
  const int filled = static_cast<int>(fraction * kWidth);
  progress_line_open = fraction < 1.0;
  put_on_stderr(fmt::format("\r{:<14} [{:-<{}}] {:3.0f} %{:<{}}{}", stage, std::string(filled, '#'),
                            kWidth, 100 * fraction, left, kLeftWidth,
                            progress_line_open ? "" : "\n"));
  std::fflush(stderr);
}

}  // namespace

void install_signal_handlers() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction inherited = {};
  sigaction(SIGHUP, nullptr, &inherited);
  if (inherited.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // ignored under nohup
  action.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &action, nullptr);
  sigaction(SIGPIPE, &action, nullptr);
  action.sa_handler = SIG_DFL;  // ignored, as some parents leave it, it hides how children end
  sigaction(SIGCHLD, &action, nullptr);
}

EndsAtOnce::EndsAtOnce() {
  ends_at_once = 1;
  if (interrupted) end_at_once();
}

EndsAtOnce::~EndsAtOnce() {
  ends_at_once = 0;
}

io::LoadedCloud read_whole(const std::filesystem::path& file) {
  const EndsAtOnce reading;
  return formats::read_cloud(file);
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  const std::string text = command->get_description();
  std::ostringstream line;
  CLI::detail::format_help(line, command->get_name(), text.substr(0, text.find('\n')),
                           column_width_);
  return line.str();
}

CLI::App* add_command(CLI::App& app, Common& common, const std::string& name,
                      const std::string& description, const std::string& examples) {
  std::string text = description + "\n\nExamples:\n";
  std::istringstream lines(examples);
  for (std::string line; std::getline(lines, line);) text += "  " + line + "\n";
  CLI::App* command = app.add_subcommand(name, text);
  command->add_option("--threads", common.threads, "Threads (0: all cores)")
      ->capture_default_str()
      ->transform(whole_number(0, 4096));
  command->add_option("--progress", common.progress, "Progress on stderr: auto, plain, json, none")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "plain", "json", "none"}));
  command->add_flag("--overwrite", common.overwrite_files, "Replace existing output files");
  return command;
}

Progress console_progress(const Common& common) {
  Progress progress;
  progress.cancelled = [] { return interrupted != 0; };
  const auto time = std::make_shared<TimeLeft>();
  if (common.progress == "json") {
    progress.report = [](const std::string& stage, double fraction) {
      put_on_stderr(fmt::format("{{\"stage\":\"{}\",\"fraction\":{:.3f}}}\n", stage, fraction));
    };
  } else if (common.progress == "plain") {
    auto last = std::make_shared<std::pair<std::string, int>>("", -1);
    progress.report = [last, time](const std::string& stage, double fraction) {
      const std::string left = time->text(stage, fraction);
      const int tenths = static_cast<int>(fraction * 10);
      if (last->first == stage && last->second == tenths) return;
      *last = {stage, tenths};
      put_on_stderr(fmt::format("{} {:.0f} %{}\n", stage, 100 * fraction, left));
    };
  } else if (common.progress == "auto" && isatty(STDERR_FILENO) == 1) {
    progress.report = [time](const std::string& stage, double fraction) {
      report_on_terminal(stage, fraction, time->text(stage, fraction));
    };
  }
  return progress;
}

void check_ascii(bool ascii, const std::vector<std::filesystem::path>& outputs) {
  const auto has_both = [](const std::filesystem::path& output) {
    const std::string extension = io::extension_of(output);
    return extension == ".ply" || extension == ".pcd";
  };
  if (!ascii || outputs.empty() || std::any_of(outputs.begin(), outputs.end(), has_both)) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("{}: --ascii is for .ply and .pcd files, and none is an output",
                          outputs.front().string()));
}

void check_one_cloud(const char* command, const std::string& input) {
  std::error_code ignored;
  const char* const what = std::filesystem::is_directory(input, ignored) ? "is a folder"
                           : formats::is_virtual_cloud(input)            ? "names other files"
                                                                         : nullptr;
  if (!what) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("{}: {}; {} takes one cloud: give its files one by one, or make one of "
                          "them with pcednet tiles plan, run and join",
                          input, what, command));
}

void check_distinct(const std::vector<std::filesystem::path>& outputs) {
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& output : outputs) {
    if (output.empty() || seen.insert(output.lexically_normal()).second) continue;
    throw Error(ErrorKind::kUsage, output.string() + ": named twice");
  }
}

std::string explain(const Error& error) {
  const bool exists = dynamic_cast<const ExistsAlready*>(&error) != nullptr;
  return std::string(error.what()) + (exists ? "; give --overwrite to replace it" : "");
}

void say(const std::string& line) {
  std::fflush(stdout);  // both may go to one file
  put_on_stderr((progress_line_open ? "\n" : "") + line + "\n");
  progress_line_open = false;
}

void say_error(const std::string& line) {
  say("pcednet: " + line);
}

void warn(const std::string& line) {
  say_error("warning: " + line);
}

void warn_all(const std::filesystem::path& file, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) warn(file.string() + ": " + warning);
}

void warn_of_losses(const std::string& output, const std::vector<std::string>& losses) {
  for (const std::string& loss : losses) warn(output + " does not keep: " + loss);
}

namespace fs = std::filesystem;

MadeFolder::MadeFolder(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code ignored;
  fs::path missing = fs::absolute(folder).lexically_normal();
  if (!missing.has_filename()) missing = missing.parent_path();  // "out/"
  for (; !fs::exists(missing, ignored); missing = missing.parent_path()) made_.push_back(missing);
  make_folder(folder);
}

MadeFolder::~MadeFolder() {
  std::error_code ignored;
  for (const fs::path& folder : made_) fs::remove(folder, ignored);  // not if it holds something
}

}  // namespace pcednet::app
