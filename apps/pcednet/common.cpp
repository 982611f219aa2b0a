#include "common.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <memory>
#include <sstream>

#include "pcednet/core/error.h"

namespace pcednet::app {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void on_interrupt(int signal) {
  if (interrupted) std::_Exit(128 + signal);
  interrupted = 1;
}

bool progress_line_open = false;

bool is_point_file(const std::filesystem::path& path) {
  static constexpr std::array kExtensions = {".ply", ".obj", ".xyz", ".txt", ".csv", ".asc",
                                             ".pts", ".pcd", ".las", ".laz", ".e57"};
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

void report_on_terminal(const std::string& stage, double fraction) {
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(fraction * kWidth);
  fmt::print(stderr, "\r{:<14} [{:-<{}}] {:3.0f} %", stage, std::string(filled, '#'), kWidth,
             100 * fraction);
  progress_line_open = fraction < 1.0;
  if (!progress_line_open) fmt::print(stderr, "\n");
  std::fflush(stderr);
}

}  // namespace

void install_signal_handlers() {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &action, nullptr);
  sigaction(SIGPIPE, &action, nullptr);
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
  command->add_option("--threads", common.threads, "Threads to use (0: every core)")
      ->capture_default_str()
      ->check(CLI::Range(0, 4096));
  command->add_option("--progress", common.progress, "Progress on stderr: auto, plain, json, none")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "plain", "json", "none"}));
  command->add_flag("--overwrite", common.overwrite_files, "Replace output files that exist");
  return command;
}

Progress console_progress(const Common& common) {
  Progress progress;
  progress.cancelled = [] { return interrupted != 0; };
  if (common.progress == "json") {
    progress.report = [](const std::string& stage, double fraction) {
      fmt::print(stderr, "{{\"stage\":\"{}\",\"fraction\":{:.3f}}}\n", stage, fraction);
    };
  } else if (common.progress == "plain") {
    auto last = std::make_shared<std::pair<std::string, int>>("", -1);
    progress.report = [last](const std::string& stage, double fraction) {
      const int tenths = static_cast<int>(fraction * 10);
      if (last->first == stage && last->second == tenths) return;
      *last = {stage, tenths};
      fmt::print(stderr, "{} {:.0f} %\n", stage, 100 * fraction);
    };
  } else if (common.progress == "auto" && isatty(STDERR_FILENO) == 1) {
    progress.report = report_on_terminal;
  }
  return progress;
}

void say(const std::string& line) {
  if (progress_line_open) fmt::print(stderr, "\n");
  progress_line_open = false;
  fmt::print(stderr, "{}\n", line);
}

void warn(const std::string& line) {
  say("pcednet: warning: " + line);
}

std::vector<std::filesystem::path> expand_inputs(const std::vector<std::string>& arguments) {
  namespace fs = std::filesystem;
  std::vector<fs::path> inputs;
  for (const std::string& argument : arguments) {
    std::error_code error;
    if (!fs::is_directory(argument, error)) {
      if (!fs::exists(argument, error)) {
        throw Error(ErrorKind::kUnreadable, fmt::format("{}: no such file", argument));
      }
      inputs.emplace_back(argument);
      continue;
    }
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(argument)) {
      if (entry.is_regular_file() && is_point_file(entry.path())) found.push_back(entry.path());
    }
    if (found.empty()) {
      throw Error(ErrorKind::kInsufficient, fmt::format("{}: no point files in it", argument));
    }
    std::sort(found.begin(), found.end());
    inputs.insert(inputs.end(), found.begin(), found.end());
  }
  return inputs;
}

void with_name_in_errors(const std::filesystem::path& file, const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (error.kind() == ErrorKind::kCancelled || message.find(file.string()) != std::string::npos) {
      throw;
    }
    throw Error(error.kind(), fmt::format("{}: {}", file.string(), message));
  }
}

}  // namespace pcednet::app
