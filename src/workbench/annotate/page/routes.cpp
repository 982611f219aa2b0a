#include "workbench/annotate/page/routes.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/core/named.h"
#include "workbench/annotate/page/json.h"
#include "workbench/annotate/scene/not_found.h"

namespace pcednet::annotate {
namespace {

constexpr std::size_t kMostAsked = 10000;  // nodes in a request

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

std::string asked(const Call& call, const std::string& name) {
  return value_of(call.request.query, name);
}

/// 0 if absent.
template <typename Number>
Number asked_number(const Call& call, const char* name) {
  const std::string text = asked(call, name);
  return text.empty() ? Number{} : number_of<Number>(text, name);
}

std::size_t cloud_of(const Call& call) {
  return asked_number<std::size_t>(call, "cloud");
}

template <typename Value, std::size_t kCount>
using Names = std::array<std::pair<std::string_view, Value>, kCount>;

constexpr Names<Saved, 4> kSaved = {{{"cloud", Saved::kCloud},
                                     {"model", Saved::kModel},
                                     {"project", Saved::kProject},
                                     {"lines", Saved::kLines}}};
constexpr Names<Shown, 8> kShown = {{{"labels", Shown::kLabels},
                                     {"prediction", Shown::kPrediction},
                                     {"confidence", Shown::kConfidence},
                                     {"p_sharp", Shown::kPSharp},
                                     {"feature", Shown::kFeature},
                                     {"file_labels", Shown::kFileLabels},
                                     {"las_classes", Shown::kLasClasses},
                                     {"errors", Shown::kErrors}}};

/// A header that offers a file. The input's name, of which `name` is made, may hold any bytes.
std::string attachment(std::string name) {
  const auto breaks = [](unsigned char c) { return c < ' ' || c == 127 || c == '"' || c == '\\'; };
  std::replace_if(name.begin(), name.end(), breaks, '_');
  return "attachment; filename=\"" + name + "\"";
}

Response json_response(std::string json) {
  return {.body = std::move(json)};
}

/// Bytes of any type.
template <typename Bytes>
Response binary(const Bytes& bytes, std::map<std::string, std::string> headers = {}) {
  return {.type = "application/octet-stream",
          .body = std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
          .headers = std::move(headers)};
}

Asking window_of(const Call& call) {
  const std::string name = value_of(call.request.headers, "x-window");
  return {.is_writer = call.windows.is_writer(name), .is_open = call.windows.is_open(name)};
}

Response get_session(const Call& call) {
  return json_response(to_json(call.session.summary(cloud_of(call)), window_of(call)));
}

Response get_runs(const Call& call) {
  return json_response(to_json(call.session.runs()));
}

Response get_uncertain(const Call& call) {
  return json_response(
      to_json(call.session.uncertain(asked_number<std::size_t>(call, "after"), cloud_of(call))));
}

Response get_pick(const Call& call) {
  const Vec3 direction = vector_of(asked(call, "direction"), "direction");
  const double radius = number_of<double>(asked(call, "radius"), "radius");
  if (direction.isZero(0.0) || radius <= 0) {
    throw Error(ErrorKind::kUsage, "a direction that is not 0 and a radius above 0 are wanted");
  }
  const Vec3 origin = vector_of(asked(call, "origin"), "origin");
  return json_response(to_json(call.session.pick(origin, direction, radius, cloud_of(call))));
}

Response values_of_nodes(const Call& call, const std::vector<std::size_t>& nodes) {
  const auto [bytes, version] = call.session.values(
      named(kShown, "of", asked(call, "of")), nodes, asked_number<int>(call, "feature"),
      asked_number<int>(call, "scale"), cloud_of(call));
  return binary(bytes, {{"X-Version", std::to_string(version)}});
}

Response get_values(const Call& call) {
  return values_of_nodes(call, numbers_of<std::size_t>(asked(call, "nodes"), "nodes"));
}

Response get_node_values(const Call& call) {
  return values_of_nodes(call, {number_of<std::size_t>(call.name, "node")});
}

Response get_node_points(const Call& call) {
  return binary(
      call.session.node_points(number_of<std::size_t>(call.name, "node"), cloud_of(call)));
}

/// Lines are available in any of their formats.
std::string wanted_name(const Call& call, const std::filesystem::path& usual) {
  const std::string format = asked(call, "format");
  return format.empty() ? "" : usual.stem().string() + "." + format;
}

/// By their names in --dxf-arcs; all if none is named.
io::DxfArcs wanted_arcs(const Call& call) {
  const std::string name = asked(call, "dxf_arcs");
  return name.empty() ? io::DxfArcs::kAll : named(io::kDxfArcs, "dxf_arcs", name);
}

Response get_lines(const Call& call) {
  return json_response(to_json(call.session.lines(cloud_of(call))));
}

Response get_download(const Call& call) {
  const Saved what = named(kSaved, "what", call.name);
  const std::size_t cloud = cloud_of(call);
  const auto usual = call.session.target(what, {}, cloud);
  const auto target = call.session.target(what, wanted_name(call, usual), cloud);
  std::string folder =
      (std::filesystem::temp_directory_path() / "pcednet-download-XXXXXX").string();
  if (!::mkdtemp(folder.data())) throw Error(ErrorKind::kFailure, folder + ": cannot be made");
  // The folder is removed in any case.
  const std::shared_ptr<void> removal(nullptr, [&](void*) {
    std::error_code error;
    std::filesystem::remove_all(folder, error);
  });
  const auto file = std::filesystem::path(folder) / target.filename();
  call.session.save(what, file, Overwrite::kNo, cloud, wanted_arcs(call));
  std::ifstream stream(file, std::ios::binary);
  return binary(std::string(std::istreambuf_iterator<char>(stream), {}),
                {{"Content-Disposition", attachment(target.filename().string())}});
}

Response open_window(const Call& call) {
  const auto [window, is_writer] = call.windows.open();
  return json_response(window_json(window, is_writer));
}

Response take_over(const Call& call) {
  call.windows.take_over(call.name);
  call.events.add(WriterChanged{call.name});
  return json_response(window_json(call.name, true));
}

Response leave(const Call& call) {
  if (const auto writer = call.windows.leave(call.name)) call.events.add(WriterChanged{*writer});
  return json_response("{}");
}

Response paint(const Call& call) {
  return json_response(to_json(call.session.paint(parse_stroke(call.request.body))));
}

Response undo(const Call& call) {
  return json_response(to_json(call.session.undo()));
}

Response redo(const Call& call) {
  return json_response(to_json(call.session.redo()));
}

Response change_settings(const Call& call) {
  const SettingsChange change = parse_settings_change(call.request.body);
  return json_response(to_line(call.session.change_settings(change)));
}

Response change_classes(const Call& call) {
  return json_response(
      to_json(call.session.change_classes(parse_classes_change(call.request.body))));
}

Response find_lines(const Call& call) {
  const auto [cloud, boundaries] = parse_lines_search(call.request.body);
  call.session.find_lines(cloud, boundaries);
  return json_response("{}");
}

Response decide(const Call& call) {
  call.session.decide(parse_decision(call.request.body));
  return json_response("{}");
}

Response train(const Call& call) {
  call.session.train_now();
  return json_response("{}");
}

Response cancel(const Call& call) {
  call.session.cancel();
  return json_response("{}");
}

Response restore(const Call& call) {
  call.session.restore(number_of<int>(call.name, "run"));
  return json_response("{}");
}

Response save(const Call& call) {
  const SaveRequest wanted = parse_save(call.request.body);
  const Saved what = named(kSaved, "what", wanted.what);
  const auto path = call.session.target(what, wanted.name, wanted.cloud);
  const bool overwrite = wanted.overwrite || call.session.options().overwrite;
  std::error_code error;
  if (!overwrite && std::filesystem::exists(path, error)) {
    throw Error(ErrorKind::kInsufficient, path.string() + " exists");
  }
  try {
    const FileSaved saved =
        call.session.save(what, path, overwrite ? Overwrite::kYes : Overwrite::kNo, wanted.cloud);
    call.events.add(saved);
    return json_response(to_json(saved));
  } catch (const Error& fault) {
    if (fault.kind() != ErrorKind::kFailure) throw;
    throw Error(fault.kind(), fmt::format("{}; all strokes are kept: download it instead, or mend "
                                          "that and save again",
                                          fault.what()));
  }
}

struct Route {
  std::string_view method, path;  ///< a * matches a name
  Response (*answer)(const Call& call);
  bool is_writers = false;  ///< only for the window that may paint
};

constexpr Route kRoutes[] = {
    {"GET", "/api/session", get_session},
    {"GET", "/api/runs", get_runs},
    {"GET", "/api/pick", get_pick},
    {"GET", "/api/uncertain", get_uncertain},
    {"GET", "/api/values", get_values},
    {"GET", "/api/node/*/values", get_node_values},
    {"GET", "/api/node/*/points", get_node_points},
    {"GET", "/api/lines", get_lines},
    {"GET", "/api/download/*", get_download},
    {"POST", "/api/window", open_window},
    {"POST", "/api/window/*/take", take_over},
    {"POST", "/api/window/*/leave", leave},
    {"POST", "/api/stroke", paint, true},
    {"POST", "/api/undo", undo, true},
    {"POST", "/api/redo", redo, true},
    {"POST", "/api/settings", change_settings, true},
    {"POST", "/api/classes", change_classes, true},
    {"POST", "/api/save", save, true},
    {"POST", "/api/lines/find", find_lines, true},
    {"POST", "/api/lines/decide", decide, true},
    {"POST", "/api/train", train, true},
    {"POST", "/api/cancel", cancel, true},
    {"POST", "/api/runs/*/restore", restore, true},
};

/// The part of `path` that matches the * of `pattern`, or nothing if it is not of this form.
std::optional<std::string> match(std::string_view path, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) {
    return path == pattern ? std::optional<std::string>("") : std::nullopt;
  }
  const std::string_view before = pattern.substr(0, star), after = pattern.substr(star + 1);
  if (path.size() <= before.size() + after.size() || !path.starts_with(before) ||
      !path.ends_with(after)) {
    return {};
  }
  const auto name = path.substr(before.size(), path.size() - before.size() - after.size());
  if (name.find('/') != std::string_view::npos) return {};
  return std::string(name);
}

}  // namespace

std::string value_of(const std::map<std::string, std::string>& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? std::string() : found->second;
}

Response answer(Call call) {
  for (const Route& route : kRoutes) {
    if (route.method != call.request.method) continue;
    const auto name = match(call.request.path, route.path);
    if (!name) continue;
    if (route.is_writers && !window_of(call).is_writer) {
      throw Error(ErrorKind::kInsufficient, "another window is painting");
    }
    call.name = *name;
    return route.answer(call);
  }
  throw NotFound(call.request.path + ": nothing is there");
}

}  // namespace pcednet::annotate
