#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "workbench/annotate/events.h"
#include "workbench/annotate/session.h"

namespace pcednet::annotate {

inline constexpr std::size_t kMostBodyBytes = std::size_t{8} << 20;

/// A request without its socket.
struct Request {
  std::string method = "GET", path = {};
  std::map<std::string, std::string> query = {};
  std::map<std::string, std::string> headers = {};  ///< names in lower case
  std::string body = {};
};

struct Response {
  int status = 200;
  std::string type = "application/json";
  std::string body = {};
  std::map<std::string, std::string> headers = {};
};

/// An answer that tells of an error: {"error": message}.
Response error_response(int status, const std::string& message);

/// The requests of docs/annotate.md. May be called from many threads.
class Api {
 public:
  /// `port` is where the requests come in. Everything must outlive the Api.
  Api(Session& session, Events& events, std::string token, int port);

  /// What a request without the right to be answered gets: 403 for a Host or an Origin that are not
  /// our own, or under /api without the token. To be asked before the body is read.
  std::optional<Response> refuse(const Request& request) const;

  /// The answer to any request under /api but /api/events.
  Response handle(const Request& request);

  /// Whether a page has come so far as to ask for a window's name.
  bool was_opened() const;

 private:
  Response get(const Request& request);
  Response post(const Request& request);
  Response open_window();
  Response take_over(const std::string& window);
  bool is_writer(const Request& request) const;
  Response save(const Request& request);
  Response download(const std::string& what) const;
  Response values(const Request& request, const std::vector<std::size_t>& nodes) const;
  Response pick(const Request& request) const;

  Session& session_;
  Events& events_;
  std::string token_;
  int port_;
  mutable std::mutex mutex_;
  std::string writer_;
  int windows_ = 0;
};

}  // namespace pcednet::annotate
