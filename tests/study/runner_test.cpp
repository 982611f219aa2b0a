#include "workbench/study/runner.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>

#include "detect/labelled_cube.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/detect/classify.h"
#include "support/expect_error.h"
#include "support/own_folder.h"
#include "workbench/study/cache.h"
#include "workbench/study/study_file.h"

namespace pcednet::study {
namespace {

namespace fs = std::filesystem;

std::shared_ptr<const CloudSet> set_of(const std::string& name,
                                       const std::vector<std::uint64_t>& seeds) {
  CloudSet set{.name = name};
  for (const std::uint64_t seed : seeds) {
    set.clouds.push_back(make_study_cloud("cube" + std::to_string(seed), "", cube(700, seed)));
  }
  set.positive = positive_of(set.clouds);
  return std::make_shared<const CloudSet>(std::move(set));
}

PlanOptions small() {
  PlanOptions options;
  options.training.training.epochs = 2;
  options.training.training.least_per_epoch = 1024;
  options.training.descriptor.scales = 4;
  return options;
}

class StudyRun : public testing::Test, protected test::OwnFolder {
 protected:
  void TearDown() override { set_thread_count(0); }

  Study run(const std::string& name, const std::string& cache, RunOptions options = {},
            const Progress* progress = nullptr) {
    return study::run(make_experiment(name, plan_), data_, Cache(folder_ / cache), options,
                      progress);
  }

  PlanOptions plan_ = small();
  StudyData data_ = {set_of("training", {1}), {set_of("a", {2, 3}), set_of("b", {4})}};
};

/// What a study says about agreement, without what it says about time.
std::string scores_in(const Study& study) {
  std::string text;
  for (const Result& result : study.results) {
    text += study.experiment.variants[result.variant].id + " " + result.set + " " +
            std::to_string(result.seed.value_or(0)) + " " +
            std::to_string(static_cast<int>(result.positive)) + "\n" + eval::to_json(result.scores);
  }
  return text;
}

/// Compares the results of a study, whose networks have seed 5, with training and classification by
/// hand.
void expect_found_by_hand(const Study& study, const StudyData& data) {
  const PointCloud& training = data.training->clouds[0].cloud;
  for (const Result& result : study.results) {
    const auto& variant = study.experiment.variants[result.variant];
    detect::TrainOptions options = std::get<NetworkMethod>(variant.method).options;
    options.training.seed = 5;
    const detect::TrainingCloud learnt{"cube", detect::prepare(training), training.labels};
    const auto model = detect::train("by hand", {&learnt, 1}, options).model;
    EXPECT_EQ(model.context.has_value(), options.context);
    const auto set = std::find_if(data.tests.begin(), data.tests.end(),
                                  [&](const auto& s) { return s->name == result.set; });
    ASSERT_EQ(result.scores.size(), (*set)->clouds.size());
    for (std::size_t i = 0; i < result.scores.size(); ++i) {
      const PointCloud& cloud = (*set)->clouds[i].cloud;
      const auto classes = detect::classify(detect::prepare(cloud), model).classes;
      EXPECT_EQ(result.scores[i].counts,
                eval::count_confusion(cloud.labels, classes, result.positive));
      EXPECT_EQ(result.classes[i], classes);
    }
  }
}

TEST_F(StudyRun, ScoresWhatTrainingAndClassificationByHandFind) {
  const Study study = run("classes", "cache", {.seeds = {5}});
  // 2 variants x 2 sets, each with both readings of what an edge is.
  ASSERT_EQ(study.results.size(), 8u);
  expect_found_by_hand(study, data_);
}

TEST_F(StudyRun, TrainsWhatShips) {
  const Study study = run("additions", "cache", {.seeds = {5}});
  ASSERT_EQ(study.results.size(), 10u);  // 5 variants x 2 sets
  expect_found_by_hand(study, data_);
  EXPECT_EQ(run("additions", "cache", {.seeds = {5}}).trained, 0u);
  plan_.training.context = true;
  EXPECT_EQ(run("additions", "cache", {.seeds = {5}}).trained, 2u);  // with "gates" and "distilled"
}

TEST_F(StudyRun, FindsEverythingInTheCacheTheSecondTime) {
  const Study first = run("classes", "cache", {.seeds = {1, 2}});
  EXPECT_EQ(first.trained, 4u);
  EXPECT_EQ(first.classified, 12u);
  const Study second = run("classes", "cache", {.seeds = {1, 2}});
  EXPECT_EQ(second.trained, 0u);
  EXPECT_EQ(second.classified, 0u);
  EXPECT_EQ(to_json(first, {}), to_json(second, {}));
}

TEST_F(StudyRun, SharesNetworksBetweenExperiments) {
  run("classes", "cache");
  const Study study = run("learning", "cache");  // its PCEDNet is that of three classes
  EXPECT_EQ(study.trained, 4u);
  EXPECT_EQ(study.experiment.variants.size(), 5u);
}

TEST_F(StudyRun, DoesNotDependOnTheOrderOfTheSeeds) {
  EXPECT_EQ(scores_in(run("classes", "cache1", {.seeds = {2, 1}})),
            scores_in(run("classes", "cache2", {.seeds = {1, 2}})));
}

TEST_F(StudyRun, GivesTheSameScoresForAnyNumberOfThreads) {
  set_thread_count(1);
  const std::string one = scores_in(run("features", "cache1"));
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    EXPECT_EQ(scores_in(run("features", "cache" + std::to_string(threads))), one);
  }
}

TEST_F(StudyRun, GoesOnFromWhereItWasCancelled) {
  const std::string whole = scores_in(run("scales", "whole"));
  // Stopped during the second of six trainings.
  int jobs = 0;
  RunOptions options;
  options.on_job = [&](const std::string&) { ++jobs; };
  const Progress progress{.report = {}, .cancelled = [&] { return jobs >= 2; }};
  EXPECT_ERROR(ErrorKind::kCancelled, run("scales", "cache", options, &progress));
  const Study study = run("scales", "cache");
  EXPECT_EQ(study.trained, 5u);
  EXPECT_EQ(scores_in(study), whole);
}

TEST_F(StudyRun, KeepsCloudsThatWereClassifiedBeforeACancel) {
  run("classes", "cache");
  for (const auto& entry : fs::directory_iterator(folder_ / "cache")) {
    if (entry.path().filename().string().starts_with("classes-")) fs::remove(entry);
  }
  std::atomic<bool> stop = false;
  const Progress progress{
      .report = [&](const std::string& stage,
                    double fraction) { stop = stop || (stage == "classify" && fraction > 0.4); },
      .cancelled = [&] { return stop.load(); }};
  EXPECT_ERROR(ErrorKind::kCancelled, run("classes", "cache", {}, &progress));
  const Study study = run("classes", "cache");
  EXPECT_EQ(study.trained, 0u);
  EXPECT_GT(study.classified, 0u);
  EXPECT_LT(study.classified, 6u);
}

TEST_F(StudyRun, TakesDamagedCacheFilesForMissing) {
  const Study first = run("classes", "cache");
  for (const auto& entry : fs::directory_iterator(folder_ / "cache")) {
    fs::resize_file(entry, fs::file_size(entry) / 2);
  }
  const Study second = run("classes", "cache");
  EXPECT_EQ(second.trained, first.trained);
  EXPECT_EQ(second.classified, first.classified);
  EXPECT_EQ(scores_in(second), scores_in(first));
}

TEST_F(StudyRun, DoesNotTakeOtherOptionsOrCloudsForTheSame) {
  run("classes", "cache");
  plan_.training.training.balance = 0.0;
  EXPECT_EQ(run("classes", "cache").trained, 2u);
  data_.training = set_of("training", {9});
  EXPECT_EQ(run("classes", "cache").trained, 2u);
  data_.tests = {set_of("a", {8})};
  const Study study = run("classes", "cache");
  EXPECT_EQ(study.trained, 0u);
  EXPECT_EQ(study.classified, 2u);
}

TEST_F(StudyRun, DoesNotScoreCloudsThatWereLearntFrom) {
  // The same points in another order, with other labels.
  PointCloud again = data_.training->clouds[0].cloud;
  std::reverse(again.positions.begin(), again.positions.end());
  std::reverse(again.normals.begin(), again.normals.end());
  CloudSet set{.name = "c", .clouds = {data_.tests[0]->clouds[0]}};
  set.clouds.push_back(make_study_cloud("again", "", again));
  data_.tests = {std::make_shared<const CloudSet>(std::move(set))};
  const Study study = run("classes", "cache");
  for (const Result& result : study.results) {
    ASSERT_EQ(result.scores.size(), 1u);
    EXPECT_EQ(result.scores[0].name, "cube2");
  }
  ASSERT_EQ(study.notes.size(), 2u);
  EXPECT_NE(study.notes[0].find("again"), std::string::npos);
}

TEST_F(StudyRun, RefusesToScoreNothing) {
  data_.tests = {data_.training};
  EXPECT_ERROR(ErrorKind::kInsufficient, run("classes", "cache"));
  data_.tests = {data_.training, data_.tests.front(), set_of("b", {4})};
  EXPECT_FALSE(run("classes", "cache").results.empty());
}

TEST_F(StudyRun, LeavesOutCloudsThatCannotBeDescribed) {
  CloudSet set{.name = "few", .clouds = {data_.tests[0]->clouds[0]}};
  PointCloud one_place = cube(12, 3);
  std::fill(one_place.positions.begin(), one_place.positions.end(), Vec3(1, 2, 3));
  set.clouds.push_back(make_study_cloud("tiny", "", one_place));
  data_.tests = {std::make_shared<const CloudSet>(std::move(set))};
  for (int time = 0; time < 2; ++time) {  // the second time from the cache
    const Study study = run("density", "cache");
    EXPECT_EQ(study.results.front().scores.size(), 1u);
    EXPECT_FALSE(study.notes.empty());
    EXPECT_NE(study.notes[0].find("tiny"), std::string::npos) << study.notes[0];
  }
}

TEST_F(StudyRun, ScoresThinnedCloudsWithTheLabelsThatAreLeft) {
  const Study study = run("density", "cache");
  EXPECT_GE(study.results.size(), 4u);  // two sets, shares that leave enough
  for (const Result& result : study.results) {
    const double share = *study.experiment.variants[result.variant].x;
    EXPECT_NEAR(static_cast<double>(result.scores[0].counts.total()), 700 * share, 1.0);
    EXPECT_EQ(result.classes.empty(), share != 1.0);  // others are not those of the file's points
  }
}

TEST_F(StudyRun, TellsWhatPhasesOfWorkCost) {
  plan_.quick = true;
  plan_.training.training.epochs = 1;
  data_.tests = {};
  const Study study = run("energy", "cache");
  ASSERT_EQ(study.results.size(), 8u);
  for (const Result& result : study.results) {
    EXPECT_EQ(result.points, 20000);
    EXPECT_EQ(result.training_points, 20000);
    for (const Cost& cost : {result.costs.describe, result.costs.train, result.costs.classify}) {
      EXPECT_GT(cost.seconds, 0.0);
      EXPECT_GT(cost.joules, 0.0);
    }
  }
  const std::string json = to_json(study, {.watts_per_core = 9.0});
  EXPECT_NE(json.find("9 W per core"), std::string::npos);
  EXPECT_EQ(json.find("\"joules\": null"), std::string::npos);
  const std::string table = to_table(study);
  EXPECT_NE(table.find("seconds  joules per 1000 points\n"), std::string::npos);
  EXPECT_EQ(table.find(" -\n"), std::string::npos);
  for (const Result& result : study.results) {
    const auto joules =
        joules_per_thousand(result, study.experiment.variants[result.variant].phase);
    ASSERT_TRUE(joules);
    EXPECT_NE(table.find(fmt::format(" {:.4g}\n", *joules)), std::string::npos);
  }
}

TEST_F(StudyRun, WritesPredictionsAndRefusesTheFileOfAnotherCommand) {
  const Study study = run("classes", "cache", {.seeds = {1, 2}});
  write_study(folder_, study, {.command = "one"}, Overwrite::kNo);
  write_study(folder_, study, {.command = "one"}, Overwrite::kNo);
  EXPECT_ERROR(ErrorKind::kUsage, write_study(folder_, study, {.command = "two"}, Overwrite::kNo));
  write_study(folder_, study, {.command = "two"}, Overwrite::kYes);
  const fs::path file = folder_ / "predictions/classes/classes2/a/cube3.u8";
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes(std::istreambuf_iterator<char>(stream), {});
  const auto first = std::find_if(study.results.begin(), study.results.end(), [&](const auto& r) {
    return study.experiment.variants[r.variant].id == "classes2" && r.set == "a";
  });
  ASSERT_NE(first, study.results.end());
  ASSERT_EQ(bytes.size(), 700u);
  EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), first->classes[1].begin(),
                         [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; }));
}

TEST(Experiments, AreAllMadeWithDistinctRows) {
  for (const ExperimentEntry& entry : experiments()) {
    if (entry.name == "timing" || entry.name == "energy") continue;  // they make large clouds
    const Experiment experiment = make_experiment(entry.name, {});
    EXPECT_EQ(experiment.name, entry.name);
    std::vector<std::string> ids;
    for (const Variant& variant : experiment.variants) {
      ids.push_back(variant.id);
      EXPECT_EQ(variant.x.has_value(), experiment.x_label.has_value()) << variant.id;
    }
    std::sort(ids.begin(), ids.end());
    EXPECT_EQ(std::unique(ids.begin(), ids.end()), ids.end()) << entry.name;
  }
  EXPECT_ERROR(ErrorKind::kUsage, make_experiment("nonsense", {}));
}

TEST(StudyCloudDigest, SeesContentsAndThePlacesWhateverTheirOrder) {
  const PointCloud cloud = cube(50, 1);
  PointCloud reversed = cloud;
  std::reverse(reversed.positions.begin(), reversed.positions.end());
  PointCloud relabelled = cloud;
  relabelled.labels[7] = relabelled.labels[7] == kSharpEdge ? kNonEdge : kSharpEdge;
  const auto a = make_study_cloud("a", "", cloud), b = make_study_cloud("b", "", reversed),
             c = make_study_cloud("c", "", relabelled);
  EXPECT_EQ(a.places, b.places);
  EXPECT_EQ(a.places, c.places);
  EXPECT_NE(a.digest, b.digest);
  EXPECT_NE(a.digest, c.digest);
  EXPECT_EQ(a.digest, make_study_cloud("other", "", cloud).digest);
}

}  // namespace
}  // namespace pcednet::study
