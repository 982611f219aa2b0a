#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "workbench/study/study_file.h"

namespace pcednet::study {
namespace {

/// A variant on a set: its seeds.
using Group = std::vector<const Result*>;

std::vector<Group> groups_of(const Study& study) {
  std::vector<Group> groups;
  for (const Result& result : study.results) {
    const auto same = [&](const Group& group) {
      return group[0]->variant == result.variant && group[0]->set == result.set &&
             group[0]->positive == result.positive;
    };
    const auto place = std::find_if(groups.begin(), groups.end(), same);
    if (place == groups.end()) {
      groups.push_back({&result});
    } else {
      place->push_back(&result);
    }
  }
  std::stable_sort(groups.begin(), groups.end(), [&](const Group& a, const Group& b) {
    const auto rank = [&](const Group& group) {
      const auto is_set = [&](const auto& set) { return set->name == group[0]->set; };
      return std::find_if(study.sets.begin(), study.sets.end(), is_set) - study.sets.begin();
    };
    return rank(a) < rank(b);
  });
  return groups;
}

/// ".842" or ".842 +- .011".
std::string spread(const Group& group, double (*value)(const Result&)) {
  double sum = 0, squares = 0;
  for (const Result* result : group) sum += value(*result);
  const double mean = sum / static_cast<double>(group.size());
  if (group.size() == 1) return fmt::format("{:.3f}", mean);
  for (const Result* result : group) squares += std::pow(value(*result) - mean, 2);
  return fmt::format("{:.3f} +-{:.3f}", mean,
                     std::sqrt(squares / static_cast<double>(group.size() - 1)));
}

std::string score_row(const Group& group) {
  return fmt::format(
      " {:>13} {:>13} {:>13} {:>13} {:>13} {:>13}",
      spread(group, [](const Result& r) { return eval::median_scores(r.scores).precision; }),
      spread(group, [](const Result& r) { return eval::median_scores(r.scores).recall; }),
      spread(group, [](const Result& r) { return eval::median_scores(r.scores).mcc; }),
      spread(group, [](const Result& r) { return eval::median_scores(r.scores).f1; }),
      spread(group, [](const Result& r) { return scores_of(eval::pooled_counts(r.scores)).mcc; }),
      spread(group, [](const Result& r) { return scores_of(eval::pooled_counts(r.scores)).f1; }));
}

std::string mean(const Group& group, Cost Costs::*part) {
  double sum = 0;
  for (const Result* result : group) sum += (result->costs.*part).seconds;
  return fmt::format(" {:>9.3f}", sum / static_cast<double>(group.size()));
}

/// The mean energy of the variant's phase; "-" where a variant is no single phase.
std::string mean_joules(const Group& group, Phase phase) {
  double sum = 0;
  for (const Result* result : group) {
    const auto joules = joules_per_thousand(*result, phase);
    if (!joules) return fmt::format(" {:>14}", "-");
    sum += *joules;
  }
  return fmt::format(" {:>14.4g}", sum / static_cast<double>(group.size()));
}

}  // namespace

std::string to_table(const Study& study) {
  const bool scored = !study.experiment.timed;
  std::string table, set;
  for (const Group& group : groups_of(study)) {
    const Result& first = *group[0];
    if (set != first.set || table.empty()) {
      set = first.set;
      table += fmt::format("\n{:<24} {:>6}", study.experiment.name + ": " + set, "edge");
      if (scored) {
        table += fmt::format(" {:>13} {:>13} {:>13} {:>13} {:>13} {:>13}", "median P", "R", "MCC",
                             "F1", "pooled MCC", "F1");
      }
      table += fmt::format(" {:>9} {:>9} {:>9}  seconds", "describe", "train", "classify");
      table += scored ? "\n" : "  joules per 1000 points\n";
    }
    table += fmt::format("{:<24} {:>6}", study.experiment.variants[first.variant].id,
                         first.positive == eval::Positive::kEdge ? "both" : "sharp");
    if (scored) table += score_row(group);
    table +=
        mean(group, &Costs::describe) + mean(group, &Costs::train) + mean(group, &Costs::classify);
    if (!scored) {
      const Phase phase = study.experiment.variants[first.variant].phase;
      table += "         " + mean_joules(group, phase);
    }
    table += "\n";
  }
  return table;
}

}  // namespace pcednet::study
