#include "workbench/annotate/learn.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "pcednet/core/error.h"
#include "pcednet/core/stopwatch.h"
#include "pcednet/formats/read_cloud.h"

namespace pcednet::annotate {
namespace {

/// Rounds of training: fewer than for a data set, as the painted points are few and the user waits.
constexpr int kEpochs = 20;

/// However much is painted, a training takes no longer than this many samples a round.
constexpr std::size_t kMostPerEpoch = 1 << 15;

/// The bias of an output that no input can make up for.
constexpr float kNever = -1e4f;

detect::Samples painted_samples(const Described& described, std::span<const std::uint8_t> labels) {
  const auto& [points, order, values, scales] = described.cloud;
  const std::size_t width = order.empty() ? 0 : values.size() / order.size();
  detect::Samples samples{.descriptor = described.descriptor, .clouds = 1, .points = points};
  for (std::size_t row = 0; row < order.size(); ++row) {
    const std::uint8_t label = labels[order[row]];
    if (label > kSharpEdge) continue;
    samples.labels.push_back(label);
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * width);
    samples.values.insert(samples.values.end(), first, first + static_cast<std::ptrdiff_t>(width));
  }
  return samples;
}

}  // namespace

int classes_to_learn(std::span<const std::uint8_t> labels, const Settings& settings) {
  const auto any = [&](std::uint8_t c) {
    return std::find(labels.begin(), labels.end(), c) != labels.end();
  };
  const bool smooth = any(kSmoothEdge);
  const char* missing = !any(kSharpEdge)                                       ? "sharp-edge"
                        : !any(kNonEdge) && (settings.classes == 3 || !smooth) ? "non-edge"
                                                                               : nullptr;
  if (missing) {
    throw Error(ErrorKind::kInsufficient, fmt::format("paint some {} points first", missing));
  }
  return settings.classes == 3 && smooth ? 3 : 2;
}

void check_can_learn(std::span<const std::uint8_t> labels, const Settings& settings) {
  if (settings.start == kRandomStart) {
    classes_to_learn(labels, settings);
  } else if (std::none_of(labels.begin(), labels.end(), [](auto c) { return c <= kSharpEdge; })) {
    throw Error(ErrorKind::kInsufficient, "paint some points first");
  }
}

gls::ScaleSpaceOptions descriptor_of(const detect::EdgeModel* start) {
  return start ? start->descriptor : gls::ScaleSpaceOptions{};
}

detect::EdgeModel with_classes(detect::EdgeModel model, int classes) {
  if (classes == 3 || model.classes.size() != 3) return model;
  auto& network = (model.context ? *model.context : model.network).network;
  network.parameters[nn::make_plan(network.architecture).layers.back().bias + kSmoothEdge] = kNever;
  return model;
}

int epochs_of(const Start* start) {
  if (!start) return kEpochs;
  return start->model.context ? 2 * kAdaptEpochs : kAdaptEpochs;
}

Adapted learn(const std::string& name, const Subject& subject, std::span<const std::uint8_t> labels,
              const Settings& settings, const Start* start,
              const std::function<void(const nn::EpochReport&)>& on_epoch,
              const Progress* progress) {
  if (start) {
    std::vector<std::uint8_t> wanted(labels.begin(), labels.end());
    if (settings.classes == 2) std::replace(wanted.begin(), wanted.end(), kSmoothEdge, kNonEdge);
    return adapt(name, *start, subject, wanted, settings.seed, on_epoch, progress);
  }
  detect::TrainOptions options;
  options.architecture.classes = classes_to_learn(labels, settings);
  options.training.seed = settings.seed;
  options.training.epochs = kEpochs;
  options.training.most_per_epoch = kMostPerEpoch;
  Adapted learnt;
  auto trained = detect::train(
      name, painted_samples(subject.described, labels), options,
      [&](const nn::EpochReport& report) {
        learnt.loss = report.training_loss;
        if (on_epoch) on_epoch(report);
      },
      progress);
  learnt.cancelled = trained.cancelled || trained.epochs == 0;
  learnt.model = std::move(trained.model);
  if (learnt.cancelled) return learnt;
  Stopwatch watch;
  learnt.found = detect::classify(subject.described.cloud, subject.positions, learnt.model);
  learnt.seconds_classify = watch.lap();
  return learnt;
}

detect::TrainedModel learn_project(
    const Project& project, const std::filesystem::path& input,
    const std::function<detect::EdgeModel(const std::string& name)>& load_start,
    const std::function<void(const nn::EpochReport&)>& on_epoch, const Progress* progress) {
  if (digest_of_file(input) != project.input.digest) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: not the file that the project is about", input.string()));
  }
  const auto loaded = formats::read_cloud(input);
  if (loaded.cloud.size() != project.input.points) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: {} points where the project has {}", input.string(),
                            loaded.cloud.size(), project.input.points));
  }
  Replayed end = replay(project.records, project.input.points);
  Settings settings = end.settings;
  if (end.run) {
    settings = end.run->settings;
    end.labels = labels_of(*end.run, project.records, project.input.points);
  }
  std::optional<detect::EdgeModel> model;
  if (settings.start != kRandomStart) {
    model = with_classes(load_start(settings.start), settings.classes);
  }
  const detect::PreparedCloud prepared = detect::prepare(loaded.cloud, {}, progress);
  const auto described =
      describe_once(prepared, descriptor_of(model ? &*model : nullptr), {}, progress);
  const Subject subject{*described, prepared.positions, prepared.curve};
  std::optional<Start> start;
  if (model) start = make_start(std::move(*model), subject);
  int epochs = 0;
  Adapted learnt = learn(
      input.stem().string(), subject, end.labels.classes(), settings, start ? &*start : nullptr,
      [&](const nn::EpochReport& report) {
        epochs = report.epoch;
        if (on_epoch) on_epoch(report);
      },
      progress);
  if (start && learnt.cancelled) throw Error(ErrorKind::kCancelled, "stopped by the user");
  return {.model = std::move(learnt.model), .cancelled = learnt.cancelled, .epochs = epochs};
}

}  // namespace pcednet::annotate
