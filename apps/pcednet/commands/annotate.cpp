#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <thread>

#include "browser.h"
#include "commands.h"
#include "http_server.h"
#include "models.h"
#include "pcednet/core/error.h"
#include "pcednet/io/text_scan.h"
#include "web_pages.h"
#include "workbench/annotate/page/api.h"
#include "workbench/annotate/project/journal.h"
#include "workbench/annotate/project/known_files.h"
#include "workbench/annotate/project/painting.h"
#include "workbench/annotate/saving.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

/// A browser opens when the input proves valid, or after this time.
constexpr std::chrono::seconds kPatience{3};

/// The interval at which the address is noted as in use.
constexpr std::chrono::minutes kTouch{1};

/// No model: training starts from random weights.
constexpr const char* kNoModel = "none";

struct AnnotateArguments {
  std::vector<std::string> inputs;
  std::string project, classes, model = kDefaultModel;
  bool is_model_given = false;
  int port = 0;
  bool no_browser = false;
};

/// 128 random bits, as a secret.
std::string make_token() {
  std::ifstream source("/dev/urandom", std::ios::binary);
  unsigned char bytes[16];
  if (!source.read(reinterpret_cast<char*>(bytes), sizeof bytes)) {
    throw Error(ErrorKind::kFailure, "/dev/urandom: cannot be read");
  }
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

/// Without a browser the user still has the address on the screen.
std::unique_ptr<BrowserTab> open_browser(const std::string& url) {
  try {
    return std::make_unique<BrowserTab>(url);
  } catch (const Error& error) {
    warn(std::string("no browser is opened: ") + error.what());
    return {};
  }
}

/// The model of --model as a start of the project; empty: none.
std::string start_of(const AnnotateArguments& arguments, const fs::path& project,
                     const annotate::ShippedModels& shipped) {
  if (arguments.model == kNoModel) return {};
  const fs::path file = find_model(arguments.model);
  const auto found = shipped.find(arguments.model);
  if (found != shipped.end() && found->second == file) return arguments.model;
  return annotate::start_name(file, project, shipped);
}

/// The models that training may start from.
void add_starts(annotate::SessionOptions& options, const AnnotateArguments& arguments) {
  const annotate::ShippedModels shipped = shipped_models();
  options.model = start_of(arguments, options.project, shipped);
  options.is_model_wanted = arguments.is_model_given;
  for (const auto& [name, path] : shipped) options.starts.push_back(name);
  if (!options.model.empty() && !shipped.contains(options.model)) {
    options.starts.push_back(options.model);
  }
  options.load_model = [project = options.project, shipped](const std::string& name) {
    return detect::load_model(annotate::start_file(name, project, shipped));
  };
  options.start_place = [project = options.project, shipped](const std::string& name) {
    return annotate::start_place(name, project, shipped);
  };
  if (!options.model.empty()) options.load_model(options.model);  // fail before any work
}

fs::path sound_input(const std::string& given) {
  std::error_code ignored;
  if (fs::is_directory(given, ignored)) {
    throw Error(ErrorKind::kUsage, given + ": is a folder; give its files one by one");
  }
  if (!fs::is_regular_file(given, ignored)) {
    throw Error(ErrorKind::kUnreadable, given + ": no such file");
  }
  return fs::absolute(given);
}

/// The inputs after the first: those given, then further ones of the project.
std::vector<fs::path> further_inputs(const std::vector<fs::path>& given, const fs::path& project) {
  std::vector<fs::path> all = given;
  const annotate::Inputs known = annotate::inputs_of_project(project);
  for (std::size_t k = given.size(); k < known.size(); ++k) {
    all.push_back(annotate::place_of_input(project, known, k, given.front().parent_path()));
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      const auto saved = [&](std::size_t one) {
        return annotate::saving_path(annotate::Saved::kCloud, {}, all, one, project);
      };
      std::error_code ignored;
      if (fs::equivalent(all[i], all[k], ignored) || saved(i) == saved(k)) {
        throw Error(ErrorKind::kUsage, fmt::format("{} and {}: would be saved under one name",
                                                   all[i].string(), all[k].string()));
      }
    }
  }
  return {all.begin() + 1, all.end()};
}

/// The classes of --classes: given directly, or one a line in a file of that name.
std::optional<ClassTable> classes_named(const std::string& given) {
  if (given.empty()) return std::nullopt;
  std::error_code ignored;
  if (!fs::is_regular_file(given, ignored)) return parse_classes(given);
  std::ifstream file(given);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return parse_classes(io::without_mark(text));
}

annotate::SessionOptions session_options(const AnnotateArguments& arguments, const Common& common,
                                         annotate::Events& events) {
  std::vector<fs::path> inputs;
  for (const std::string& given : arguments.inputs) inputs.push_back(sound_input(given));
  const fs::path input = inputs.front();
  if (arguments.project.empty() && ::access(input.parent_path().c_str(), W_OK) != 0) {
    throw Error(
        ErrorKind::kFailure,
        fmt::format("{}: the folder cannot be written; --project FILE keeps the strokes elsewhere",
                    input.parent_path().string()));
  }
  check_writable(arguments.project, Overwrite::kYes);
  annotate::SessionOptions options;
  options.input = input;
  options.project = arguments.project.empty() ? annotate::default_project(input)
                                              : fs::absolute(arguments.project);
  options.further = further_inputs(inputs, options.project);
  options.cache_folder = input.parent_path() / ".pcednet";
  options.classes = classes_named(arguments.classes);
  options.overwrite = common.overwrite_files;
  add_starts(options, arguments);
  options.emit = [&events](const annotate::Event& event) {
    events.add(event);
    if (const auto* ready = std::get_if<annotate::Ready>(&event)) {
      for (const std::string& note : ready->notes) warn(note);
      say("ready; Ctrl-C ends the program, and all strokes are kept");
    }
  };
  return options;
}

/// A server at the address where the page of an earlier start may still be open, or at a new one.
struct Place {
  std::unique_ptr<HttpServer> server = {};
  std::string token = {};
  bool is_old = false;
};

Place find_place(int wanted_port, const std::optional<Address>& old) {
  if (old && (wanted_port == 0 || wanted_port == old->port)) {
    try {
      return {std::make_unique<HttpServer>(old->port), old->token, true};
    } catch (const Error&) {
      if (wanted_port != 0) throw;  // another program uses it
    }
  }
  return {std::make_unique<HttpServer>(wanted_port), make_token()};
}

void annotate_cloud(const AnnotateArguments& arguments, const Common& common) {
  std::string_view page = annotate_page();
  if (page.empty()) {
    page =
        "<!doctype html><p>This pcednet was built without the page: run scripts/build_web.sh "
        "and build again.";
    warn("built without the page; run scripts/build_web.sh and build again");
  }
  annotate::Events events;
  const auto options = session_options(arguments, common, events);
  annotate::check_not_open(annotate::journal_of(options.project));  // before an address is printed
  const KeptAddress kept(options.project);
  Place place = find_place(arguments.port, kept.read());
  annotate::Session session(options);
  annotate::Api api(session, events, place.token, place.server->port());
  const auto server = std::move(place.server);  // destroyed before the objects that answer for it
  server->start(api, events, page);
  const std::string url = fmt::format("http://127.0.0.1:{}/?token={}", server->port(), place.token);
  fmt::print("{}\n", url);
  std::fflush(stdout);
  std::unique_ptr<BrowserTab> tab;
  bool is_browser_wanted = !arguments.no_browser, is_kept = false;
  auto now = std::chrono::steady_clock::now();
  const auto opening = now + kPatience;
  auto touching = now + kTouch;
  const auto cancelled = console_progress(common).cancelled;
  for (; !cancelled(); now = std::chrono::steady_clock::now()) {
    const bool is_accepted = session.is_accepted();  // throws if loading failed
    if (is_accepted && !is_kept) kept.write({server->port(), place.token});
    is_kept = is_accepted;
    if (now > touching) {
      kept.touch();
      touching = now + kTouch;
    }
    // A page that is still open reconnects by itself.
    if (place.is_old && api.was_opened()) is_browser_wanted = false;
    if (is_browser_wanted && ((is_accepted && !place.is_old) || now > opening)) {
      tab = open_browser(url);
      is_browser_wanted = false;
    }
    if (api.was_opened()) tab.reset();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace

void add_annotate(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<AnnotateArguments>();
  CLI::App* command = add_command(
      app, common, "annotate", "Paint edges in the browser, train on them, review their lines",
      "pcednet annotate scan.ply                       opens the browser\n"
      "pcednet annotate scan.ply hall.las              trains on several together\n"
      "pcednet annotate scan.ply --no-browser --port 8080\n"
      "pcednet annotate scan.ply --model scan          corrects another model\n"
      "pcednet annotate scan.ply --model none          starts from nothing\n"
      "pcednet annotate scan.ply --classes \"ground, wall, pipe\"    own classes instead of edges\n"
      "pcednet train --project scan_annotation.json -o my.safetensors   the same model again");
  command
      ->add_option("inputs", arguments->inputs,
                   "Point files; more than one are trained on together")
      ->required();
  command->add_option("--project", arguments->project,
                      "Project file, with its journal beside it (default: <stem>_annotation.json "
                      "beside the first input)");
  command
      ->add_option("--model", arguments->model,
                   "Shipped model or model file to correct: its labels are shown first, training "
                   "starts from it; none: from nothing")
      ->capture_default_str();
  command->add_option("--classes", arguments->classes,
                      "Own classes, two to eight: names with commas between, each may be followed "
                      "by =#rrggbb, or a file of one a line; \"edges, pipe\" adds to the edge "
                      "classes");
  command->add_option("--port", arguments->port, "Port of 127.0.0.1 (0: any free port)")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  command->add_flag("--no-browser", arguments->no_browser, "Print the address only");
  command->callback([arguments, command, &common] {
    arguments->is_model_given = command->count("--model") > 0;
    annotate_cloud(*arguments, common);
  });
}

}  // namespace pcednet::app
