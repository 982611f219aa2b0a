#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "workbench/annotate/page/http.h"
#include "workbench/annotate/page/windows.h"
#include "workbench/annotate/session.h"

namespace pcednet::annotate {

/// Whether the `Host` of a request is this machine at `port`, as 127.0.0.1:8080; browsers leave out
/// port 80.
bool is_own_host(std::string_view host, int port);

/// The requests of docs/annotate.md. May be called from many threads.
class Api {
 public:
  /// `port` is the port of the requests. Everything must outlive the Api.
  Api(Session& session, Events& events, std::string token, int port);

  /// The reason not even to read the body of a request: it is for another host, or comes from a
  /// page of another origin, or lacks the token, or has an unknown path, or its body is too long or
  /// of unknown length. / is the page; everything else is under /api.
  std::optional<Response> refuse(const Request& request) const;

  /// The answer to any request under /api except /api/events.
  Response handle(const Request& request);

  /// What a stream of events tells of the window that it is for; the last, some time after its end.
  void begin_listening(const std::string& window) { windows_.begin_listening(window); }
  void end_listening(const std::string& window) { windows_.end_listening(window); }
  void close_silent(const std::string& window);

  /// Whether a page has loaded and asked for a window name.
  bool was_opened() const { return windows_.was_any_opened(); }

 private:
  Session& session_;
  Events& events_;
  Windows windows_ = {};
  std::string token_;
  int port_;
};

}  // namespace pcednet::annotate
