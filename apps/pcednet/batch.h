#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pcednet/core/error.h"

namespace pcednet::app {

/// An input that could not be used, as the user named it, and the reason.
struct Failure {
  std::string input;
  Error error;
};

/// The point files that arguments name, and the arguments that name none.
struct Inputs {
  std::vector<std::filesystem::path> files;
  std::vector<Failure> failures;
  std::vector<std::filesystem::path> passed_over;  ///< texts in folders that are no points

  std::size_t count() const { return files.size() + failures.size(); }
};

/// Finds every input: a folder contributes every point file in it, in name order, but no .stl and
/// no .txt, .csv or .asc that does not begin like points; a virtual point cloud (.vpc) the files
/// that it names. A file that is named twice counts once. A failure is an Error(kUnreadable) for a
/// path that does not exist or a folder that cannot be read, Error(kInsufficient) for a folder
/// without point files.
Inputs find_inputs(const std::vector<std::string>& arguments);

/// The same for work that needs all of them: throws the first failure, and warns of files that are
/// passed over.
std::vector<std::filesystem::path> expand_inputs(const std::vector<std::string>& arguments);

/// check_not_input() for all inputs that the arguments name, and for the arguments themselves.
void check_not_inputs(const std::filesystem::path& output,
                      const std::vector<std::string>& arguments);

/// Work on one input after another: a failure is reported at once and again at the end, and does
/// not stop the others. With a single input, its error is thrown unchanged.
class Batch {
 public:
  /// Warns of files that are passed over, and reports inputs that were not found. Throws if none
  /// was found.
  explicit Batch(const Inputs& inputs);

  /// Does `work`, whose errors get the file's name; true if it succeeded. Throws Error(kCancelled).
  bool run(const std::filesystem::path& file, const std::function<void()>& work);

  const std::vector<Failure>& failures() const { return failures_; }

  /// Throws an Error of the first failure's kind that names all inputs that failed, if any did.
  void finish() const;

 private:
  void add(const Failure& failure);

  std::size_t inputs_;
  std::vector<Failure> failures_;
};

/// Runs `work`; the message of an Error from it gets the file's name as a prefix, unless it has it.
/// Lack of memory becomes an Error(kFailure).
void with_name_in_errors(const std::filesystem::path& file, const std::function<void()>& work);

/// Two files of the LAS, LAZ and COPC files among these that lie side by side, seen from above, as
/// the tiles of a survey do: their boxes touch or overlap at the edge. None if there are none.
/// Reads headers only, and passes over files that it cannot read.
std::optional<std::pair<std::filesystem::path, std::filesystem::path>> find_adjoining(
    std::span<const std::filesystem::path> files);

}  // namespace pcednet::app
