#include "workbench/annotate/adapt_clouds.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "pcednet/detect/outputs.h"
#include "workbench/annotate/adapt.h"
#include "workbench/annotate/outputs.h"

namespace pcednet::annotate {

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
      name, make_start(model, subject), subject, labels, seed,
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
