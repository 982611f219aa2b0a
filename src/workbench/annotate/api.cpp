#include "workbench/annotate/api.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "pcednet/core/error.h"
#include "workbench/annotate/not_found.h"

namespace pcednet::annotate {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostAsked = 10000;  // nodes in a request

std::string value_of(const std::map<std::string, std::string>& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? std::string() : found->second;
}

template <typename Number>
Number number_of(std::string_view text, const char* what) {
  Number number{};
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  bool good = error == std::errc() && rest == text.data() + text.size();
  if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(number);
  if (!good) throw Error(ErrorKind::kUsage, fmt::format("{}: a number is wanted", what));
  return number;
}

template <typename Number>
std::vector<Number> numbers_of(std::string_view text, const char* what) {
  std::vector<Number> numbers;
  while (true) {
    const std::size_t comma = text.find(',');
    numbers.push_back(number_of<Number>(text.substr(0, comma), what));
    if (comma == std::string_view::npos) return numbers;
    if (numbers.size() >= kMostAsked) throw Error(ErrorKind::kUsage, "too many numbers");
    text.remove_prefix(comma + 1);
  }
}

Vec3 vector_of(const std::string& text, const char* what) {
  const auto v = numbers_of<double>(text, what);
  if (v.size() != 3) throw Error(ErrorKind::kUsage, fmt::format("{}: x,y,z", what));
  return {v[0], v[1], v[2]};
}

/// The same time for any wrong token: how much of it is right cannot be measured.
bool is_same(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned>(a[i] ^ b[i]);
  return difference == 0;
}

int status_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return 400;
    case ErrorKind::kInsufficient:
    case ErrorKind::kModelMismatch:
      return 409;
    default:
      return 500;
  }
}

Saved saved_of(const std::string& what) {
  if (what == "cloud") return Saved::kCloud;
  if (what == "model") return Saved::kModel;
  if (what == "project") return Saved::kProject;
  throw Error(ErrorKind::kUsage, "what: cloud, model or project");
}

Shown shown_of(const std::string& of) {
  if (of == "labels") return Shown::kLabels;
  if (of == "prediction") return Shown::kPrediction;
  if (of == "confidence") return Shown::kConfidence;
  if (of == "p_sharp") return Shown::kPSharp;
  if (of == "feature") return Shown::kFeature;
  throw Error(ErrorKind::kUsage, "of: labels, prediction, confidence, p_sharp or feature");
}

/// What is between `before` and `after` in `path`, if it has this form and that is a name.
std::optional<std::string> between(const std::string& path, std::string_view before,
                                   std::string_view after) {
  if (path.size() <= before.size() + after.size() || !path.starts_with(before) ||
      !path.ends_with(after)) {
    return {};
  }
  std::string name = path.substr(before.size(), path.size() - before.size() - after.size());
  if (name.find('/') != std::string::npos) return {};
  return name;
}

/// A header that offers a file. The input's name, of which `name` is made, may hold any bytes.
std::string attachment(std::string name) {
  const auto breaks = [](unsigned char c) { return c < ' ' || c == 127 || c == '"' || c == '\\'; };
  std::replace_if(name.begin(), name.end(), breaks, '_');
  return "attachment; filename=\"" + name + "\"";
}

Response json_response(std::string json) {
  return {.body = std::move(json)};
}

}  // namespace

Response error_response(int status, const std::string& message) {
  const auto how = Json::error_handler_t::replace;  // a file name may hold any bytes
  return {.status = status, .body = Json{{"error", message}}.dump(-1, ' ', false, how)};
}

Api::Api(Session& session, Events& events, std::string token, int port)
    : session_(session), events_(events), token_(std::move(token)), port_(port) {}

std::optional<Response> Api::refuse(const Request& request) const {
  const std::string here = fmt::format("127.0.0.1:{}", port_);
  const std::string named = fmt::format("localhost:{}", port_);
  const std::string host = value_of(request.headers, "host");
  if (host != here && host != named) return error_response(403, "another host is asked for");
  if (const auto origin = request.headers.find("origin"); origin != request.headers.end() &&
                                                          origin->second != "http://" + here &&
                                                          origin->second != "http://" + named) {
    return error_response(403, "asked by a page of another origin");
  }
  if (!request.path.starts_with("/api")) return {};
  const auto header = request.headers.find("x-pcednet-token");
  const std::string token =
      header != request.headers.end() ? header->second : value_of(request.query, "token");
  if (!is_same(token, token_)) return error_response(403, "the token is missing or wrong");
  return {};
}

Response Api::handle(const Request& request) {
  try {
    if (auto refused = refuse(request)) return *refused;
    if (request.body.size() > kMostBodyBytes) return error_response(413, "at most 8 MiB are taken");
    if (request.method == "GET") return get(request);
    if (request.method == "POST") return post(request);
    return error_response(404, "GET or POST");
  } catch (const NotFound& error) {
    return error_response(404, error.what());
  } catch (const Error& error) {
    return error_response(status_of(error.kind()), error.what());
  } catch (const Json::exception& error) {
    return error_response(400, error.what());
  } catch (const std::exception& error) {
    return error_response(500, error.what());
  }
}

bool Api::is_writer(const Request& request) const {
  const std::lock_guard lock(mutex_);
  return !writer_.empty() && value_of(request.headers, "x-window") == writer_;
}

Response Api::get(const Request& request) {
  const std::string& path = request.path;
  if (path == "/api/session") return json_response(session_.summary(is_writer(request)));
  if (path == "/api/runs") return json_response(session_.runs());
  if (path == "/api/pick") return pick(request);
  if (path == "/api/uncertain") {
    const std::string after = value_of(request.query, "after");
    return json_response(
        session_.uncertain(after.empty() ? 0 : number_of<std::size_t>(after, "after")));
  }
  if (path == "/api/values") {
    return values(request, numbers_of<std::size_t>(value_of(request.query, "nodes"), "nodes"));
  }
  if (const auto id = between(path, "/api/node/", "/values")) {
    return values(request, {number_of<std::size_t>(*id, "node")});
  }
  if (const auto id = between(path, "/api/node/", "/points")) {
    const auto bytes = session_.node_points(number_of<std::size_t>(*id, "node"));
    return {.type = "application/octet-stream",
            .body = std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())};
  }
  if (const auto what = between(path, "/api/download/", "")) return download(*what);
  return error_response(404, path + ": nothing is there");
}

Response Api::post(const Request& request) {
  const std::string& path = request.path;
  if (path == "/api/window") return open_window();
  if (const auto window = between(path, "/api/window/", "/take")) return take_over(*window);
  if (!is_writer(request)) return error_response(409, "another window is painting");
  if (path == "/api/stroke") return json_response(session_.paint(parse_stroke(request.body)));
  if (path == "/api/undo") return json_response(session_.undo());
  if (path == "/api/redo") return json_response(session_.redo());
  if (path == "/api/settings") return json_response(session_.change_settings(request.body));
  if (path == "/api/save") return save(request);
  if (path == "/api/train") {
    session_.train_now();
    return json_response("{}");
  }
  if (path == "/api/cancel") {
    session_.cancel();
    return json_response("{}");
  }
  if (const auto run = between(path, "/api/runs/", "/restore")) {
    session_.restore(number_of<int>(*run, "run"));
    return json_response("{}");
  }
  return error_response(404, path + ": nothing is there");
}

bool Api::was_opened() const {
  const std::lock_guard lock(mutex_);
  return windows_ > 0;
}

Response Api::open_window() {
  const std::lock_guard lock(mutex_);
  const std::string window = fmt::format("w{}", ++windows_);
  if (writer_.empty()) writer_ = window;
  return json_response(Json{{"window", window}, {"writer", writer_ == window}}.dump());
}

Response Api::take_over(const std::string& window) {
  const std::lock_guard lock(mutex_);
  const int number =
      window.starts_with('w') ? number_of<int>(std::string_view(window).substr(1), "window") : 0;
  if (number < 1 || number > windows_) return error_response(404, "there is no such window");
  writer_ = window;
  events_.add("writer", Json{{"window", window}}.dump());
  return json_response(Json{{"window", window}, {"writer", true}}.dump());
}

Response Api::values(const Request& request, const std::vector<std::size_t>& nodes) const {
  const auto number = [&](const char* name) {
    const std::string text = value_of(request.query, name);
    return text.empty() ? 0 : number_of<int>(text, name);
  };
  const auto values = session_.values(shown_of(value_of(request.query, "of")), nodes,
                                      number("feature"), number("scale"));
  return {.type = "application/octet-stream",
          .body = std::string(values.bytes.begin(), values.bytes.end()),
          .headers = {{"X-Version", std::to_string(values.version)}}};
}

Response Api::pick(const Request& request) const {
  const auto get = [&](const char* name) { return value_of(request.query, name); };
  const Vec3 direction = vector_of(get("direction"), "direction");
  const double radius = number_of<double>(get("radius"), "radius");
  if (direction.isZero(0.0) || radius <= 0) {
    throw Error(ErrorKind::kUsage, "a direction that is not 0 and a radius above 0 are wanted");
  }
  return json_response(session_.pick(vector_of(get("origin"), "origin"), direction, radius));
}

Response Api::save(const Request& request) {
  const Json json = Json::parse(request.body);
  const Saved what = saved_of(json.at("what").get<std::string>());
  const auto path = session_.target(what, json.value("name", std::string()));
  const bool overwrite = json.value("overwrite", false) || session_.options().overwrite;
  std::error_code error;
  if (!overwrite && std::filesystem::exists(path, error)) {
    return error_response(409, path.string() + " exists");
  }
  const auto bytes = session_.save(what, path, overwrite ? Overwrite::kYes : Overwrite::kNo);
  const std::string saved = Json{{"path", path.string()}, {"bytes", bytes}}.dump();
  events_.add("saved", saved);
  return json_response(saved);
}

Response Api::download(const std::string& name) const {
  const Saved what = saved_of(name);
  const auto target = session_.target(what, "");
  std::string folder =
      (std::filesystem::temp_directory_path() / "pcednet-download-XXXXXX").string();
  if (!::mkdtemp(folder.data())) throw Error(ErrorKind::kFailure, folder + ": cannot be made");
  // The folder goes whatever happens.
  const std::shared_ptr<void> removal(nullptr, [&](void*) {
    std::error_code error;
    std::filesystem::remove_all(folder, error);
  });
  const auto file = std::filesystem::path(folder) / target.filename();
  session_.save(what, file, Overwrite::kNo);
  std::ifstream stream(file, std::ios::binary);
  return {.type = "application/octet-stream",
          .body = std::string(std::istreambuf_iterator<char>(stream), {}),
          .headers = {{"Content-Disposition", attachment(target.filename().string())}}};
}

}  // namespace pcednet::annotate
