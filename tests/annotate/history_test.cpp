#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "pcednet/core/error.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/formats/write_cloud.h"
#include "support/expect_error.h"
#include "support/own_folder.h"
#include "workbench/annotate/page/json.h"
#include "workbench/annotate/project/project.h"
#include "workbench/annotate/session.h"

namespace pcednet::annotate {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kOldRun =
    R"({"run":3,"records":2,"settings":{"auto":false,"classes":2,"seed":7,"start":"cad"}})";

TEST(RunRecord, OfTheFirstVersionTellsNothingAndIsWrittenAsItWas) {
  const Record record = parse_record(kOldRun, 10);
  EXPECT_EQ(record.run.number, 3);
  EXPECT_EQ(record.run.settings.seed, 7u);
  EXPECT_FALSE(record.run.facts.painted);
  EXPECT_FALSE(record.run.facts.loss);
  EXPECT_EQ(Json::parse(to_line(record)), Json::parse(kOldRun));
}

TEST(RunRecord, KeepsItsFactsToTheLastBit) {
  Record record = parse_record(kOldRun, 10);
  record.run.facts = {.painted = 7,
                      .classes = 2,
                      .loss = 0.1 + 0.2,
                      .seconds_train = 1.0 / 3,
                      .time = "2026-01-02T03:04:05Z"};
  const RunFacts facts = parse_record(to_line(record), 10).run.facts;
  EXPECT_EQ(facts.painted, 7u);
  EXPECT_EQ(facts.classes, 2);
  EXPECT_EQ(facts.loss, 0.1 + 0.2);
  EXPECT_EQ(facts.seconds_train, 1.0 / 3);
  EXPECT_EQ(facts.time, "2026-01-02T03:04:05Z");
}

TEST(RunRecord, RefusesFactsOfTheWrongKind) {
  for (const char* more : {R"("loss":"small")", R"("painted":[])", R"("time":5)", R"("run":0)"}) {
    std::string line = kOldRun;
    line.insert(line.size() - 1, std::string(",") + more);
    EXPECT_ERROR(ErrorKind::kUnreadable, parse_record(line, 10)) << more;
  }
}

TEST(LabelsOf, AreThoseOfTheRunAndOfNoOther) {
  std::vector<Record> records = {{.id = "a", .edge_class = 2, .points = {0, 1}},
                                 {.id = "b", .edge_class = 0, .points = {4}},
                                 parse_record(kOldRun, 10),
                                 {.kind = Record::Kind::kUndo}};
  RunRecord run = records[2].run;
  const std::vector<std::uint8_t> expected = {2, 2, 255, 255, 0, 255, 255, 255, 255, 255};
  EXPECT_EQ(labels_of(run, records, 10).classes(), expected);
  run.facts.painted = 3;
  EXPECT_EQ(labels_of(run, records, 10).classes(), expected);
  run.facts.painted = 4;
  EXPECT_ERROR(ErrorKind::kUnreadable, labels_of(run, records, 10));
  run.facts.painted.reset();
  records.erase(records.begin());
  EXPECT_ERROR(ErrorKind::kUnreadable, labels_of(run, records, 10));
}

/// A cube whose runs are made, forgotten by ending the session, and asked for again.
class RunHistory : public testing::Test, protected test::OwnFolder {
 protected:
  void SetUp() override {
    Random random(1);
    PointCloud cloud;
    for (int i = 0; i < 6000; ++i) {
      Vec3 p = uniform_vector(random, Vec3::Constant(-0.5), Vec3::Constant(0.5));
      Vec3 n = Vec3::Zero();
      const int axis = i % 3;
      n[axis] = i % 2 == 0 ? 1 : -1;
      p[axis] = 0.5 * n[axis];
      cloud.positions.push_back(p);
      cloud.normals.push_back(n);
    }
    formats::write_cloud(folder_ / "cube.ply", cloud, {});
    open();
    session_->change_settings({.automatic = false});
  }

  void open() {
    session_.reset();
    SessionOptions options{.input = folder_ / "cube.ply"};
    options.load_model = [](const std::string& name) -> detect::EdgeModel {
      throw Error(ErrorKind::kUnreadable, name + ": no such model");
    };
    options.emit = [this](const Event& event) {
      const std::lock_guard lock(mutex_);
      if (const auto* problem = std::get_if<Problem>(&event)) problems_.push_back(problem->message);
      if (!std::holds_alternative<EpochDone>(event)) return;
      ++epochs_;
      while (hold_) std::this_thread::yield();
    };
    session_ = std::make_unique<Session>(options);
    session_->wait_until_ready();
  }

  void paint(const std::string& id, int edge_class, const Vec3& place, double radius) {
    Stroke stroke;
    stroke.id = id;
    stroke.edge_class = static_cast<std::uint8_t>(edge_class);
    stroke.centres = {place};
    stroke.radius = radius;
    session_->paint(stroke);
  }

  /// Without what becomes known of a run after it is shown.
  Json runs() const {
    Json all = Json::parse(to_json(session_->runs()));
    for (Json& run : all) run.erase("held_out");
    return all;
  }

  template <typename IsDone>
  void wait(IsDone&& is_done) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!is_done() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    ASSERT_TRUE(is_done());
  }

  bool has_model() const {
    try {
      session_->save(Saved::kModel, folder_ / "shown.safetensors", Overwrite::kYes);
      return true;
    } catch (const Error&) {
      return false;
    }
  }

  std::string model() const {
    wait([&] { return has_model(); });
    std::ifstream file(folder_ / "shown.safetensors", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::string train(std::size_t number) {
    session_->train_now();
    wait([&] { return runs().size() == number && runs().back()["current"] == true; });
    return model();
  }

  void restore(int number) {
    session_->restore(number);
    wait([&] { return runs()[static_cast<std::size_t>(number - 1)]["current"] == true; });
  }

  /// Two runs on different labels; the second is current.
  void train_twice() {
    paint("edge", 2, {0.5, 0.5, 0}, 0.2);
    paint("face", 0, {0.5, 0, 0}, 0.2);
    models_.push_back(train(1));
    paint("more", 0, {0, 0.5, 0}, 0.25);
    models_.push_back(train(2));
    paint("later", 2, {0.5, -0.5, 0}, 0.2);
    listed_ = runs();
  }

  std::string problems() {
    const std::lock_guard lock(mutex_);
    std::string all;
    for (const std::string& problem : problems_) all += problem + "\n";
    return all;
  }

  void edit_journal(const std::string& what, const std::string& by) {
    session_.reset();
    const fs::path path = folder_ / "cube_annotation.json.journal";
    std::ifstream file(path, std::ios::binary);
    std::string text(std::istreambuf_iterator<char>(file), {});
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos);
    std::ofstream(path, std::ios::binary) << text.replace(at, what.size(), by);
  }

  std::mutex mutex_ = {};
  std::vector<std::string> problems_ = {};
  std::atomic<int> epochs_ = 0;
  std::atomic<bool> hold_ = false;
  std::vector<std::string> models_ = {};
  Json listed_ = {};
  std::unique_ptr<Session> session_ = {};
};

TEST_F(RunHistory, IsListedAfterARestartAndTheCurrentRunComesBack) {
  train_twice();
  ASSERT_NE(models_[0], models_[1]);
  const fs::path journal = folder_ / "cube_annotation.json.journal";
  const auto size = fs::file_size(journal);
  open();
  EXPECT_EQ(runs(), listed_);
  EXPECT_EQ(model(), models_[1]);
  EXPECT_EQ(runs(), listed_);
  EXPECT_EQ(fs::file_size(journal), size);
  EXPECT_EQ(problems(), "");
}

TEST_F(RunHistory, GivesARestoredRunItsModelByteForByte) {
  train_twice();
  open();
  restore(1);
  EXPECT_EQ(model(), models_[0]);
  EXPECT_EQ(runs()[0]["loss"], listed_[0]["loss"]);
  open();  // the restored one is the current one now
  EXPECT_EQ(runs()[0]["current"], true);
  EXPECT_EQ(model(), models_[0]);
  restore(2);
  EXPECT_EQ(model(), models_[1]);
  const std::string third = train(3);  // numbers go on, on the same labels
  EXPECT_EQ(train(4), third);
  EXPECT_EQ(problems(), "");
}

TEST_F(RunHistory, TellsHowManyStrokesASavedModelDoesNotKnow) {
  const auto left_out = [&](Saved what = Saved::kModel) {
    const char* name = what == Saved::kModel ? "a.safetensors" : "a.json";
    return session_->save(what, folder_ / name, Overwrite::kYes).strokes_left_out;
  };
  train_twice();
  EXPECT_EQ(left_out(), 1u);
  EXPECT_EQ(left_out(Saved::kProject), 0u);
  session_->undo();
  EXPECT_EQ(left_out(), 0u);  // although steps are newer than the run
  session_->undo();
  EXPECT_EQ(left_out(), 1u);
  session_->redo();
  session_->redo();
  EXPECT_EQ(left_out(), 1u);
  restore(1);
  EXPECT_EQ(left_out(), 2u);
  train(3);
  EXPECT_EQ(left_out(), 0u);
}

TEST_F(RunHistory, StopsTrainingAgainWhenCancelled) {
  train_twice();
  hold_ = true;
  open();
  session_->cancel();
  hold_ = false;
  EXPECT_EQ(runs()[1]["current"], false);
  EXPECT_FALSE(has_model());
  const int before = epochs_;
  restore(2);
  EXPECT_GE(epochs_, before + 20);
  EXPECT_LT(epochs_, 80);  // those of three runs, and some of the one that was cancelled
  EXPECT_EQ(model(), models_[1]);
}

TEST_F(RunHistory, ProjectAndJournalOfTheFirstVersionOpen) {
  train_twice();
  session_->save(Saved::kProject, folder_ / "cube_annotation.json", Overwrite::kNo);
  session_.reset();
  for (const char* name : {"cube_annotation.json", "cube_annotation.json.journal"}) {
    std::ifstream file(folder_ / name, std::ios::binary);
    std::string text, line;
    while (std::getline(file, line)) {
      const bool comma = line.ends_with(",");
      const std::string json = line.substr(0, line.size() - (comma ? 1 : 0));
      if (json.starts_with("{") && Json::accept(json) && Json::parse(json).contains("painted")) {
        Json run = Json::parse(json);
        for (const char* fact :
             {"painted", "classes", "loss", "seconds_train", "seconds_classify", "time"}) {
          run.erase(fact);
        }
        line = run.dump() + (comma ? "," : "");
      }
      text += line + "\n";
    }
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  open();
  EXPECT_TRUE(runs()[0]["painted"].is_null());
  restore(1);
  EXPECT_EQ(model(), models_[0]);
  EXPECT_EQ(runs()[0]["painted"], listed_[0]["painted"]);
  EXPECT_EQ(problems(), "");
}

TEST_F(RunHistory, SaysSoIfTheRecordsDoNotFit) {
  train_twice();
  edit_journal(R"("stroke":"face")", R"("settings":{},"x":"face")");
  open();
  session_->restore(1);
  wait([&] { return problems().find("run 1 cannot be trained again") != std::string::npos; });
  EXPECT_FALSE(has_model());
  EXPECT_EQ(runs().size(), 2u);
  paint("again", 0, {0.5, 0, 0}, 0.2);
  EXPECT_FALSE(train(3).empty());
}

TEST_F(RunHistory, SaysSoIfARunIsNotWhatItWas) {
  train_twice();
  const std::string loss = listed_[0]["loss"].dump();
  edit_journal("\"loss\":" + loss, "\"loss\":0.5");
  open();
  restore(1);
  EXPECT_NE(problems().find("run 1 cannot be reproduced exactly"), std::string::npos);
}

}  // namespace
}  // namespace pcednet::annotate
