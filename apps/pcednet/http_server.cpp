#include "http_server.h"

#include <utility>

// Boost 1.74 leaves <utility> to its users.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "pcednet/core/error.h"
#include "pcednet/io/column_names.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::app {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::use_awaitable;
using std::chrono::seconds;
using tcp = asio::ip::tcp;
using Parser = http::request_parser<http::string_body>;

constexpr std::size_t kWorkers = 8;          // threads that compute answers
constexpr std::size_t kMostStrangers = 100;  // connections that have not shown the token
constexpr std::uint32_t kMostHeadBytes = 16 << 10;
constexpr seconds kStrangerTime{5};  // for a request without the token and its answer
constexpr seconds kRequestTime{60};  // for a request with the token, idle time included
constexpr seconds kEventTime{10};    // for a window to receive its events
constexpr seconds kQuietTime{5};     // between keep-alive messages of the event stream
constexpr seconds kSilentTime{3};    // for a window whose stream has ended to open another

/// Resolves escapes such as %41, and + to a space.
std::string decoded(std::string_view text) {
  std::string spaced(text);
  std::replace(spaced.begin(), spaced.end(), '+', ' ');
  return io::percent_decoded(spaced);
}

std::string_view view_of(beast::string_view text) {
  return {text.data(), text.size()};
}

annotate::Request request_of(const Parser& parser) {
  const auto& head = parser.get();
  std::string_view target = view_of(head.target());
  const std::size_t question = std::min(target.find('?'), target.size());
  annotate::Request request{.method = std::string(view_of(head.method_string())),
                            .path = std::string(target.substr(0, question))};
  for (target.remove_prefix(question); !target.empty();) {
    target.remove_prefix(1);  // ? or &
    const std::string_view pair = target.substr(0, target.find('&'));
    const std::size_t equals = std::min(pair.find('='), pair.size());
    request.query.emplace(decoded(pair.substr(0, equals)),
                          decoded(pair.substr(std::min(equals + 1, pair.size()))));
    target.remove_prefix(pair.size());
  }
  for (const auto& field : head) {
    request.headers.emplace(io::lower_case(view_of(field.name_string())), view_of(field.value()));
  }
  request.announced =
      parser.chunked() ? std::nullopt : std::optional(parser.content_length().value_or(0));
  return request;
}

template <typename Body>
http::response<Body> head_of(const annotate::Response& answer) {
  http::response<Body> head(http::int_to_status(static_cast<unsigned>(answer.status)), 11);
  head.set(http::field::content_type, answer.type);
  head.set(http::field::cache_control, "no-store");
  head.set("X-Content-Type-Options", "nosniff");
  head.set("X-Frame-Options", "DENY");
  head.set("Referrer-Policy", "no-referrer");
  for (const auto& [name, value] : answer.headers) head.set(name, value);
  return head;
}

asio::awaitable<void> send(beast::tcp_stream& stream, const annotate::Response& answer,
                           bool keep_alive) {
  auto message = head_of<http::span_body<const char>>(answer);
  message.body() = {answer.body.data(), answer.body.size()};
  message.keep_alive(keep_alive);
  message.prepare_payload();
  co_await http::async_write(stream, message, use_awaitable);
}

/// Sends an answer to a request whose body is not wanted. Closing with unread bytes would reset the
/// connection and lose the answer: they are read, within the time limit of the request.
asio::awaitable<void> turn_away(beast::tcp_stream& stream, const annotate::Response& answer) {
  co_await send(stream, answer, false);
  stream.socket().shutdown(tcp::socket::shutdown_send);
  std::array<char, 4096> rest;
  while (true) co_await stream.async_read_some(asio::buffer(rest), use_awaitable);
}

/// Runs `leave` at the end of a scope.
template <typename Leave>
std::shared_ptr<void> at_end(Leave leave) {
  return {nullptr, [leave](void*) { leave(); }};
}

}  // namespace

/// One thread serves all connections without blocking; clients that have shown the token are
/// answered by the workers. A connection is a coroutine that ends by an exception: at its end, at
/// its time limit, or on being closed.
struct HttpServer::Impl {
  annotate::Api* api = nullptr;
  annotate::Events* events = nullptr;
  annotate::Response page = {.type = "text/html; charset=utf-8"};

  // Used by that thread only. They must outlive the coroutines, which the contexts own.
  std::list<beast::tcp_stream*> strangers = {};  ///< have not shown the token; the oldest first
  std::set<asio::steady_timer*> listeners = {};  ///< expire when there are events

  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::thread_pool workers{kWorkers};
  std::thread thread = {};

  asio::awaitable<void> accept();
  asio::awaitable<void> converse(beast::tcp_stream stream);
  asio::awaitable<annotate::Response> answer(const annotate::Request& request);
  asio::awaitable<void> attend(beast::tcp_stream& stream, const std::string& window);
  asio::awaitable<void> stream_events(beast::tcp_stream& stream);
};

HttpServer::HttpServer(int port) : impl_(std::make_unique<Impl>()) {
  const tcp::endpoint here(asio::ip::address_v4::loopback(), static_cast<unsigned short>(port));
  try {
    impl_->acceptor.open(here.protocol());
    impl_->acceptor.set_option(tcp::acceptor::reuse_address(true));
    impl_->acceptor.bind(here);
    impl_->acceptor.listen();
  } catch (const boost::system::system_error& error) {
    throw Error(ErrorKind::kFailure,
                "port " + std::to_string(port) + " of 127.0.0.1: " + error.code().message());
  }
}

HttpServer::~HttpServer() {
  if (impl_->events) impl_->events->notify({});
  impl_->io.stop();
  if (impl_->thread.joinable()) impl_->thread.join();
  impl_->workers.stop();
  impl_->workers.join();
}

int HttpServer::port() const {
  return impl_->acceptor.local_endpoint().port();
}

void HttpServer::start(annotate::Api& api, annotate::Events& events, std::string_view page) {
  Impl& impl = *impl_;
  impl.api = &api;
  impl.events = &events;
  impl.page.body = page;
  events.notify([&impl] {
    asio::post(impl.io, [&impl] {
      for (asio::steady_timer* listener : impl.listeners) listener->cancel();
    });
  });
  asio::co_spawn(impl.io, impl.accept(), asio::detached);
  impl.thread = std::thread([&impl] { impl.io.run(); });
}

asio::awaitable<void> HttpServer::Impl::accept() {
  asio::steady_timer pause(io);
  while (true) {
    boost::system::error_code error;
    auto socket = co_await acceptor.async_accept(asio::redirect_error(use_awaitable, error));
    if (!error) {
      asio::co_spawn(io, converse(beast::tcp_stream(std::move(socket))), asio::detached);
      continue;
    }
    pause.expires_after(std::chrono::milliseconds(100));  // out of file descriptors for now
    co_await pause.async_wait(use_awaitable);
  }
}

asio::awaitable<void> HttpServer::Impl::converse(beast::tcp_stream stream) {
  stream.socket().set_option(tcp::no_delay(true));
  strangers.push_back(&stream);
  const auto leaving = at_end([&] { strangers.remove(&stream); });
  if (strangers.size() > kMostStrangers) {
    strangers.front()->close();
    strangers.pop_front();
  }
  beast::flat_buffer buffer;
  bool is_known = false, keep_alive = true;
  while (keep_alive) {
    Parser parser;
    parser.header_limit(kMostHeadBytes);
    parser.body_limit(
        std::numeric_limits<std::uint64_t>::max());  // Api::refuse() gives a better answer
    stream.expires_after(is_known ? kRequestTime : kStrangerTime);
    co_await http::async_read_header(stream, buffer, parser, use_awaitable);
    annotate::Request request = request_of(parser);
    if (const auto refused = api->refuse(request)) co_await turn_away(stream, *refused);
    if (request.path.starts_with("/api") && !is_known) {
      is_known = true;
      strangers.remove(&stream);
      stream.expires_after(kRequestTime);
    }
    co_await http::async_read(stream, buffer, parser, use_awaitable);
    request.body = std::move(parser.get().body());
    if (request.path == "/api/events") {
      co_return co_await attend(stream, request.query["window"]);
    }
    keep_alive = parser.keep_alive();
    if (request.path == "/") {
      co_await send(stream, page, keep_alive);
      continue;
    }
    const annotate::Response answered = co_await answer(request);
    stream.expires_never();  // a large download takes its time
    co_await send(stream, answered, keep_alive);
  }
}

/// On a worker's thread.
asio::awaitable<annotate::Response> HttpServer::Impl::answer(const annotate::Request& request) {
  const auto work = [this, &request]() -> asio::awaitable<annotate::Response> {
    co_return api->handle(request);
  };
  co_return co_await asio::co_spawn(workers, work, use_awaitable);
}

/// Sends events to the window until it does not listen, and closes it unless it soon does again.
asio::awaitable<void> HttpServer::Impl::attend(beast::tcp_stream& stream,
                                               const std::string& window) {
  api->begin_listening(window);
  try {
    co_await stream_events(stream);
  } catch (const boost::system::system_error&) {
    api->end_listening(window);
  }
  asio::steady_timer silence(io, kSilentTime);
  co_await silence.async_wait(use_awaitable);
  api->close_silent(window);
}

asio::awaitable<void> HttpServer::Impl::stream_events(beast::tcp_stream& stream) {
  asio::steady_timer news(io);
  listeners.insert(&news);
  const auto leaving = at_end([&] { listeners.erase(&news); });
  std::uint64_t next = events->end();
  auto head = head_of<http::empty_body>({.type = "text/event-stream"});
  head.keep_alive(false);
  http::response_serializer<http::empty_body> writer(head);
  stream.expires_after(kEventTime);
  co_await http::async_write_header(stream, writer, use_awaitable);
  for (std::string text = "retry: 1000\n\n"; true; text = events->take(next)) {
    if (text.empty()) {
      boost::system::error_code cancelled;
      news.expires_after(kQuietTime);
      co_await news.async_wait(asio::redirect_error(use_awaitable, cancelled));
      text = cancelled ? events->take(next) : ": still here\n\n";
    }
    stream.expires_after(kEventTime);
    co_await asio::async_write(stream, asio::buffer(text), use_awaitable);
  }
}

}  // namespace pcednet::app
