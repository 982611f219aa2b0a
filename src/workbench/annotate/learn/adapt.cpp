#include "workbench/annotate/learn/adapt.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"
#include "pcednet/core/stopwatch.h"
#include "pcednet/detect/context.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/outputs.h"
#include "pcednet/detect/piece.h"
#include "pcednet/nn/predict.h"
#include "workbench/annotate/learn/outputs.h"

namespace pcednet::annotate {
namespace {

constexpr std::uint64_t kKeptStream = 5;  // of the seed
constexpr double kRate = 0.006;
constexpr std::size_t kPerEpoch = 1 << 13;
// Bound the time of a training, however much is painted.
constexpr std::size_t kFewestUnpainted = 2000, kMostUnpainted = 16000, kMostPainted = 16000;
constexpr double kLeastPainted = 0.3;  // share of the painted among the samples
// The same if some are of a class new to the start: it takes all other points of that class for
// something else.
constexpr double kLeastPaintedOfNew = 0.5;
constexpr float kPlain = 0.05f;         // below, surely no edge; half of the kept points are above
constexpr std::size_t kPart = 1 << 15;  // rows of a task

// The context network reconsiders points from this probability on: below it hardly ever changes a
// prediction, and an adapted network leaves many points there.
constexpr float kLeastEdgeWhenAdapted = 0.03f;

/// The training data of a network.
struct Lesson {
  std::vector<float> values = {}, targets = {};
  std::vector<std::uint8_t> outputs = {};
};

/// The start's probability of an edge class.
float target_of(std::uint8_t edge_class, const detect::Classification& answer, std::uint32_t i) {
  if (edge_class == kSharpEdge) return answer.p_sharp[i];
  if (edge_class == kSmoothEdge) return answer.p_smooth[i];
  return 1.0f - answer.p_sharp[i] - answer.p_smooth[i];
}

/// The deviation of the start from the most common class.
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
  /// `model` learns; `is_context`: its context network, which has edge classes only.
  LessonWriter(const Start& start, const detect::EdgeModel& model,
               std::span<const std::uint8_t> labels, std::uint64_t seed, bool is_context)
      : start_(start), model_(model), labels_(labels), seed_(seed), is_context_(is_context) {
    classes_ = is_context ? detect::edge_outputs(model) : model.classes;
    has_own_ = !is_context && has_own_classes(start.model.table);
  }

  Lesson write(const Rows& rows) const {
    auto [painted, plain, others] = sorted_rows(rows);
    Random random(seed_, kKeptStream);
    const std::size_t kept = std::clamp(painted.size(), kFewestUnpainted, kMostUnpainted);
    choose(painted, kMostPainted, random);
    choose(plain, kept / 2, random);
    choose(others, kept / 2, random);
    const auto unpainted = static_cast<double>(plain.size() + others.size());
    const double share = has_new_outputs() ? kLeastPaintedOfNew : kLeastPainted;
    const double wanted = share / (1 - share) * unpainted;
    const double copies = painted.empty() ? 0 : wanted / static_cast<double>(painted.size());
    std::vector<std::size_t> chosen;
    for (int k = 0; k < std::max(1, static_cast<int>(std::lround(copies))); ++k) {
      chosen.insert(chosen.end(), painted.begin(), painted.end());
    }
    const std::size_t first_kept = chosen.size();
    chosen.insert(chosen.end(), plain.begin(), plain.end());
    chosen.insert(chosen.end(), others.begin(), others.end());
    Lesson lesson = read(rows, chosen, first_kept);
    add_painted_targets(lesson, first_kept);
    add_kept_targets(rows, std::span(chosen).subspan(first_kept), lesson);
    return lesson;
  }

 private:
  struct SortedRows {
    std::vector<std::size_t> painted = {}, plain = {}, others = {};
  };

  SortedRows sorted_rows(const Rows& rows) const {
    enum Kind : std::uint8_t { kOut, kPainted, kIsPlain, kOther };
    std::vector<std::uint8_t> kinds(rows.points.size());
    parallel_blocks(kinds.size(), kPart, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        const std::uint32_t i = rows.points[row];
        const std::uint8_t label = labels_[i];
        const bool out = label == kLeftOut || (is_context_ && is_own(label));
        const bool is_plain = doubt_of(start_.answer, i) < kPlain;
        kinds[row] = out ? kOut : label != kUnlabelled ? kPainted : is_plain ? kIsPlain : kOther;
      }
    });
    SortedRows sorted;
    for (std::size_t row = 0; row < kinds.size(); ++row) {
      if (kinds[row] == kPainted) sorted.painted.push_back(row);
      if (kinds[row] == kIsPlain) sorted.plain.push_back(row);
      if (kinds[row] == kOther) sorted.others.push_back(row);
    }
    return sorted;
  }

  /// Values and outputs of the chosen rows, of which those from `first_kept` on are not painted.
  Lesson read(const Rows& rows, std::span<const std::size_t> chosen, std::size_t first_kept) const {
    Lesson lesson{.values = std::vector<float>(chosen.size() * rows.width),
                  .outputs = std::vector<std::uint8_t>(chosen.size())};
    constexpr std::size_t kRows = 512;
    parallel_blocks(chosen.size(), kRows, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        std::ranges::copy(rows.row(chosen[k]),
                          lesson.values.begin() + static_cast<std::ptrdiff_t>(k * rows.width));
        const std::uint32_t i = rows.points[chosen[k]];
        const std::uint8_t its = k < first_kept ? labels_[i] : start_.answer.classes[i];
        // A prediction of a class that the context network lacks counts as non-edge.
        const std::uint8_t output = detect::output_of(its, model_);
        lesson.outputs[k] = output < classes_.size() ? output : std::uint8_t{0};
      }
    });
    return lesson;
  }

  bool has_new_outputs() const {
    return !is_context_ && model_.classes.size() > start_.model.classes.size();
  }

  bool is_own(std::uint8_t label) const {
    return label != kUnlabelled && label > kBoundary && has_edges(model_.table);
  }

  void add_painted_targets(Lesson& lesson, std::size_t painted) const {
    for (std::size_t k = 0; k < painted; ++k) {
      for (std::size_t c = 0; c < classes_.size(); ++c) {
        lesson.targets.push_back(static_cast<float>(c == lesson.outputs[k]));
      }
    }
  }

  /// The start's answers for the rows `kept`, which are the last of the lesson.
  void add_kept_targets(const Rows& rows, std::span<const std::size_t> kept, Lesson& lesson) const {
    std::vector<float> said;
    if (has_own_) {
      said = nn::predict(start_.model.network,
                         std::span(lesson.values).last(kept.size() * rows.width));
    }
    const std::size_t outputs = start_.model.classes.size();
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const auto own =
          has_own_ ? std::span(said).subspan(k * outputs, outputs) : std::span<float>();
      add_targets(rows.points[kept[k]], own, lesson);
    }
  }

  /// `said` holds the outputs of the start's network, empty if it has edge classes only.
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

/// The context network's input from clouds with predictions of the first network.
class SecondLook {
 public:
  SecondLook(std::span<const detect::ContextPlaces> places,
             std::span<const detect::Classification> found, const detect::EdgeModel& model)
      : classes_(detect::edge_outputs(model)), values_(places.size()) {
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto& matrix = matrices_.emplace_back(
          places[k], found[k], static_cast<int>(classes_.size()), model.least_edge);
      values_[k].resize(matrix.points().size() * matrix.width());
      matrix.describe(0, matrix.points().size(), values_[k]);
    }
  }

  Rows rows(std::span<const std::uint32_t> firsts) const {
    std::vector<CloudRows> clouds;
    for (std::size_t k = 0; k < matrices_.size(); ++k) {
      clouds.push_back({matrices_[k].points(), values_[k]});
    }
    return joined_rows(std::move(clouds), firsts, matrices_.front().width());
  }

  void apply(const nn::Model& context, std::span<detect::Classification> found) const {
    for (std::size_t k = 0; k < found.size(); ++k) {
      detect::decide(matrices_[k].points(), nn::predict(context, values_[k]), classes_, found[k]);
    }
  }

 private:
  std::vector<std::uint8_t> classes_;
  std::vector<detect::ContextMatrix> matrices_ = {};
  std::vector<std::vector<float>> values_;  ///< of the matrices
};

}  // namespace

Start make_start(detect::EdgeModel model, const Subject& subject, const Progress* progress) {
  const auto largest = std::max_element(
      subject.clouds.begin(), subject.clouds.end(), [](const auto& a, const auto& b) {
        return a.described.cloud.traits.points < b.described.cloud.traits.points;
      });
  const detect::CloudTraits traits = detect::traits_for(model, largest->described.cloud);
  Start start{.model = detect::suited_to(std::move(model), traits)};
  std::optional<nn::Model> context = std::exchange(start.model.context, {});
  std::vector<detect::Classification> found = classify_each(subject, start.model, progress);
  if (context) {
    const std::vector<std::uint8_t> classes = detect::edge_outputs(start.model);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const auto& [described, positions, curve] = subject.clouds[k];
      const auto& places = start.places.emplace_back(positions, curve, found[k]);
      const detect::ContextMatrix matrix(places, found[k], static_cast<int>(classes.size()),
                                         start.model.least_edge);
      detect::apply_context(*context, classes, matrix, found[k]);
    }
  }
  start.model.context = std::move(context);
  start.answer = joined(std::move(found));
  start.answer.counts = detect::count_classes(start.answer.classes);
  return start;
}

Adapted adapt(const std::string& name, const Start& start, const Subject& subject,
              std::span<const std::uint8_t> labels, std::uint64_t seed,
              const std::function<void(const nn::EpochReport&)>& on_epoch,
              const Progress* progress) {
  Adapted adapted{.model = with_outputs(start.model, subject.table, labels)};
  detect::EdgeModel& model = adapted.model;
  model.least_edge = std::max(model.least_edge, kLeastEdgeWhenAdapted);
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
  std::vector<detect::Classification> found = classify_each(subject, model, progress);
  adapted.seconds_classify = watch.lap();
  if (context) {
    throw_if_cancelled(progress);
    watch.lap();
    const SecondLook second(start.places, found, model);
    adapted.seconds_classify += watch.lap();
    learn(*context, second.rows(first_points(subject)), true);
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

void check_classes_of_start(const detect::EdgeModel& model, const ClassTable& table) {
  if (can_start(model, table)) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("start: the model knows the classes {}, the labels are {}",
                          names_of(model.table), names_of(table)));
}

void check_each_is_labelled(std::span<const detect::NamedLabels> clouds, const ClassTable& table) {
  for (const auto& [name, labels] : clouds) {
    const bool any = std::ranges::any_of(
        labels, [&](std::uint8_t label) { return detect::is_learnt_from(label, table); });
    if (any) continue;
    throw Error(ErrorKind::kInsufficient, fmt::format("{}: no point is labelled", name));
  }
}

detect::TrainedModel adapt_clouds(const std::string& name, const detect::EdgeModel& model,
                                  std::span<const detect::TrainingCloud> clouds,
                                  const ClassTable& table, std::uint64_t seed,
                                  const std::function<void(const nn::EpochReport&)>& on_epoch,
                                  const Progress* progress) {
  check_classes_of_start(model, table);
  Subject subject{.clouds = {}, .table = table};
  std::vector<std::shared_ptr<const Described>> described;
  std::vector<std::uint8_t> labels;
  for (const detect::TrainingCloud& one : clouds) {
    described.push_back(describe_once(one.cloud, model.descriptor, {}, progress));
    subject.clouds.push_back({*described.back(), one.cloud.positions, one.cloud.curve});
    labels.insert(labels.end(), one.labels.begin(), one.labels.end());
  }
  const std::uint8_t unlabelled = kUnlabelled;
  std::ranges::replace_if(
      labels, [&](std::uint8_t label) { return !detect::is_learnt_from(label, table); },
      unlabelled);
  detect::TrainedModel trained;
  trained.adapted = true;
  Adapted adapted = adapt(
      name, make_start(model, subject, progress), subject, labels, seed,
      [&](const nn::EpochReport& report) {
        trained.epochs = report.epoch;
        if (on_epoch) on_epoch(report);
      },
      progress);
  if (adapted.cancelled) throw Error(ErrorKind::kCancelled, "stopped by the user");
  trained.model = std::move(adapted.model);
  return trained;
}

}  // namespace pcednet::annotate
