#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace pcednet::annotate {

/// A request without its socket.
struct Request {
  std::string method = "GET", path = {};
  std::map<std::string, std::string> query = {};
  std::map<std::string, std::string> headers = {};  ///< names in lower case
  std::string body = {};
  /// The length of the body that the head announces; none if it does not.
  std::optional<std::uint64_t> announced = 0;
};

struct Response {
  int status = 200;
  std::string type = "application/json";
  std::string body = {};
  std::map<std::string, std::string> headers = {};
};

}  // namespace pcednet::annotate
