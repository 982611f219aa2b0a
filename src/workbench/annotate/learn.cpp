#include "workbench/annotate/learn.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "pcednet/formats/read_cloud.h"

namespace pcednet::annotate {
namespace {

/// However much is painted, a training takes no longer than this many samples a round.
constexpr std::size_t kMostPerEpoch = 1 << 15;

detect::Samples painted_samples(const Described& described, std::span<const std::uint8_t> labels) {
  const auto& [points, order, values] = described.cloud;
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

gls::ScaleSpaceOptions descriptor_of(const detect::EdgeModel* start) {
  return start ? start->descriptor : gls::ScaleSpaceOptions{};
}

detect::EdgeModel with_classes(const detect::EdgeModel& model, int classes) {
  if (static_cast<int>(model.classes.size()) == classes) return model;
  if (model.classes.size() != 3 || classes != 2) {
    throw Error(ErrorKind::kModelMismatch, fmt::format("{}: has {} classes, {} are wanted",
                                                       model.name, model.classes.size(), classes));
  }
  detect::EdgeModel fewer = model;
  fewer.classes = {kNonEdge, kSharpEdge};
  auto& network = fewer.network.network;
  network.architecture.classes = 2;
  const auto& names = model.network.class_names;
  if (names.size() == 3) fewer.network.class_names = {names[0], names[2]};
  const nn::Layer last = nn::make_plan(model.network.network.architecture).layers.back();
  auto& parameters = network.parameters;
  const auto at = [&](std::size_t i) {
    return parameters.begin() + static_cast<std::ptrdiff_t>(i);
  };
  // The biases follow their weights, which have a row per output.
  const std::size_t row = (last.bias - last.weight) / 3;
  parameters.erase(at(last.bias + 1));
  parameters.erase(at(last.weight + row), at(last.weight + 2 * row));
  nn::check_consistent(fewer.network);
  return fewer;
}

detect::TrainedModel learn(const std::string& name, const Described& described,
                           std::span<const std::uint8_t> labels, const Settings& settings,
                           const detect::EdgeModel* start,
                           const std::function<void(const nn::EpochReport&)>& on_epoch,
                           const Progress* progress) {
  const int classes = classes_to_learn(labels, settings);
  const detect::Samples samples = painted_samples(described, labels);
  detect::TrainOptions options;
  options.architecture.classes = classes;
  options.training.seed = settings.seed;
  options.training.epochs = kEpochs;
  options.training.most_per_epoch = kMostPerEpoch;
  std::optional<detect::EdgeModel> from;
  if (start) {
    from = with_classes(*start, classes);
    options.architecture = from->network.network.architecture;
    options.training.start = &from->network;
    // A smaller step: what the model knows is to be adapted, not forgotten.
    options.training.learning_rate *= 0.3;
  }
  return detect::train(name, samples, options, on_epoch, progress);
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
  std::optional<detect::EdgeModel> start;
  if (settings.start != kRandomStart) start = load_start(settings.start);
  const detect::PreparedCloud prepared = detect::prepare(loaded.cloud, {}, progress);
  const auto described =
      describe_once(prepared, descriptor_of(start ? &*start : nullptr), {}, progress);
  return learn(input.stem().string(), *described, end.labels.classes(), settings,
               start ? &*start : nullptr, on_epoch, progress);
}

}  // namespace pcednet::annotate
