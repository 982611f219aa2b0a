#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "pcednet/core/error.h"

namespace pcednet::app {

/// An input that could not be used, as the user named it, and why.
struct Failure {
  std::string input;
  Error error;
};

/// The point files that arguments name, and the arguments that name none.
struct Inputs {
  std::vector<std::filesystem::path> files;
  std::vector<Failure> failures;

  std::size_t count() const { return files.size() + failures.size(); }
};

/// Finds every input: a folder stands for every point file in it, in name order, a virtual point
/// cloud (.vpc) for the files that it names. What fails is an
/// Error(kUnreadable) for a path that does not exist or a folder that cannot be read,
/// Error(kInsufficient) for a folder without point files.
Inputs find_inputs(const std::vector<std::string>& arguments);

/// The same for work that needs all of them: throws the first failure.
std::vector<std::filesystem::path> expand_inputs(const std::vector<std::string>& arguments);

/// Work on one input after another: one that fails is reported at once and again at the end, and
/// does not cost the user the others. A single input throws as it is.
class Batch {
 public:
  /// Reports what failed to be found. Throws it if there was nothing else to find.
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

/// Runs `work`; an Error from it gets the file's name in front of its message, unless it is there.
/// Memory that runs out becomes an Error(kFailure).
void with_name_in_errors(const std::filesystem::path& file, const std::function<void()>& work);

}  // namespace pcednet::app
