#include "workbench/annotate/learn/learn.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "pcednet/core/error.h"
#include "pcednet/core/stopwatch.h"
#include "pcednet/formats/read_cloud.h"

namespace pcednet::annotate {
namespace {

/// Epochs of training: fewer than for a data set, as the painted points are few and the user waits.
constexpr int kEpochs = 20;

/// The most samples per epoch, however much is painted.
constexpr std::size_t kMostPerEpoch = 1 << 15;

detect::Samples painted_samples(const Subject& subject, std::span<const std::uint8_t> labels) {
  detect::Samples samples{.descriptor = subject.clouds.front().described.descriptor,
                          .clouds = subject.clouds.size()};
  for (const SubjectCloud& one : subject.clouds) samples.points += one.described.cloud.points;
  const Rows rows = described_rows(subject);
  for (std::size_t row = 0; row < rows.points.size(); ++row) {
    const std::uint8_t label = labels[rows.points[row]];
    if (label >= subject.table.size()) continue;
    samples.labels.push_back(label);
    const std::span<const float> values = rows.row(row);
    samples.values.insert(samples.values.end(), values.begin(), values.end());
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

void check_can_learn(std::span<const std::uint8_t> labels, const Settings& settings,
                     const ClassTable& table) {
  if (settings.start == kRandomStart && !has_own_classes(table)) {
    classes_to_learn(labels, settings);
    return;
  }
  std::set<std::uint8_t> painted;
  for (const std::uint8_t label : labels) {
    if (label < table.size()) painted.insert(label);
  }
  if (settings.start == kRandomStart && painted.size() < 2) {
    throw Error(ErrorKind::kInsufficient, "paint points of two classes first");
  }
  if (painted.empty()) throw Error(ErrorKind::kInsufficient, "paint some points first");
}

gls::ScaleSpaceOptions descriptor_of(const detect::EdgeModel* start) {
  return start ? start->descriptor : gls::ScaleSpaceOptions{};
}

int epochs_of(const Start* start) {
  if (!start) return kEpochs;
  return kAdaptEpochs + context_epochs_of(start);
}

int context_epochs_of(const Start* start) {
  return start && start->model.context ? kAdaptEpochs : 0;
}

Adapted learn(const std::string& name, const Subject& subject, std::span<const std::uint8_t> labels,
              const Settings& settings, const Start* start,
              const std::function<void(const nn::EpochReport&)>& on_epoch,
              const Progress* progress) {
  const ClassTable& table = subject.table;
  const bool own = has_own_classes(table);
  std::vector<std::uint8_t> wanted(labels.begin(), labels.end());
  if (settings.classes == 2 && has_edges(table) && (start || own)) {
    std::replace(wanted.begin(), wanted.end(), kSmoothEdge, kNonEdge);
  }
  if (start) return adapt(name, *start, subject, wanted, settings.seed, on_epoch, progress);
  detect::TrainOptions options;
  options.table = table;
  if (own) {
    check_can_learn(wanted, settings, table);
  } else {
    options.architecture.classes = classes_to_learn(labels, settings);
  }
  options.training.seed = settings.seed;
  options.training.epochs = kEpochs;
  options.training.most_per_epoch = kMostPerEpoch;
  Adapted learnt;
  auto trained = detect::train(
      name, painted_samples(subject, wanted), options,
      [&](const nn::EpochReport& report) {
        learnt.loss = report.training_loss;
        if (on_epoch) on_epoch(report);
      },
      progress);
  learnt.cancelled = trained.cancelled || trained.epochs == 0;
  learnt.model = std::move(trained.model);
  if (learnt.cancelled) return learnt;
  Stopwatch watch;
  learnt.found = classify(subject, learnt.model, progress);
  learnt.seconds_classify = watch.lap();
  return learnt;
}

namespace {

io::LoadedCloud read_input(const InputIdentity& its, const std::filesystem::path& input) {
  if (digest_of_file(input) != its.digest) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: not the file that the project is about: put back the one that was "
                            "painted, or name its place",
                            input.string()));
  }
  auto loaded = formats::read_cloud(input);
  if (loaded.cloud.size() != its.points) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: {} points where the project has {}", input.string(),
                            loaded.cloud.size(), its.points));
  }
  return loaded;
}

}  // namespace

bool is_another(const RunRecord& run, double loss) {
  return run.facts.loss && *run.facts.loss != loss;
}

std::string not_reproduced(int run) {
  return fmt::format(
      "run {} cannot be reproduced exactly: another version of pcednet or of its "
      "start model made it",
      run);
}

detect::TrainedModel learn_project(const Project& project, const ProjectFiles& files,
                                   const std::function<void(const nn::EpochReport&)>& on_epoch,
                                   const Progress* progress) {
  const std::size_t points = points_of(project.inputs);
  Replayed end = replay(project.records, points);
  Settings settings = end.settings;
  std::size_t clouds = project.inputs.size();
  if (end.run) {
    settings = end.run->settings;
    clouds = std::min(clouds, end.run->clouds);
    end.labels = labels_of(*end.run, project.records, points);
  }
  std::optional<detect::EdgeModel> model;
  if (settings.start != kRandomStart) {
    model = with_classes(files.load_start(settings.start), settings.classes);
    check_start(*model, settings.start, end.classes.table);
  }
  std::vector<ProjectCloud> all(clouds);
  Subject subject{.clouds = {}, .table = end.classes.table};
  for (std::size_t k = 0; k < clouds; ++k) {
    ProjectCloud& one = all[k];
    one.file = files.input_of(k);
    one.loaded = read_input(project.inputs[k], one.file);
    with_name_in_errors(one.file.string(),
                        [&] { one.prepared = detect::prepare(one.loaded.cloud, {}, progress); });
    one.described =
        describe_once(one.prepared, descriptor_of(model ? &*model : nullptr), {}, progress);
    if (files.on_cloud) files.on_cloud(one);
    subject.clouds.push_back({*one.described, one.prepared.positions, one.prepared.curve});
  }
  std::optional<Start> start;
  if (model) start = make_start(std::move(*model), subject, progress);
  nn::EpochReport last;
  const std::size_t seen = points_of(std::span(project.inputs).first(clouds));
  Adapted learnt = learn(
      all.front().file.stem().string(), subject, std::span(end.labels.classes()).first(seen),
      settings, start ? &*start : nullptr,
      [&](const nn::EpochReport& report) {
        last = report;
        if (on_epoch) on_epoch(report);
      },
      progress);
  if (start && learnt.cancelled) throw Error(ErrorKind::kCancelled, "stopped by the user");
  detect::TrainedModel trained{.model = std::move(learnt.model),
                               .cancelled = learnt.cancelled,
                               .epochs = last.epoch,
                               .validated = last.is_validated(),
                               .adapted = start.has_value()};
  if (end.run && !learnt.cancelled && is_another(*end.run, learnt.loss)) {
    trained.notes.push_back(not_reproduced(end.run->number));
  }
  return trained;
}

}  // namespace pcednet::annotate
