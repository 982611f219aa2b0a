#include "missing_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <numeric>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace pcednet::app {
namespace {

/// The number of letters to insert, delete or replace (Levenshtein).
std::size_t changes_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

/// Asks whether the first of the names was meant that differs least from `word`, in one letter or
/// in one of three; empty if none does.
std::string question(const std::string& word, const std::vector<std::string>& names,
                     const std::string& before = "") {
  std::string nearest;
  std::size_t fewest = std::max<std::size_t>(word.size() / 3, 1) + 1;
  for (const std::string& name : names) {
    const std::size_t changes = changes_between(word, name);
    if (changes >= fewest) continue;
    fewest = changes;
    nearest = name;
  }
  return nearest.empty() ? "" : fmt::format("; did you mean {}{}?", before, nearest);
}

std::vector<std::string> commands_of(const CLI::App& parent) {
  std::vector<std::string> names;
  for (const CLI::App* command : parent.get_subcommands(std::function<bool(const CLI::App*)>())) {
    names.push_back(command->get_name());
  }
  return names;
}

/// The command that was given last.
const CLI::App* last_command(const CLI::App& app) {
  const CLI::App* last = &app;
  while (!last->get_subcommands().empty()) last = last->get_subcommands().front();
  return last;
}

/// The option that there is not; empty if the first word that was not expected is no option.
std::string unknown_option(const CLI::App& app) {
  const CLI::App* last = last_command(app);
  const std::vector<std::string> words = last->remaining();
  if (words.empty() || !words.front().starts_with('-')) return "";
  const std::string option = words.front().substr(0, words.front().find('='));
  std::vector<std::string> names;
  for (const CLI::Option* one : last->get_options()) {
    if (!one->get_lnames().empty()) names.push_back("--" + one->get_lnames().front());
  }
  std::error_code ignored;
  const bool is_file = std::filesystem::exists(words.front(), ignored);
  return fmt::format("there is no option {} of {}{}", option, last->get_name(),
                     is_file ? fmt::format("; the file of this name is ./{}", words.front())
                             : question(option, names));
}

/// The first word that is one input too many; empty if the command takes several.
std::string surplus_input(const CLI::App& app) {
  const CLI::App* last = last_command(app);
  const std::vector<std::string> words = last->remaining();
  if (words.empty()) return "";
  for (const CLI::Option* one : last->get_options()) {
    if (!one->get_positional() || one->get_expected_max() != 1) continue;
    return fmt::format("{} takes one {}; not expected: {}", last->get_name(), one->get_name(true),
                       words.front());
  }
  return "";
}

/// What the command needs and did not get; empty if only an option is missing.
std::string missing_input(const CLI::App& app) {
  const CLI::App* last = last_command(app);
  for (const CLI::Option* one : last->get_options()) {
    if (!one->get_positional() || !one->get_required() || one->count() > 0) continue;
    const std::string name = one->get_name(true);
    const std::string_view article = one->get_expected_max() != 1 ? "one or more"
                                     : name.starts_with('i')      ? "an"
                                                                  : "a";
    return fmt::format("{} needs {} {}", last->get_name(), article, name);
  }
  return "";
}

/// What stands in place of a command; empty if no command is missing.
std::string missing_command(const CLI::App& app) {
  const CLI::App* last = last_command(app);
  if (last->get_require_subcommand_min() == 0) return "";
  const std::string after = last == &app ? "" : last->get_name() + " ";
  const std::vector<std::string> words = last->remaining();
  if (words.empty()) {
    return last == &app ? "a command is missing"
                        : fmt::format("{} needs a command", last->get_name());
  }
  const std::string& word = words.front();
  if (word.starts_with('-')) return fmt::format("a command is missing before the option {}", word);
  return fmt::format("there is no command {}{}{}", after, word,
                     question(word, commands_of(*last), after));
}

}  // namespace

std::string why_refused(const CLI::ParseError& error, const CLI::App& app) {
  const bool lacks = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError);
  const bool has_more = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  std::string why = lacks ? missing_command(app) : "";
  if (why.empty() && (lacks || has_more)) why = unknown_option(app);
  if (why.empty() && has_more) why = surplus_input(app);
  if (why.empty() && lacks) why = missing_input(app);
  return why.empty() ? error.what() : why;
}

}  // namespace pcednet::app
