#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/annotate/scene.h"
#include "pcednet/annotate/stroke.h"

namespace pcednet::annotate {

struct SessionOptions {
  std::filesystem::path input = {};
  std::filesystem::path project = {};       ///< empty: see default_project()
  std::filesystem::path cache_folder = {};  ///< empty: descriptions are not kept
  std::string model = {};                   ///< to classify with at once; empty: none
  bool overwrite = false;                   ///< saving replaces files without being asked to
  /// The model behind a name of Settings::start or `model`; throws for one that is not known.
  std::function<detect::EdgeModel(const std::string& name)> load_model = {};
  /// Is told of every event with its JSON, from any thread; must not call the session.
  std::function<void(const std::string& name, const std::string& json)> emit = {};
};

/// `<stem>_annotation.json` beside the input.
std::filesystem::path default_project(const std::filesystem::path& input);

enum class Saved { kCloud, kModel, kProject };

/// An annotation of one cloud while it lasts: loading, painting, training, saving. Loading and
/// training run on a thread of its own; every function may be called from any thread. The journal
/// is beside the project: what a stroke's answer reports survives the end of the program.
///
/// Answers are JSON as docs/annotate.md describes. Errors: kUsage for a request that makes no
/// sense, kUnreadable for what is not there, kInsufficient for what is not possible now.
class Session {
 public:
  explicit Session(SessionOptions options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Whether the cloud can be painted yet; throws what prevents it from ever being.
  bool is_ready() const;

  /// Blocks until it is.
  void wait_until_ready() const;

  std::string summary(bool writer) const;
  std::vector<std::byte> node_points(std::size_t node) const;

  struct Values {
    std::vector<std::uint8_t> bytes = {};
    int version = 0;
  };
  /// A byte per point of the nodes; `of` is labels, prediction, confidence, p_sharp or feature.
  Values values(const std::string& of, const std::vector<std::size_t>& nodes, int feature,
                int scale) const;

  std::string paint(const Stroke& stroke);
  std::string undo();
  std::string redo();
  std::string change_settings(std::string_view json);
  void train_now();
  void cancel();
  std::string runs() const;
  void restore(int run);

  std::string uncertain(std::size_t after) const;
  std::string pick(const Vec3& local_origin, const Vec3& direction, double radius) const;

  /// Where `what` goes: `name` (a file name) or the usual one, beside the input.
  std::filesystem::path target(Saved what, const std::string& name) const;

  /// Writes `what` to `path` and returns the bytes written.
  std::uintmax_t save(Saved what, const std::filesystem::path& path, Overwrite overwrite) const;

  const SessionOptions& options() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pcednet::annotate
