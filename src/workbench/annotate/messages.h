#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "workbench/annotate/learn/held_out.h"
#include "workbench/annotate/scene/line_review.h"
#include "workbench/annotate/scene/scene.h"

namespace pcednet::annotate {

/// Painted points by class, see counts_of().
using Counts = std::vector<std::size_t>;

/// The outcome of a stroke, an undo or a redo.
struct Painted {
  std::size_t stroke = 0;   ///< number of strokes in effect; 0 for a stroke of an earlier start
  std::size_t changed = 0;  ///< points
  std::size_t cloud = 0;    ///< that they are of
  Counts counts = {};       ///< of all labels
  std::vector<std::size_t> painted = {};  ///< points of each cloud
  int labels_version = 0;
  std::vector<std::uint32_t> nodes = {};  ///< nodes with changed labels, ascending
  std::size_t undo = 0, redo = 0;         ///< steps
};

struct RunView {
  RunRecord record = {};
  bool is_current = false;
  std::optional<HeldOut> held_out = {};
};

/// One of a session's clouds.
struct CloudView {
  std::string file = {};
  std::size_t points = 0, painted = 0;
};

/// The state of a session.
struct Summary {
  std::string name = {}, file = {};         ///< of the input, without and with its extension
  std::vector<CloudView> clouds = {};       ///< all; none while loading
  std::size_t cloud = 0;                    ///< the one that the rest is about
  std::string stage = {};                   ///< of loading and training
  std::shared_ptr<const Scene> scene = {};  ///< null while loading
  Counts counts = {};
  ProjectClasses classes = {};
  std::size_t undo = 0, redo = 0;
  Settings settings = {};
  std::vector<std::string> starts = {};  ///< that settings may name
  std::vector<double> scales = {};       ///< of the description, as lengths; none while loading
  std::optional<RunView> run = {};       ///< the current one
  bool is_out_of_date = false;           ///< see Predicted
  int prediction_version = 0, labels_version = 0;
};

/// A point of low confidence. Coordinates here and below are local.
struct UncertainPlace {
  std::size_t rank = 0, of = 0;  ///< from 1
  Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
  float confidence = 0;
  std::uint8_t prediction = kUnlabelled;
};

/// A point of the cloud and what is known of it.
struct PointView {
  std::uint32_t point = 0;
  Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
  std::uint8_t label = kUnlabelled, prediction = kUnlabelled;
  std::optional<std::array<float, 3>> probabilities = {};  ///< by edge class
  std::optional<float> p_class = {};  ///< of the prediction, where there are own classes
  double distance = 0;                ///< from the eye
};

/// The lines of a cloud and the scene that they are in.
struct LinesView {
  LineReview review = {};
  std::size_t cloud = 0;
  std::shared_ptr<const Scene> scene = {};
};

/// Events of a session that no request asked for at that moment.
struct StageProgress {
  std::string stage = {};
  double fraction = 0;
};
struct Ready {
  std::vector<std::string> notes =
      {};  ///< of all clouds, by their names; each page has those of its cloud
};
struct Problem {
  std::string message = {};
};
struct EpochDone {
  int run = 0, epoch = 0, epochs = 0;
  bool is_context = false;  ///< of the context network
  double loss = 0;
};
struct Predicted {
  int prediction_version = 0, run = 0;
  std::vector<std::size_t> counts = {};  ///< points by class
  bool is_out_of_date = false;           ///< strokes are newer than the run
  RunFacts facts = {};
};
struct Judged {
  int run = 0;
  HeldOut held_out = {};
};
struct ClassesChanged {
  ProjectClasses classes = {};
  Counts counts = {};
};
struct LinesChanged {
  std::size_t cloud = 0;
  int version = 0;
  bool is_searching = false;
};
struct WriterChanged {
  std::string window = {};
};
struct FileSaved {
  std::string path = {};
  std::uintmax_t bytes = 0;
  /// Strokes, painted or taken back, that the model or prediction in the file does not know.
  std::size_t strokes_left_out = 0;
};
using Event = std::variant<StageProgress, Ready, Problem, EpochDone, Painted, Predicted, Judged,
                           ClassesChanged, LinesChanged, LinesDecided, WriterChanged, FileSaved>;

}  // namespace pcednet::annotate
