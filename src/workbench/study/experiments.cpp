#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "workbench/shapes/recipe.h"
#include "workbench/shapes/surfaces/default_shapes.h"
#include "workbench/study/plan.h"

namespace pcednet::study {
namespace {

constexpr int kQuickEpochs = 10;
constexpr int kQuickOneIn = 5;

/// The network that an experiment varies.
NetworkMethod network(const PlanOptions& options) {
  NetworkMethod method{.options = options.training};
  if (options.quick) {
    method.options.training.epochs = std::min(method.options.training.epochs, kQuickEpochs);
    method.one_in = kQuickOneIn;
  }
  return method;
}

NetworkMethod network(const PlanOptions& options, nn::NetworkKind kind, int classes) {
  NetworkMethod method = network(options);
  method.options.architecture.kind = kind;
  method.options.architecture.classes = classes;
  return method;
}

struct KindName {
  nn::NetworkKind kind;
  const char *id, *title;
};
constexpr KindName kKinds[] = {{nn::NetworkKind::kPcednet, "pcednet", "PCEDNet"},
                               {nn::NetworkKind::kFc, "fc", "FC"},
                               {nn::NetworkKind::kCnn, "cnn", "CNN"}};

void add_models(Experiment& experiment, const PlanOptions& options) {
  for (const auto& [id, file] : options.models) {
    experiment.variants.push_back({.id = id,
                                   .title = fmt::format("model {}", id),
                                   .method = ModelMethod{file, options.training.descriptor.engine},
                                   .note = "as shipped, trained on other clouds"});
  }
}

void add_outside_methods(Experiment& experiment, const PlanOptions& options) {
  add_models(experiment, options);
  for (const NamedMethod& classic : options.classic) {
    experiment.variants.push_back({.id = classic.id,
                                   .title = classic.title,
                                   .method = classic.method,
                                   .note = "no training: " + classic.method.settings});
  }
  for (const auto& [id, folder] : options.predictions) {
    experiment.variants.push_back(
        {.id = id, .title = id, .method = ExternalMethod{folder}, .note = "classes from files"});
  }
}

Experiment methods(const PlanOptions& options) {
  Experiment experiment{.name = "methods",
                        .title = "Methods",
                        .question = "Which method finds the edges best, trained on the same data?",
                        .both_positives = true,
                        .curves = true};
  for (const KindName& name : kKinds) {
    experiment.variants.push_back(
        {.id = name.id, .title = name.title, .method = network(options, name.kind, 3)});
    experiment.variants.push_back({.id = fmt::format("{}-2c", name.id),
                                   .title = fmt::format("{}-2C", name.title),
                                   .method = network(options, name.kind, 2),
                                   .note = "two classes: smooth-edge counts as non-edge"});
  }
  add_outside_methods(experiment, options);
  return experiment;
}

Experiment reconstructions(const PlanOptions& options) {
  Experiment experiment{.name = "reconstructions",
                        .title = "Surface reconstruction",
                        .question =
                            "Which surface should be described: a plane or a sphere, where "
                            "the point lies or after moving the point onto it?"};
  constexpr const char* kTitles[] = {"covariance plane", "plane, MLS", "sphere", "sphere, MLS"};
  const auto names = gls::reconstruction_names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    NetworkMethod method = network(options);
    method.options.descriptor.reconstruction = static_cast<gls::Reconstruction>(i);
    experiment.variants.push_back(
        {.id = std::string(names[i]), .title = kTitles[i], .method = std::move(method)});
  }
  return experiment;
}

Experiment features(const PlanOptions& options) {
  Experiment experiment{.name = "features",
                        .title = "Features of a scale",
                        .question = "Which of the numbers that describe a scale are needed?"};
  constexpr std::pair<gls::FeatureSet, const char*> kSets[] = {
      {gls::FeatureSet::kAll28, "28: all derivatives"},
      {gls::FeatureSet::kInvariant7, "7: invariant to rigid motions"},
      {gls::FeatureSet::kPaper6, "6: without k2, the default"},
      {gls::FeatureSet::kSpatial4, "4: no derivatives by scale"},
      {gls::FeatureSet::kRelief3, "3: no curvatures"}};
  for (const auto& [set, title] : kSets) {
    NetworkMethod method = network(options);
    method.options.descriptor.features = set;
    experiment.variants.push_back({.id = fmt::format("features{}", gls::feature_count(set)),
                                   .title = title,
                                   .method = std::move(method)});
  }
  return experiment;
}

Experiment classes(const PlanOptions& options) {
  Experiment experiment{.name = "classes",
                        .title = "Two or three classes",
                        .question = "Does a class of smooth edges help to find the sharp ones?",
                        .both_positives = true};
  for (const int count : {3, 2}) {
    NetworkMethod method = network(options);
    method.options.architecture.classes = count;
    experiment.variants.push_back({.id = fmt::format("classes{}", count),
                                   .title = fmt::format("{} classes", count),
                                   .method = std::move(method)});
  }
  return experiment;
}

/// The three ideas of docs/accuracy.md, one at a time and together.
Experiment additions(const PlanOptions& options) {
  Experiment experiment{.name = "additions",
                        .title = "Beyond the paper",
                        .question = "How much do two gates, context and distillation bring?"};
  const auto add = [&](const char* id, const char* title, bool gates, bool context, bool distil) {
    NetworkMethod method = network(options);
    if (gates) {
      method.options.descriptor.side_gate = 0.4;
      method.options.descriptor.second_gate = -0.3;
    }
    if (context) method.options.context = true;
    if (distil) method.options.teachers = 3;
    experiment.variants.push_back({.id = id, .title = title, .method = std::move(method)});
  };
  add("plain", "none of them", false, false, false);
  add("gates", "two gates, 0.4 and -0.3", true, false, false);
  add("context", "a context network", false, true, false);
  add("distilled", "distilled from three", false, false, true);
  add("all", "all three", true, true, true);
  add_models(experiment, options);
  return experiment;
}

Experiment scales(const PlanOptions& options) {
  Experiment experiment{.name = "scales",
                        .title = "Number of scales",
                        .question = "How many scales are enough, and what does each cost?",
                        .x_label = "scales"};
  for (int count = gls::kMinScales; count <= (options.quick ? 32 : gls::kMaxScales); count *= 2) {
    NetworkMethod method = network(options);
    method.options.descriptor.scales = count;
    experiment.variants.push_back({.id = fmt::format("scales-{}", count),
                                   .title = fmt::format("{} scales", count),
                                   .method = std::move(method),
                                   .x = count});
  }
  return experiment;
}

Experiment range(const PlanOptions& options) {
  Experiment experiment{
      .name = "range",
      .title = "Largest scale",
      .question = "Does a network tolerate other ranges of scales than it was trained with?",
      .x_label = "largest scale / diagonal of the cloud"};
  for (const double fraction : {0.02, 0.05, 0.1, 0.2, 0.5}) {
    NetworkMethod method = network(options);
    method.s_max_fraction = fraction;
    experiment.variants.push_back({.id = fmt::format("largest-{}", fraction),
                                   .title = fmt::format("up to {}", fraction),
                                   .method = std::move(method),
                                   .x = fraction});
  }
  return experiment;
}

Experiment learning(const PlanOptions& options) {
  Experiment experiment{.name = "learning",
                        .title = "Learning",
                        .question =
                            "How fast do the networks learn, with our recipe and with the "
                            "published one?",
                        .curves = true};
  for (const KindName& name : kKinds) {
    experiment.variants.push_back(
        {.id = name.id,
         .title = name.title,
         .method = network(options, name.kind, options.training.architecture.classes)});
  }
  NetworkMethod natural = network(options);
  natural.options.training.balance = 0.0;
  experiment.variants.push_back({.id = "natural",
                                 .title = "PCEDNet, natural shares",
                                 .method = natural,
                                 .note = "every class counts as often as it occurs"});
  NetworkMethod published = network(options);
  const int epochs = published.options.training.epochs;
  published.options.training = nn::paper_recipe();
  if (options.quick) published.options.training.epochs = epochs;
  experiment.variants.push_back({.id = "published",
                                 .title = "PCEDNet, published recipe",
                                 .method = published,
                                 .note = "SGD with momentum, batches of 100, raw inputs"});
  return experiment;
}

Experiment density(const PlanOptions& options) {
  Experiment experiment{.name = "density",
                        .title = "Density",
                        .question = "What is lost when only a part of the points is left?",
                        .x_label = "share of the points"};
  for (const double share : {1.0, 0.5, 0.25, 0.125, 0.0625}) {
    experiment.variants.push_back({.id = fmt::format("share-{}", share),
                                   .title = fmt::format("{} of the points", share),
                                   .method = network(options),
                                   .x = share,
                                   .treatment = {.keep = share}});
  }
  return experiment;
}

Experiment noise(const PlanOptions& options) {
  Experiment experiment{.name = "noise",
                        .title = "Noise",
                        .question =
                            "How much noise does a network tolerate, and what do clean "
                            "normals hide?",
                        .x_label = "standard deviation / diagonal of the cloud"};
  struct Line {
    const char *id, *title;
    Treatment treatment;
  };
  const Line lines[] = {
      {"isotropic", "every way, normals given", {}},
      {"normal", "along the normal, normals given", {.along_normal = true}},
      {"estimated", "every way, normals estimated after", {.estimate_normals = true}}};
  for (const Line& line : lines) {
    for (const double sigma : {0.0, 0.001, 0.002, 0.004, 0.008, 0.016}) {
      if (options.quick && sigma != 0.0 && sigma != 0.002 && sigma != 0.008) continue;
      Treatment treatment = line.treatment;
      treatment.noise = sigma;
      experiment.variants.push_back({.id = fmt::format("{}-{}", line.id, sigma),
                                     .title = fmt::format("{}, {}", line.title, sigma),
                                     .method = network(options),
                                     .x = sigma,
                                     .treatment = treatment});
    }
  }
  return experiment;
}

/// Four joined cubes with exact normals, for measuring costs.
std::shared_ptr<const CloudSet> generated_cloud(std::size_t points, std::uint64_t seed) {
  const shapes::Recipe recipe{.name = fmt::format("cubes_{}", points),
                              .shape = shapes::four_cubes(),
                              .points = points,
                              .normals = shapes::NormalSource::kSurface};
  CloudSet set{.name = "generated", .positive = eval::Positive::kEdge};
  set.clouds.push_back(make_study_cloud(recipe.name, "", shapes::generate(recipe, seed).cloud));
  return std::make_shared<const CloudSet>(std::move(set));
}

Experiment timing(const PlanOptions& options) {
  Experiment experiment{.name = "timing",
                        .title = "Time",
                        .question = "How long do training and classification take as clouds grow?",
                        .x_label = "points",
                        .timed = true};
  for (const std::size_t points : {10'000, 30'000, 100'000, 300'000, 1'000'000}) {
    if (options.quick && points > 100'000) continue;
    const auto training = generated_cloud(points, 1), test = generated_cloud(points, 2);
    for (const KindName& name : kKinds) {
      PlanOptions full = options;
      full.quick = false;  // fewer epochs would take another time
      experiment.variants.push_back(
          {.id = fmt::format("{}-{}", name.id, points),
           .title = fmt::format("{}, {} points", name.title, points),
           .method = network(full, name.kind, options.training.architecture.classes),
           .x = static_cast<double>(points),
           .training = training,
           .test = test});
    }
  }
  return experiment;
}

Experiment energy(const PlanOptions& options) {
  Experiment experiment{.name = "energy",
                        .title = "Energy",
                        .question =
                            "How many joules do a thousand points take, in training and in "
                            "classification?",
                        .timed = true};
  const std::size_t points = options.quick ? 20'000 : 200'000;
  const auto training = generated_cloud(points, 1), test = generated_cloud(points, 2);
  const auto add = [&](const std::string& id, const std::string& title, nn::NetworkKind kind,
                       Phase phase) {
    PlanOptions full = options;
    full.quick = false;
    experiment.variants.push_back(
        {.id = id,
         .title = title,
         .method = network(full, kind, options.training.architecture.classes),
         .training = training,
         .test = test,
         .phase = phase});
  };
  add("train-describe", "describe, for training", nn::NetworkKind::kPcednet,
      Phase::kDescribeTraining);
  for (const KindName& name : kKinds) {
    add(fmt::format("train-{}", name.id), fmt::format("train {}", name.title), name.kind,
        Phase::kTrain);
  }
  add("describe", "describe", nn::NetworkKind::kPcednet, Phase::kDescribe);
  for (const KindName& name : kKinds) {
    add(fmt::format("classify-{}", name.id), fmt::format("classify with {}", name.title), name.kind,
        Phase::kClassify);
  }
  return experiment;
}

}  // namespace

const std::vector<ExperimentEntry>& experiments() {
  static const std::vector<ExperimentEntry> kEntries = {
      {"methods", "networks of the same data, shipped models, other methods side by side", methods},
      {"features", "28, 7, 6, 4 or 3 numbers per scale", features},
      {"classes", "two classes against three", classes},
      {"scales", "4 to 128 scales", scales},
      {"range", "largest scale from .02 to .5 of the diagonal", range},
      {"density", "test clouds thinned to a sixteenth", density},
      {"noise", "noise every way and along the normals, clean and estimated normals", noise},
      {"reconstructions", "plane or sphere, with and without projection", reconstructions},
      {"additions", "two gates, context and distillation, beside shipped models", additions},
      {"learning", "loss and held-out scores per epoch, our recipe and the published one",
       learning},
      {"timing", "seconds of training and classification by method and number of points", timing},
      {"energy", "joules per thousand points", energy},
  };
  return kEntries;
}

Experiment make_experiment(std::string_view name, const PlanOptions& options) {
  std::string known;
  for (const ExperimentEntry& entry : experiments()) {
    if (entry.name == name) return entry.make(options);
    known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
  }
  throw Error(ErrorKind::kUsage, fmt::format("no experiment {}: there are {}", name, known));
}

}  // namespace pcednet::study
