#pragma once

#include <memory>
#include <string_view>

#include "workbench/annotate/api.h"

namespace pcednet::app {

/// Takes requests on 127.0.0.1 alone and hands those with the token to an Api. Connections that do
/// not show it can neither fill its threads nor its memory: they are at most 100, of which the
/// oldest makes room for a new one, and have five seconds for a request and its answer.
class HttpServer {
 public:
  /// `port` 0 is any free one. Throws Error(kFailure) if it cannot be had.
  explicit HttpServer(int port);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;

  /// Answers, on threads of its own, until destroyed. `page` is what / shows. All must outlive it.
  void start(annotate::Api& api, annotate::Events& events, std::string_view page);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pcednet::app
