#include "workbench/annotate/adapt.h"

#include <algorithm>
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

namespace pcednet::annotate {
namespace {

constexpr std::uint64_t kKeptStream = 5;  // of the seed
constexpr double kRate = 0.006;
constexpr std::size_t kPerEpoch = 1 << 13;
// However much is painted, a training takes no longer.
constexpr std::size_t kFewestUnpainted = 2000, kMostUnpainted = 16000, kMostPainted = 16000;
constexpr double kLeastPainted = 0.3;  // share of the painted among the samples
constexpr float kPlain = 0.05f;        // so sure to be no edge; half of the kept points are others

/// What a network learns from.
struct Lesson {
  std::vector<float> values = {}, targets = {};
  std::vector<std::uint8_t> outputs = {};
};

float target_of(std::uint8_t edge_class, const detect::Classification& answer, std::uint32_t i) {
  if (edge_class == kSharpEdge) return answer.p_sharp[i];
  if (edge_class == kSmoothEdge) return answer.p_smooth[i];
  return 1.0f - answer.p_sharp[i] - answer.p_smooth[i];
}

/// The first `count` of `rows` in random order.
void choose(std::vector<std::size_t>& rows, std::size_t count, Random& random) {
  random.shuffle(std::span(rows));
  rows.resize(std::min(rows.size(), count));
}

class LessonWriter {
 public:
  LessonWriter(const Start& start, std::span<const std::uint8_t> labels, std::uint64_t seed)
      : start_(start), labels_(labels), seed_(seed) {}

  Lesson write(const Rows& rows) const {
    std::vector<std::size_t> painted, plain, others;
    const detect::Classification& answer = start_.answer;
    for (std::size_t row = 0; row < rows.points.size(); ++row) {
      const std::uint32_t i = rows.points[row];
      if (labels_[i] == kLeftOut) continue;
      const bool is_plain = answer.p_sharp[i] + answer.p_smooth[i] < kPlain;
      (labels_[i] != kUnlabelled ? painted : is_plain ? plain : others).push_back(row);
    }
    Random random(seed_, kKeptStream);
    const std::size_t kept = std::clamp(painted.size(), kFewestUnpainted, kMostUnpainted);
    choose(painted, kMostPainted, random);
    choose(plain, kept / 2, random);
    choose(others, kept / 2, random);
    Lesson lesson;
    const auto unpainted = static_cast<double>(plain.size() + others.size());
    const double wanted = kLeastPainted / (1 - kLeastPainted) * unpainted;
    const double copies = painted.empty() ? 0 : wanted / static_cast<double>(painted.size());
    for (int k = 0; k < std::max(1, static_cast<int>(std::lround(copies))); ++k) {
      for (const std::size_t row : painted) add_painted(rows, row, lesson);
    }
    for (const auto* some : {&plain, &others}) {
      for (const std::size_t row : *some) add_kept(rows, row, lesson);
    }
    return lesson;
  }

 private:
  void add_row(const Rows& rows, std::size_t row, std::uint8_t edge_class, Lesson& lesson) const {
    lesson.values.resize(lesson.values.size() + rows.width);
    rows.read(row, &*lesson.values.end() - rows.width);
    lesson.outputs.push_back(detect::output_of(edge_class, start_.model.classes));
  }

  void add_painted(const Rows& rows, std::size_t row, Lesson& lesson) const {
    add_row(rows, row, labels_[rows.points[row]], lesson);
    for (std::size_t c = 0; c < start_.model.classes.size(); ++c) {
      lesson.targets.push_back(static_cast<float>(c == lesson.outputs.back()));
    }
  }

  void add_kept(const Rows& rows, std::size_t row, Lesson& lesson) const {
    const std::uint32_t i = rows.points[row];
    add_row(rows, row, start_.answer.classes[i], lesson);
    for (const std::uint8_t c : start_.model.classes) {
      lesson.targets.push_back(target_of(c, start_.answer, i));
    }
  }

  const Start& start_;
  std::span<const std::uint8_t> labels_;
  std::uint64_t seed_;
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
  SecondLook(const Subject& subject, std::span<const detect::Classification> found, int classes)
      : firsts_(first_points(subject)) {
    for (std::size_t k = 0; k < subject.clouds.size(); ++k) {
      const auto& [described, positions, curve] = subject.clouds[k];
      matrices_.emplace_back(positions, curve, found[k], classes);
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

  void apply(const nn::Model& context, const detect::EdgeModel& model,
             std::span<detect::Classification> found) const {
    for (std::size_t k = 0; k < found.size(); ++k) {
      detect::apply_context(context, model.classes, matrices_[k], found[k]);
    }
  }

 private:
  std::vector<std::uint32_t> firsts_;
  std::deque<detect::ContextMatrix> matrices_ = {};
};

}  // namespace

Start make_start(detect::EdgeModel model, const Subject& subject) {
  Start start{.model = std::move(model)};
  start.answer = classify(subject, start.model);
  return start;
}

Adapted adapt(const std::string& name, const Start& start, const Subject& subject,
              std::span<const std::uint8_t> labels, std::uint64_t seed,
              const std::function<void(const nn::EpochReport&)>& on_epoch,
              const Progress* progress) {
  Adapted adapted{.model = start.model};
  detect::EdgeModel& model = adapted.model;
  const LessonWriter writer(start, labels, seed);
  int epochs_before = 0;
  const auto learn = [&](nn::Model& network, const Rows& rows) {
    const Lesson lesson = writer.write(rows);
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
  learn(model.network, described_rows(subject));
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
    const SecondLook second(subject, found, static_cast<int>(model.classes.size()));
    adapted.seconds_classify += watch.lap();
    learn(*context, second.rows());
    if (adapted.cancelled) return adapted;
    watch.lap();
    second.apply(*context, model, found);
    adapted.seconds_classify += watch.lap();
    model.context = std::move(context);
  }
  adapted.found = joined(std::move(found));
  adapted.found.counts = detect::count_classes(adapted.found.classes);
  return adapted;
}

}  // namespace pcednet::annotate
