#include "workbench/annotate/page/api.h"

#include <fmt/format.h>

#include "pcednet/core/error.h"
#include "workbench/annotate/page/json.h"
#include "workbench/annotate/page/routes.h"
#include "workbench/annotate/scene/not_found.h"

namespace pcednet::annotate {
namespace {

constexpr std::size_t kMostBodyBytes = std::size_t{8} << 20;

/// Compares in constant time, so that timing reveals nothing about the token.
bool is_same(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned>(a[i] ^ b[i]);
  return difference == 0;
}

Response error_response(int status, const std::string& message) {
  return {.status = status, .body = error_json(message)};
}

/// The HTTP status for an error of any origin.
int status_of(const std::exception& error) {
  if (dynamic_cast<const NotFound*>(&error)) return 404;
  const auto* known = dynamic_cast<const Error*>(&error);
  switch (known ? known->kind() : ErrorKind::kFailure) {
    case ErrorKind::kUsage:
      return 400;
    case ErrorKind::kInsufficient:
    case ErrorKind::kModelMismatch:
      return 409;
    default:
      return 500;
  }
}

}  // namespace

bool is_own_host(std::string_view host, int port) {
  constexpr int kPortOfHttp = 80;
  for (const char* name : {"127.0.0.1", "localhost"}) {
    if (host == fmt::format("{}:{}", name, port) || (port == kPortOfHttp && host == name)) {
      return true;
    }
  }
  return false;
}

Api::Api(Session& session, Events& events, std::string token, int port)
    : session_(session), events_(events), token_(std::move(token)), port_(port) {}

std::optional<Response> Api::refuse(const Request& request) const {
  if (!is_own_host(value_of(request.headers, "host"), port_)) {
    return error_response(403, "another host is asked for");
  }
  if (const auto origin = request.headers.find("origin"); origin != request.headers.end()) {
    constexpr std::string_view kScheme = "http://";
    const std::string_view asked_by = origin->second;
    if (!asked_by.starts_with(kScheme) || !is_own_host(asked_by.substr(kScheme.size()), port_)) {
      return error_response(403, "asked by a page of another origin");
    }
  }
  const bool is_api = request.path.starts_with("/api");
  if (is_api) {
    const auto header = request.headers.find("x-pcednet-token");
    const std::string token =
        header != request.headers.end() ? header->second : value_of(request.query, "token");
    if (!is_same(token, token_)) return error_response(403, "the token is missing or wrong");
  }
  if (request.method != "GET" && request.method != "POST") {
    return error_response(404, "GET or POST");
  }
  if (!is_api && (request.path != "/" || request.method != "GET")) {
    return error_response(404, "nothing is there");
  }
  if (!request.announced) return error_response(400, "Content-Length is missing");
  if (*request.announced > kMostBodyBytes) return error_response(413, "at most 8 MiB are taken");
  return {};
}

Response Api::handle(const Request& request) {
  if (auto refused = refuse(request)) return *refused;
  try {
    return answer(
        {.session = session_, .events = events_, .windows = windows_, .request = request});
  } catch (const std::exception& error) {
    return error_response(status_of(error), error.what());
  }
}

void Api::close_silent(const std::string& window) {
  if (const auto writer = windows_.close_silent(window)) events_.add(WriterChanged{*writer});
}

}  // namespace pcednet::annotate
