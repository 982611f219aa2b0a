// Eigen must come before httplib.h, which includes <resolv.h> and with it a macro named _res.
#include "http_server.h"

#include <httplib.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <string>
#include <thread>

#include "pcednet/core/error.h"

namespace pcednet::app {
namespace {

constexpr std::size_t kThreads = 32;
constexpr int kMostStreams = 12;  // windows that listen: the other threads stay free for requests

annotate::Request request_of(const httplib::Request& request) {
  annotate::Request result{.method = request.method, .path = request.path, .body = request.body};
  for (const auto& [name, value] : request.params) result.query.emplace(name, value);
  for (const auto& [name, value] : request.headers) {
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    result.headers.emplace(lower, value);
  }
  return result;
}

void fill(httplib::Response& response, annotate::Response answer) {
  response.status = answer.status;
  for (const auto& [name, value] : answer.headers) response.set_header(name, value);
  response.set_content(std::move(answer.body), answer.type);
}

/// A body must say its length, so that too long a one is refused before it is read.
bool says_its_length(const httplib::Request& request) {
  return request.method == "GET" ||
         (request.has_header("Content-Length") && !request.has_header("Transfer-Encoding"));
}

}  // namespace

struct HttpServer::Impl {
  httplib::Server server = {};
  int port = 0;
  std::thread thread = {};
  std::atomic<bool> ended = false;
  std::atomic<int> streams = 0;
  annotate::Events* events = nullptr;

  void stream_events(httplib::Response& response);
};

HttpServer::HttpServer(int port) : impl_(std::make_unique<Impl>()) {
  httplib::Server& server = impl_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_payload_max_length(annotate::kMostBodyBytes);
  server.set_read_timeout(5);
  server.set_write_timeout(10);
  server.set_keep_alive_timeout(3);
  server.set_keep_alive_max_count(1000);
  server.set_tcp_nodelay(true);
  // The library's own choice, SO_REUSEPORT, would let two programs share a port.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  if (port == 0) {
    impl_->port = server.bind_to_any_port("127.0.0.1");
  } else if (server.bind_to_port("127.0.0.1", port)) {
    impl_->port = port;
  }
  if (impl_->port <= 0) {
    throw Error(ErrorKind::kFailure, "port " + std::to_string(port) + " of 127.0.0.1 is taken");
  }
}

HttpServer::~HttpServer() {
  if (impl_->events) impl_->events->close();
  impl_->server.stop();
  if (impl_->thread.joinable()) impl_->thread.join();
}

int HttpServer::port() const {
  return impl_->port;
}

void HttpServer::Impl::stream_events(httplib::Response& response) {
  if (++streams > kMostStreams) {
    --streams;
    fill(response, annotate::error_response(409, "too many windows are open"));
    return;
  }
  response.set_chunked_content_provider(
      "text/event-stream",
      [this, next = events->end(), quiet = 0](std::size_t, httplib::DataSink& sink) mutable {
        std::string text = next == 0 && quiet == 0 ? ": welcome\n\n" : "";
        std::string news;
        if (!events->take(next, std::chrono::milliseconds(500), news)) return false;
        text += news;
        // A line now and then shows whether the window is still there.
        quiet = text.empty() ? quiet + 1 : 1;
        if (quiet % 10 == 0) text = ": still here\n\n";
        return text.empty() || sink.write(text.data(), text.size());
      },
      [this](bool) { --streams; });
}

void HttpServer::start(annotate::Api& api, annotate::Events& events, std::string_view page) {
  impl_->events = &events;
  httplib::Server& server = impl_->server;
  server.set_default_headers({{"Cache-Control", "no-store"},
                              {"X-Content-Type-Options", "nosniff"},
                              {"X-Frame-Options", "DENY"},
                              {"Referrer-Policy", "no-referrer"}});
  server.set_pre_routing_handler([&api](const auto& request, auto& response) {
    auto refused = api.refuse(request_of(request));
    if (!refused && !says_its_length(request)) {
      refused = annotate::error_response(400, "Content-Length is missing");
    }
    if (!refused) return httplib::Server::HandlerResponse::Unhandled;
    // What is left of its body must not be taken for the next request.
    response.set_header("Connection", "close");
    fill(response, std::move(*refused));
    return httplib::Server::HandlerResponse::Handled;
  });
  server.set_error_handler([](const auto&, auto& response) {
    if (!response.body.empty()) return;
    const int status = response.status;
    fill(response, annotate::error_response(status, status == 413 ? "at most 8 MiB are taken"
                                                                  : "this cannot be answered"));
  });
  const auto show_page = [page](const auto&, auto& response) {
    response.set_content(page.data(), page.size(), "text/html; charset=utf-8");
  };
  server.Get("/", show_page);
  server.Get("/api/events",
             [impl = impl_.get()](const auto&, auto& response) { impl->stream_events(response); });
  const auto answer = [&api](const auto& request, auto& response) {
    fill(response, api.handle(request_of(request)));
  };
  server.Get("/api/.*", answer);
  server.Post("/api/.*", answer);
  impl_->thread = std::thread([impl = impl_.get()] {
    impl->server.listen_after_bind();
    impl->ended = true;
  });
  // Told to stop before it runs, the library would not hear it.
  while (!server.is_running() && !impl_->ended) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace pcednet::app
