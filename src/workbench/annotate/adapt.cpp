#include "workbench/annotate/adapt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numeric>
#include <optional>

#include "pcednet/core/random.h"
#include "pcednet/core/stopwatch.h"
#include "pcednet/detect/context.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/outputs.h"
#include "pcednet/nn/predict.h"
#include "workbench/annotate/outputs.h"

namespace pcednet::annotate {
namespace {

constexpr std::uint64_t kKeptStream = 5;  // of the seed
constexpr double kRate = 0.006;
constexpr std::size_t kPerEpoch = 1 << 13;
// However much is painted, a training takes no longer.
constexpr std::size_t kFewestUnpainted = 2000, kMostUnpainted = 16000, kMostPainted = 16000;
constexpr double kLeastPainted = 0.3;  // share of the painted among the samples
// The same where some are of a class that the start does not know: it takes all other points of
// that class for something else.
constexpr double kLeastPaintedOfNew = 0.5;
constexpr float kPlain = 0.05f;  // so sure to be no edge; half of the kept points are others

// The context network looks again at points of this probability: below it hardly ever changes an
// answer, and an adapted network leaves many points there.
constexpr float kLeastEdge = 0.03f;

/// What a network learns from.
struct Lesson {
  std::vector<float> values = {}, targets = {};
  std::vector<std::uint8_t> outputs = {};
};

/// What the start says of an edge class.
float target_of(std::uint8_t edge_class, const detect::Classification& answer, std::uint32_t i) {
  if (edge_class == kSharpEdge) return answer.p_sharp[i];
  if (edge_class == kSmoothEdge) return answer.p_smooth[i];
  return 1.0f - answer.p_sharp[i] - answer.p_smooth[i];
}

/// How far the start is from the class that most points have.
float doubt_of(const detect::Classification& answer, std::uint32_t i) {
  const float edge = answer.p_sharp[i] + answer.p_smooth[i];
  return answer.p_class.empty() ? edge : std::max(edge, 1.0f - answer.p_class[i]);
}

/// The first `count` of `rows` in random order.
void choose(std::vector<std::size_t>& rows, std::size_t count, Random& random) {
  random.shuffle(std::span(rows));
  rows.resize(std::min(rows.size(), count));
}

class LessonWriter {
 public:
  /// `model` is what learns; `is_context`: its context network, which knows edges alone.
  LessonWriter(const Start& start, const detect::EdgeModel& model,
               std::span<const std::uint8_t> labels, std::uint64_t seed, bool is_context)
      : start_(start), model_(model), labels_(labels), seed_(seed), is_context_(is_context) {
    classes_ = is_context ? detect::edge_outputs(model) : model.classes;
    has_own_ = !is_context && has_own_classes(start.model.table);
  }

  Lesson write(const Rows& rows) const {
    std::vector<std::size_t> painted, plain, others;
    const detect::Classification& answer = start_.answer;
    for (std::size_t row = 0; row < rows.points.size(); ++row) {
      const std::uint32_t i = rows.points[row];
      if (labels_[i] == kLeftOut || (is_context_ && is_own(labels_[i]))) continue;
      const bool is_plain = doubt_of(answer, i) < kPlain;
      (labels_[i] != kUnlabelled ? painted : is_plain ? plain : others).push_back(row);
    }
    Random random(seed_, kKeptStream);
    const std::size_t kept = std::clamp(painted.size(), kFewestUnpainted, kMostUnpainted);
    choose(painted, kMostPainted, random);
    choose(plain, kept / 2, random);
    choose(others, kept / 2, random);
    Lesson lesson;
    const auto unpainted = static_cast<double>(plain.size() + others.size());
    const double share = has_new_outputs() ? kLeastPaintedOfNew : kLeastPainted;
    const double wanted = share / (1 - share) * unpainted;
    const double copies = painted.empty() ? 0 : wanted / static_cast<double>(painted.size());
    for (int k = 0; k < std::max(1, static_cast<int>(std::lround(copies))); ++k) {
      for (const std::size_t row : painted) add_painted(rows, row, lesson);
    }
    add_kept(rows, plain, lesson);
    add_kept(rows, others, lesson);
    return lesson;
  }

 private:
  bool has_new_outputs() const {
    return !is_context_ && model_.classes.size() > start_.model.classes.size();
  }

  bool is_own(std::uint8_t label) const {
    return label != kUnlabelled && label > kBoundary && has_edges(model_.table);
  }

  void add_row(const Rows& rows, std::size_t row, std::uint8_t its, Lesson& lesson) const {
    lesson.values.resize(lesson.values.size() + rows.width);
    rows.read(row, &*lesson.values.end() - rows.width);
    // An answer of another class than the context network's is no more than nearest to non-edge.
    const std::uint8_t output = detect::output_of(its, model_);
    lesson.outputs.push_back(output < classes_.size() ? output : std::uint8_t{0});
  }

  void add_painted(const Rows& rows, std::size_t row, Lesson& lesson) const {
    add_row(rows, row, labels_[rows.points[row]], lesson);
    for (std::size_t c = 0; c < classes_.size(); ++c) {
      lesson.targets.push_back(static_cast<float>(c == lesson.outputs.back()));
    }
  }

  /// Points with the start's answer.
  void add_kept(const Rows& rows, const std::vector<std::size_t>& some, Lesson& lesson) const {
    const std::size_t before = lesson.values.size();
    for (const std::size_t row : some) {
      add_row(rows, row, start_.answer.classes[rows.points[row]], lesson);
    }
    std::vector<float> said;
    if (has_own_)
      said = nn::predict(start_.model.network, std::span(lesson.values).subspan(before));
    const std::size_t outputs = start_.model.classes.size();
    for (std::size_t k = 0; k < some.size(); ++k) {
      const auto own =
          has_own_ ? std::span(said).subspan(k * outputs, outputs) : std::span<float>();
      add_targets(rows.points[some[k]], own, lesson);
    }
  }

  /// `said` is what the start's network says by its outputs, empty if it knows edges alone.
  void add_targets(std::uint32_t i, std::span<const float> said, Lesson& lesson) const {
    const bool edges = has_edges(model_.table);
    std::array<float, kMostClasses> own = {};  // by class
    float rest = 1.0f;                         // for edges
    for (std::size_t c = 0; c < said.size(); ++c) {
      const std::uint8_t id = start_.model.classes[c];
      if (edges && id <= kBoundary) continue;
      own[id] = said[c];
      rest -= said[c];
    }
    for (const std::uint8_t c : classes_) {
      const bool is_edge = edges && c <= kBoundary;
      lesson.targets.push_back(is_edge ? rest * target_of(c, start_.answer, i) : own[c]);
    }
  }

  const Start& start_;
  const detect::EdgeModel& model_;
  std::span<const std::uint8_t> labels_;
  std::uint64_t seed_;
  bool is_context_, has_own_ = false;
  std::vector<std::uint8_t> classes_ = {};  ///< of the outputs that learn
};

nn::TrainResult train(const nn::Model& from, const Lesson& lesson, std::uint64_t seed,
                      const std::function<void(const nn::EpochReport&)>& on_epoch,
                      const Progress* progress) {
  nn::TrainOptions options;
  options.seed = seed;
  options.learning_rate = kRate;
  options.epochs = kAdaptEpochs;
  options.balance = 0;
  options.held_out = 0;
  options.start = &from;
  options.least_per_epoch = options.most_per_epoch = kPerEpoch;
  return nn::train(from.network.architecture, {lesson.values, lesson.outputs, lesson.targets},
                   options, on_epoch, progress);
}

/// The second look at clouds of which the first found something.
class SecondLook {
 public:
  SecondLook(const Subject& subject, std::span<const detect::Classification> found,
             const detect::EdgeModel& model)
      : firsts_(first_points(subject)), classes_(detect::edge_outputs(model)) {
    for (std::size_t k = 0; k < subject.clouds.size(); ++k) {
      const auto& [described, positions, curve] = subject.clouds[k];
      matrices_.emplace_back(positions, curve, found[k], static_cast<int>(classes_.size()),
                             model.least_edge);
    }
  }

  Rows rows() const {
    std::vector<CloudRows> clouds;
    for (const detect::ContextMatrix& matrix : matrices_) {
      clouds.push_back({matrix.points(), [&matrix](std::size_t row, float* values) {
                          matrix.describe(row, row + 1, {values, matrix.width()});
                        }});
    }
    return joined_rows(std::move(clouds), firsts_, matrices_.front().width());
  }

  void apply(const nn::Model& context, std::span<detect::Classification> found) const {
    for (std::size_t k = 0; k < found.size(); ++k) {
      detect::apply_context(context, classes_, matrices_[k], found[k]);
    }
  }

 private:
  std::vector<std::uint32_t> firsts_;
  std::vector<std::uint8_t> classes_;
  std::deque<detect::ContextMatrix> matrices_ = {};
};

}  // namespace

Start make_start(detect::EdgeModel model, const Subject& subject) {
  std::size_t most = 0;  // points of a cloud
  for (const auto& cloud : subject.clouds) most = std::max(most, cloud.positions.size());
  Start start{.model = detect::suited_to(std::move(model), most)};
  start.answer = classify(subject, start.model);
  return start;
}

Adapted adapt(const std::string& name, const Start& start, const Subject& subject,
              std::span<const std::uint8_t> labels, std::uint64_t seed,
              const std::function<void(const nn::EpochReport&)>& on_epoch,
              const Progress* progress) {
  Adapted adapted{.model = with_outputs(start.model, subject.table, labels)};
  detect::EdgeModel& model = adapted.model;
  model.least_edge = std::max(model.least_edge, kLeastEdge);
  int epochs_before = 0;
  const auto learn = [&](nn::Model& network, const Rows& rows, bool is_context) {
    const Lesson lesson = LessonWriter(start, model, labels, seed, is_context).write(rows);
    if (lesson.outputs.empty()) return;
    nn::TrainResult result = train(
        network, lesson, seed,
        [&](nn::EpochReport report) {
          report.epoch += epochs_before;
          adapted.loss = report.training_loss;
          if (on_epoch) on_epoch(report);
        },
        progress);
    epochs_before += kAdaptEpochs;
    adapted.cancelled = adapted.cancelled || result.cancelled;
    network = std::move(result.best);
    network.metadata = {{"adapted_from", start.model.name},
                        {"training_samples", std::to_string(lesson.outputs.size())}};
  };
  learn(model.network, described_rows(subject), false);
  model.name = name;
  model.seed = seed;
  if (adapted.cancelled) return adapted;
  std::optional<nn::Model> context = std::exchange(model.context, {});
  Stopwatch watch;
  std::vector<detect::Classification> found;
  for (const auto& [described, positions, curve] : subject.clouds) {
    found.push_back(detect::classify(described.cloud, positions, model));
  }
  adapted.seconds_classify = watch.lap();
  if (context) {
    throw_if_cancelled(progress);
    watch.lap();
    const SecondLook second(subject, found, model);
    adapted.seconds_classify += watch.lap();
    learn(*context, second.rows(), true);
    if (adapted.cancelled) return adapted;
    watch.lap();
    second.apply(*context, found);
    adapted.seconds_classify += watch.lap();
    model.context = std::move(context);
  }
  adapted.found = joined(std::move(found));
  adapted.found.counts = detect::count_classes(adapted.found.classes);
  return adapted;
}

}  // namespace pcednet::annotate
