#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace pcednet {

/// The kind of an error, which is also the exit code of the command line.
enum class ErrorKind {
  kFailure = 1,        ///< anything else: disk full, no memory, internal limits
  kUsage = 2,          ///< the request itself is wrong
  kUnreadable = 3,     ///< an input cannot be read: missing, truncated, not of the format it claims
  kInsufficient = 4,   ///< an input was read but lacks points, normals or labels
  kModelMismatch = 5,  ///< a model file is damaged, foreign, or does not fit the request
  kCancelled = 130,    ///< the user stopped the work
};

/// The one exception of the library. The message names the file and the place in it.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

/// Runs `work`; the message of an Error from it gets "name: " in front, unless it is kCancelled.
template <typename Work>
void with_name_in_errors(std::string_view name, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kCancelled) throw;
    throw Error(error.kind(), std::string(name) + ": " + error.what());
  }
}

}  // namespace pcednet
