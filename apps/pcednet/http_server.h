#pragma once

#include <memory>
#include <string_view>

#include "workbench/annotate/page/api.h"

namespace pcednet::app {

/// Accepts requests on 127.0.0.1 only and passes those with the token to an Api. Connections
/// without the token can fill neither its threads nor its memory: there are at most 100, the oldest
/// of which makes room for a new one, and each has five seconds for a request and its answer.
class HttpServer {
 public:
  /// `port` 0 is any free one. Throws Error(kFailure) if it is not available.
  explicit HttpServer(int port);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;

  /// Answers, on its own threads, until destroyed. `page` is the content of /. All must outlive it.
  void start(annotate::Api& api, annotate::Events& events, std::string_view page);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pcednet::app
