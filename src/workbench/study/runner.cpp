#include "workbench/study/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <variant>

#include "pcednet/core/digest.h"
#include "pcednet/core/error.h"
#include "pcednet/io/input_file.h"
#include "workbench/study/cache.h"
#include "workbench/study/work.h"

namespace pcednet::study {
namespace {

/// A network in use: trained here, or from a file.
struct Classifier {
  std::string key;
  std::shared_ptr<const StoredModel> model = {};
  gls::ScaleSpaceOptions descriptor = {};  ///< with which it classifies
  std::shared_ptr<const CloudSet> training = {};
  std::optional<std::uint64_t> seed = {};
};

/// A cloud for a classifier, and the destination of its result.
struct Task {
  std::string key;
  const StudyCloud* cloud;
  const Treatment* treatment;
  gls::ScaleSpaceOptions descriptor;
  std::shared_ptr<const StoredModel> model;
};

/// A cloud and a method's predictions for it.
struct Scored {
  const StudyCloud* cloud;
  StoredClasses found;
};

class Runner {
 public:
  Runner(const Experiment& experiment, const StudyData& data, const Cache& cache,
         const RunOptions& options, const Progress* progress)
      : data_(data), cache_(cache), options_(options), progress_(progress) {
    study_.experiment = experiment;
    if (data.training) study_.training = data.training->name;
    std::sort(options_.seeds.begin(), options_.seeds.end());
    basis_ = this_program();
    if (experiment.timed) basis_ += ", " + machine_name();
  }

  Study run() {
    train_networks();
    classify_clouds();
    collect();
    return std::move(study_);
  }

 private:
  const std::vector<Variant>& variants() const { return study_.experiment.variants; }
  std::shared_ptr<const CloudSet> training_of(const Variant& variant) const {
    return variant.training ? variant.training : data_.training;
  }
  std::vector<std::shared_ptr<const CloudSet>> tests_of(const Variant& variant) const {
    if (variant.test) return {variant.test};
    return data_.tests;
  }
  void tell(const std::string& job) const {
    if (options_.on_job) options_.on_job(job);
  }
  void note(const std::string& text) {
    auto& notes = study_.notes;
    if (std::find(notes.begin(), notes.end(), text) == notes.end()) notes.push_back(text);
  }

  TrainingTask task_of(const Variant& variant, const NetworkMethod& network,
                       std::uint64_t seed) const;
  std::vector<TrainingTask> plan_networks();
  void train_networks();
  void check_scores_something() const;
  bool learnt_from(const Classifier& classifier, const StudyCloud& cloud) const;
  std::string key_of(const Classifier& classifier, const Variant& variant,
                     const StudyCloud& cloud) const;
  /// The remaining classifications; tasks on one cloud in one treatment and description together.
  std::vector<std::vector<Task>> plan_tasks();
  void classify_clouds();
  void collect();
  void collect(std::size_t variant, const CloudSet& set, const Classifier& classifier,
               bool keep_classes);
  void collect_external(std::size_t variant, const CloudSet& set, const ExternalMethod& method);
  void collect_classic(std::size_t variant, const CloudSet& set, const ClassicMethod& method);
  void score(Result result, const CloudSet& set, const std::vector<Scored>& clouds,
             bool keep_classes);

  const StudyData& data_;
  const Cache& cache_;
  RunOptions options_;
  const Progress* progress_;
  std::string basis_;  ///< of every key
  Study study_;
  std::vector<std::vector<Classifier>> classifiers_;  ///< of each variant, one a seed
  std::map<std::string, std::shared_ptr<const StoredModel>> models_;  ///< by key
  std::map<std::string, StoredClasses> found_;                        ///< by key
};

std::size_t weights_of(const detect::EdgeModel& model) {
  return model.network.network.parameters.size() +
         (model.context ? model.context->network.parameters.size() : 0);
}

Classifier classifier_from(const ModelMethod& method) {
  auto stored = std::make_shared<StoredModel>();
  stored->model = detect::load_model(method.file);
  check_edge_classes(stored->model.table, method.file.string(), ErrorKind::kModelMismatch);
  Classifier classifier{.key = Digest().add(io::InputFile(method.file).text()).hex(),
                        .descriptor = stored->model.descriptor};
  classifier.descriptor.engine = method.engine;
  classifier.model = std::move(stored);
  return classifier;
}

TrainingTask Runner::task_of(const Variant& variant, const NetworkMethod& network,
                             std::uint64_t seed) const {
  TrainingTask task{.name = variant.id,
                    .training = training_of(variant),
                    .options = network.options,
                    .one_in = network.one_in};
  task.options.training.seed = seed;
  task.samples_key = fmt::format("{} one in {} of {}", text_of(task.options.descriptor),
                                 task.one_in, text_of(*task.training));
  task.key = fmt::format("train {}: {}; {}", basis_, text_of(task.options), task.samples_key);
  return task;
}

std::vector<TrainingTask> Runner::plan_networks() {
  std::vector<TrainingTask> pending;
  classifiers_.resize(variants().size());
  for (std::size_t v = 0; v < variants().size(); ++v) {
    const Variant& variant = variants()[v];
    if (const auto* model = std::get_if<ModelMethod>(&variant.method)) {
      classifiers_[v].push_back(classifier_from(*model));
    }
    const auto* network = std::get_if<NetworkMethod>(&variant.method);
    if (!network) continue;
    for (const std::uint64_t seed : options_.seeds) {
      TrainingTask task = task_of(variant, *network, seed);
      Classifier classifier{.key = task.key,
                            .descriptor = task.options.descriptor,
                            .training = task.training,
                            .seed = seed};
      if (network->s_max_fraction)
        classifier.descriptor.range.s_max_fraction = *network->s_max_fraction;
      classifiers_[v].push_back(std::move(classifier));
      if (models_.contains(task.key)) continue;
      auto stored = cache_.find_model(task.key);
      models_[task.key] = stored ? std::make_shared<StoredModel>(std::move(*stored)) : nullptr;
      if (!stored) pending.push_back(std::move(task));
    }
  }
  return pending;
}

/// Throws before the training if nothing can be scored after it.
void Runner::check_scores_something() const {
  for (std::size_t v = 0; v < variants().size(); ++v) {
    if (classifiers_[v].empty()) return;  // another method, which does not learn
    for (const auto& set : tests_of(variants()[v])) {
      for (const Classifier& classifier : classifiers_[v]) {
        const auto is_new = [&](const StudyCloud& c) { return !learnt_from(classifier, c); };
        if (std::any_of(set->clouds.begin(), set->clouds.end(), is_new)) return;
      }
    }
  }
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: nothing to score: the networks learn from every cloud that they are "
                          "tested on",
                          study_.experiment.name));
}

void Runner::train_networks() {
  std::vector<TrainingTask> pending = plan_networks();
  check_scores_something();
  // Tasks that learn from the same descriptions follow each other.
  std::stable_sort(pending.begin(), pending.end(),
                   [](const auto& a, const auto& b) { return a.samples_key < b.samples_key; });
  Trainer trainer(options_.watts_per_core, progress_);
  for (const TrainingTask& task : pending) {
    tell(fmt::format("{}: train {}, seed {} ({} of {})", study_.experiment.name, task.name,
                     task.options.training.seed, study_.trained + 1, pending.size()));
    auto model = std::make_shared<StoredModel>(trainer.train(task));
    cache_.keep(task.key, *model);
    models_[task.key] = std::move(model);
    ++study_.trained;
  }
  for (auto& of_variant : classifiers_) {
    for (Classifier& classifier : of_variant) {
      if (!classifier.model) classifier.model = models_.at(classifier.key);
    }
  }
}

bool Runner::learnt_from(const Classifier& classifier, const StudyCloud& cloud) const {
  if (!classifier.training) return false;
  const auto& clouds = classifier.training->clouds;
  return std::any_of(clouds.begin(), clouds.end(),
                     [&](const StudyCloud& c) { return c.places == cloud.places; });
}

std::string Runner::key_of(const Classifier& classifier, const Variant& variant,
                           const StudyCloud& cloud) const {
  return fmt::format("classify {}: {}, {}, {} with {}", basis_, cloud.digest,
                     text_of(variant.treatment), text_of(classifier.descriptor),
                     Digest().add(classifier.key).hex());
}

std::vector<std::vector<Task>> Runner::plan_tasks() {
  std::vector<std::vector<Task>> groups;
  std::map<std::string, std::size_t> group_of;
  for (std::size_t v = 0; v < variants().size(); ++v) {
    const Treatment& treatment = variants()[v].treatment;
    for (const Classifier& classifier : classifiers_[v]) {
      for (const auto& set : tests_of(variants()[v])) {
        for (const StudyCloud& cloud : set->clouds) {
          const std::string key = key_of(classifier, variants()[v], cloud);
          if (learnt_from(classifier, cloud) || found_.contains(key)) continue;
          auto stored = cache_.find_classes(key);
          found_[key] = stored.value_or(StoredClasses());
          if (stored) continue;
          const std::string group =
              cloud.digest + text_of(treatment) + text_of(classifier.descriptor);
          const std::size_t place = group_of.try_emplace(group, groups.size()).first->second;
          if (place == groups.size()) groups.emplace_back();
          groups[place].push_back(
              {key, &cloud, &treatment, classifier.descriptor, classifier.model});
        }
      }
    }
  }
  return groups;
}

void Runner::classify_clouds() {
  const auto groups = plan_tasks();
  if (!groups.empty()) tell(fmt::format("{}: classify", study_.experiment.name));
  Stage stage(progress_, "classify", groups.size());
  const Progress cancel_only = without_report(progress_);
  for (const std::vector<Task>& tasks : groups) {
    const Task& first = tasks.front();
    const CloudWork work(*first.cloud, *first.treatment, first.descriptor, options_.watts_per_core,
                         &cancel_only);
    for (const Task& task : tasks) {
      StoredClasses found = work.classify(task.model->model);
      cache_.keep(task.key, found);
      found_[task.key] = std::move(found);
      ++study_.classified;
    }
    stage.advance();
  }
}

void Runner::collect() {
  for (std::size_t v = 0; v < variants().size(); ++v) {
    for (const auto& set : tests_of(variants()[v])) {
      const auto same = [&](const auto& s) { return s->name == set->name; };
      if (std::none_of(study_.sets.begin(), study_.sets.end(), same)) study_.sets.push_back(set);
      for (std::size_t i = 0; i < classifiers_[v].size(); ++i) {
        collect(v, *set, classifiers_[v][i], i == 0);
      }
      if (const auto* external = std::get_if<ExternalMethod>(&variants()[v].method)) {
        collect_external(v, *set, *external);
      }
      if (const auto* classic = std::get_if<ClassicMethod>(&variants()[v].method)) {
        collect_classic(v, *set, *classic);
      }
    }
    if (!study_.experiment.curves) continue;
    for (const Classifier& classifier : classifiers_[v]) {
      if (!classifier.seed) continue;
      study_.curves.push_back({v, *classifier.seed, classifier.model->epochs});
    }
  }
}

void Runner::collect(std::size_t v, const CloudSet& set, const Classifier& classifier,
                     bool keep_classes) {
  Result result{.variant = v,
                .set = set.name,
                .seed = classifier.seed,
                .parameters = weights_of(classifier.model->model),
                .costs = classifier.model->costs};
  const auto* network = std::get_if<NetworkMethod>(&variants()[v].method);
  if (network && network->options.context && !classifier.model->model.context) {
    note(fmt::format("{}, seed {}, has no context network: the first left no point in doubt",
                     variants()[v].id, *classifier.seed));
  }
  std::vector<Scored> clouds;
  for (const StudyCloud& cloud : set.clouds) {
    if (learnt_from(classifier, cloud)) {
      note(fmt::format("{} of {} is not scored with {}, which learnt from it", cloud.name, set.name,
                       variants()[v].id));
      continue;
    }
    const StoredClasses& found = found_.at(key_of(classifier, variants()[v], cloud));
    if (!found.failure.empty()) {
      note(fmt::format("{} of {} is not scored with {}: {}", cloud.name, set.name, variants()[v].id,
                       found.failure));
      continue;
    }
    result.costs += found.costs;
    clouds.push_back({&cloud, found});
  }
  if (classifier.training) {
    for (const StudyCloud& cloud : classifier.training->clouds) {
      result.training_points += static_cast<double>(cloud.cloud.size());
    }
  }
  score(std::move(result), set, clouds, keep_classes && variants()[v].treatment == Treatment());
}

void Runner::collect_external(std::size_t v, const CloudSet& set, const ExternalMethod& method) {
  std::vector<Scored> clouds;
  for (const StudyCloud& cloud : set.clouds) {
    auto predictions = external_classes(method, set.name, cloud);
    if (!predictions.note.empty()) note(predictions.note);
    StoredClasses found{.classes = std::move(predictions.classes)};
    if (found.classes.empty()) {
      note(fmt::format("{} of {} has no classes by {}", cloud.name, set.name, variants()[v].id));
      continue;
    }
    count_agreement(cloud.cloud.labels, found);
    clouds.push_back({&cloud, std::move(found)});
  }
  score({.variant = v, .set = set.name}, set, clouds, true);
}

void Runner::collect_classic(std::size_t v, const CloudSet& set, const ClassicMethod& method) {
  const Variant& variant = variants()[v];
  tell(fmt::format("{}: {} on {}", study_.experiment.name, variant.id, set.name));
  Result result{.variant = v, .set = set.name};
  std::vector<Scored> clouds;
  for (const StudyCloud& cloud : set.clouds) {
    const std::string key =
        fmt::format("classic {}: {} {} {}: {}, {}", basis_, variant.id, method.settings, set.name,
                    cloud.digest, text_of(variant.treatment));
    auto found = cache_.find_classes(key);
    if (!found) {
      found = classify_classic(cloud, set.name, variant.treatment, method, options_.watts_per_core,
                               progress_);
      cache_.keep(key, *found);
      ++study_.classified;
    }
    if (!found->failure.empty()) {
      note(fmt::format("{} of {} is not scored with {}: {}", cloud.name, set.name, variant.id,
                       found->failure));
      continue;
    }
    result.costs += found->costs;
    clouds.push_back({&cloud, *std::move(found)});
  }
  score(std::move(result), set, clouds, variant.treatment == Treatment());
}

void Runner::score(Result result, const CloudSet& set, const std::vector<Scored>& clouds,
                   bool keep_classes) {
  if (clouds.empty()) return;  // a note says why
  std::vector<eval::CloudScore> edge, sharp;
  for (const auto& [cloud, found] : clouds) {
    edge.push_back({cloud->name, found.edge});
    sharp.push_back({cloud->name, found.sharp});
    result.points += static_cast<double>(found.edge.total());
    if (keep_classes) result.classes.push_back(found.classes);
  }
  const bool edge_first = set.positive == eval::Positive::kEdge;
  result.positive = set.positive;
  result.scores = edge_first ? edge : sharp;
  study_.results.push_back(result);
  const auto equal = [](const eval::CloudScore& a, const eval::CloudScore& b) {
    return a.counts == b.counts;
  };
  const bool same = std::equal(edge.begin(), edge.end(), sharp.begin(), equal);
  if (!study_.experiment.both_positives || same) return;
  result.positive = edge_first ? eval::Positive::kSharp : eval::Positive::kEdge;
  result.scores = edge_first ? sharp : edge;
  study_.results.push_back(std::move(result));
}

}  // namespace

Study run(const Experiment& experiment, const StudyData& data, const Cache& cache,
          const RunOptions& options, const Progress* progress) {
  return Runner(experiment, data, cache, options, progress).run();
}

}  // namespace pcednet::study
