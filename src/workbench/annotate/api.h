#pragma once

#include <optional>
#include <string>

#include "workbench/annotate/events.h"
#include "workbench/annotate/http.h"
#include "workbench/annotate/session.h"
#include "workbench/annotate/windows.h"

namespace pcednet::annotate {

/// The requests of docs/annotate.md. May be called from many threads.
class Api {
 public:
  /// `port` is where the requests come in. Everything must outlive the Api.
  Api(Session& session, Events& events, std::string token, int port);

  /// Why the body of a request is not even to be read: it is for another host, or comes from the
  /// page of another origin, or lacks the token, or nothing is at its path, or its body is too long
  /// or of unknown length. / is the page; everything else is under /api.
  std::optional<Response> refuse(const Request& request) const;

  /// The answer to any request under /api but /api/events.
  Response handle(const Request& request);

  /// Whether a page has come so far as to ask for a window's name.
  bool was_opened() const { return windows_.was_any_opened(); }

 private:
  Session& session_;
  Events& events_;
  Windows windows_ = {};
  std::string token_;
  int port_;
};

}  // namespace pcednet::annotate
