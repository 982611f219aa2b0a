#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace pcednet::app {

/// A port of 127.0.0.1 and what opens it.
struct Address {
  int port = 0;
  std::string token = {};
};

/// Where a project was reached last, in a file beside it that only this user can read: a page that
/// is still open then finds a new start of the program. Where no such file can be had, nothing is
/// kept, and a new start has another address.
class KeptAddress {
 public:
  explicit KeptAddress(const std::filesystem::path& project);

  /// The address, if the program was there in the last twelve hours.
  std::optional<Address> read() const;

  void write(const Address& address) const;

  /// The program is still there.
  void touch() const;

 private:
  std::filesystem::path path_;
};

}  // namespace pcednet::app
