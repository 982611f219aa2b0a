#include "workbench/report/merge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "pcednet/core/error.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/formats/write_cloud.h"
#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A folder with one study of one cloud of five points, and predictions of one variant, two seeds.
class Merge : public testing::Test, protected test::OwnFolder {
 protected:
  Merge() {
    fs::create_directories(folder_ / "predictions");
    PointCloud cloud;
    for (int i = 0; i < 5; ++i) cloud.positions.emplace_back(i, i % 2, 0.25 * i);
    cloud.normals.assign(5, Vec3::UnitZ());
    cloud.labels = {0, 1, 2, 255, 0};
    formats::write_cloud(folder_ / "cloud.ply", cloud);
    write("predictions/cloud.u8", std::string("\0\1\2\2\0", 5));
    study_ = Json::parse(R"({"schema": "pcednet-study-1", "experiment": "methods",
      "title": "A </script> in a name",
      "sets": [{"name": "s", "clouds": [{"name": "cloud", "file": "cloud.ply"}]}],
      "variants": [{"id": "v", "title": "V"}],
      "results": [{"variant": "v", "set": "s", "seed": 1, "clouds": [], "predictions": "predictions"}]})");
    Json scores = Json::parse(R"({"precision":1,"recall":1,"mcc":1,"f1":1,"accuracy":1,"iou":1})");
    Json& result = study_["results"][0];
    result["median"] = result["pooled"] = scores;
    scores["name"] = "cloud";
    result["clouds"].push_back(scores);
    study_["results"].push_back(Json(result));
    study_["results"][1]["seed"] = 2;
  }

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  Json merged(const MergeOptions& options = {}) const {
    write("methods.json", study_.dump());
    return Json::parse(merge_studies(folder_, options).json);
  }

  Json study_;
};

TEST_F(Merge, KeepsStudiesUnchangedAndPacksTheirClouds) {
  const Json page = merged();
  EXPECT_EQ(page["schema"], "pcednet-report-1");
  ASSERT_EQ(page["studies"].size(), 1u);
  EXPECT_EQ(page["studies"][0], study_);
  ASSERT_EQ(page["scenes"].size(), 1u);
  const Json& scene = page["scenes"][0];
  EXPECT_EQ(scene["set"], "s");
  EXPECT_EQ(scene["cloud"], "cloud");
  EXPECT_EQ(scene["points"], 5);
  EXPECT_EQ(scene["shown"], 5);
  EXPECT_EQ(scene["size"], 4.0);
  EXPECT_EQ(scene["positions"].get<std::string>().size(), 40u);  // 30 bytes
  EXPECT_EQ(scene["truth"].get<std::string>().size(), 4u);       // 2 bytes, padded
  ASSERT_EQ(scene["predictions"].size(), 1u) << "the first seed alone";
  EXPECT_EQ(scene["predictions"][0]["variant"], "v");
  EXPECT_EQ(scene["predictions"][0]["seed"], 1);
}

TEST_F(Merge, ShowsTheTruthThatAStudyScores) {
  const Json truth = merged()["scenes"][0]["truth"];
  PointCloud result = formats::read_cloud(folder_ / "cloud.ply").cloud;
  const auto write_result = [&] {
    formats::write_cloud(folder_ / "cloud.ply", result, {.overwrite = Overwrite::kYes});
  };
  set_attribute(result, make_attribute("scalar_input_label", result.labels));
  result.comments = {"pcednet model general"};
  result.labels = {2, 2, 2, 2, 2};
  write_result();
  EXPECT_EQ(merged()["scenes"][0]["truth"], truth) << "predictions are no truth";
  set_attribute(result, make_attribute("scalar_painted_label", std::vector<std::uint8_t>(5, 0)));
  write_result();
  EXPECT_EQ(merged()["scenes"][0]["truth"], "AAAA") << "five non-edges";
}

TEST_F(Merge, RefusesACloudThatLostItsLabels) {
  PointCloud cloud = formats::read_cloud(folder_ / "cloud.ply").cloud;
  cloud.labels.clear();
  formats::write_cloud(folder_ / "cloud.ply", cloud, {.overwrite = Overwrite::kYes});
  EXPECT_ERROR(ErrorKind::kInsufficient, merged());
}

TEST_F(Merge, FindsCloudsWhoseNamesAreNotUtf8) {
  const std::string json = "caf\xEF\xBF\xBD", disk = "caf\xE9";
  fs::create_directories(folder_ / disk);
  fs::rename(folder_ / "cloud.ply", folder_ / disk / (disk + ".ply"));
  fs::rename(folder_ / "predictions/cloud.u8", folder_ / "predictions" / (disk + ".u8"));
  Json& cloud = study_["sets"][0]["clouds"][0];
  cloud["name"] = json;
  cloud["file"] = json + "/" + json + ".ply";
  for (Json& result : study_["results"]) result["clouds"][0]["name"] = json;
  const Json scene = merged()["scenes"][0];
  EXPECT_EQ(scene["cloud"], json);
  EXPECT_EQ(scene["file"], json + ".ply");
  EXPECT_EQ(scene["predictions"].size(), 1u);
}

TEST_F(Merge, LeavesCloudsOutOnDemand) {
  fs::remove(folder_ / "cloud.ply");
  EXPECT_EQ(merged({.clouds_per_set = 0})["scenes"].size(), 0u);
}

TEST_F(Merge, NeedsNoCloudThatNobodyKeepsPredictionsFor) {
  fs::remove(folder_ / "cloud.ply");
  const Json sound = study_;
  for (Json& result : study_["results"]) result["clouds"].clear();
  EXPECT_EQ(merged()["scenes"].size(), 0u);
  study_ = sound;
  for (Json& result : study_["results"]) result["predictions"] = nullptr;
  EXPECT_EQ(merged()["scenes"].size(), 0u);
}

TEST_F(Merge, TakesResultsWithTimesAlone) {
  for (Json& result : study_["results"]) {
    result["clouds"].clear();
    result["median"] = result["pooled"] = result["predictions"] = nullptr;
  }
  EXPECT_EQ(merged()["studies"][0], study_);
}

TEST_F(Merge, SamplesLargeClouds) {
  EXPECT_EQ(merged({.points_per_cloud = 3})["scenes"][0]["shown"], 3);
}

TEST_F(Merge, HasLinesOfTheTruthAndOfEachPredictionOnDemand) {
  const Json plain = merged()["scenes"][0];
  EXPECT_FALSE(plain.contains("lines") || plain["predictions"][0].contains("lines"));
  PointCloud cloud;  // a right angle
  for (int i = 0; i < 900; ++i) {
    const double along = i % 30, away = 0.5 * (i / 30 - 15);
    cloud.positions.emplace_back(std::max(away, 0.0), along, std::max(-away, 0.0));
    cloud.normals.push_back(away > 0 ? Vec3::UnitZ() : Vec3::UnitX());
    cloud.labels.push_back(std::abs(away) < 1.5 ? kSharpEdge : kNonEdge);
  }
  formats::write_cloud(folder_ / "cloud.ply", cloud, {.overwrite = Overwrite::kYes});
  write("predictions/cloud.u8", std::string(900, '\0'));
  const Json scene = merged({.lines = true})["scenes"][0];
  EXPECT_EQ(scene["lines"].size(), 1u);
  EXPECT_EQ(scene["predictions"][0]["lines"], Json::array()) << "it found no edges";
}

TEST_F(Merge, SharesACloudBetweenStudies) {
  study_["title"] = "Another";
  write("other.json", study_.dump());
  const Json page = merged();
  EXPECT_EQ(page["studies"].size(), 2u);
  ASSERT_EQ(page["scenes"].size(), 1u);
  EXPECT_EQ(page["scenes"][0]["predictions"].size(), 2u);
}

TEST_F(Merge, RefusesAFolderWithoutStudies) {
  EXPECT_ERROR(ErrorKind::kUnreadable, merge_studies(folder_ / "nowhere"));
  write("other.json", "{\"schema\":\"something else\"}");
  EXPECT_ERROR(ErrorKind::kInsufficient, merge_studies(folder_));
}

TEST_F(Merge, WarnsOfForeignJson) {
  write("other.json", "[1]");
  write("methods.json", study_.dump());
  const auto result = merge_studies(folder_);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("other.json"), std::string::npos);
}

TEST_F(Merge, LeavesOutWhatIsNoJsonAndSaysWhere) {
  write("broken.json", "{\"schema\": 5");
  write("empty.json", "");
  write("methods.json", study_.dump());
  const auto result = merge_studies(folder_);
  EXPECT_EQ(result.studies, 1u);
  ASSERT_EQ(result.warnings.size(), 2u);
  EXPECT_EQ(result.warnings[0],
            (folder_ / "broken.json").string() + ": no JSON at byte 13: left out");
  EXPECT_EQ(result.warnings[1],
            (folder_ / "empty.json").string() + ": no JSON at byte 1: left out");
}

TEST_F(Merge, LeavesOutWhatCannotBeReadAndSaysWhy) {
  std::filesystem::create_directory(folder_ / "a.json");
  std::filesystem::create_symlink("nowhere", folder_ / "b.json");
  EXPECT_ERROR(ErrorKind::kUnreadable, merge_studies(folder_));
  write("methods.json", study_.dump());
  const auto result = merge_studies(folder_);
  EXPECT_EQ(result.studies, 1u);
  EXPECT_EQ(result.warnings,
            (std::vector{(folder_ / "a.json").string() + ": is a folder: left out",
                         (folder_ / "b.json").string() + ": No such file or directory: left out"}));
}

TEST_F(Merge, RefusesWhatIsNoJsonOrEndsEarly) {
  const std::string whole = study_.dump();
  for (const std::size_t length : {std::size_t{0}, std::size_t{1}, whole.size() / 2}) {
    write("methods.json", whole.substr(0, length));
    const auto error = test::error_of([&] { merge_studies(folder_); });
    ASSERT_TRUE(error) << length;
    EXPECT_EQ(error->kind(), ErrorKind::kUnreadable);
    EXPECT_NE(std::string(error->what()).find("methods.json"), std::string::npos);
  }
}

TEST_F(Merge, RefusesStudiesThatLackWhatThePageNeeds) {
  const std::vector<std::function<void(Json&)>> breaches = {
      [](Json& s) { s.erase("title"); },
      [](Json& s) { s["sets"] = "none"; },
      [](Json& s) { s["sets"][0].erase("clouds"); },
      [](Json& s) { s["sets"][0]["clouds"][0]["file"] = 7; },
      [](Json& s) { s["variants"][0].erase("id"); },
      [](Json& s) { s["results"][0]["variant"] = "unheard of"; },
      [](Json& s) { s["results"][0]["set"] = "unheard of"; },
      [](Json& s) { s["results"][0]["median"].erase("mcc"); },
      [](Json& s) { s["results"][1]["clouds"][0]["iou"] = nullptr; },
      [](Json& s) { s["results"][0] = 3; },
      [](Json& s) { s["sets"][0]["clouds"][0]["file"] = "missing.ply"; },
      [](Json& s) { s["results"][0]["predictions"] = "missing"; },
  };
  const Json sound = study_;
  for (std::size_t i = 0; i < breaches.size(); ++i) {
    study_ = sound;
    breaches[i](study_);
    EXPECT_ERROR(ErrorKind::kUnreadable, merged()) << "breach " << i;
  }
}

TEST_F(Merge, RefusesPredictionsForAnotherNumberOfPoints) {
  write("predictions/cloud.u8", "four");
  EXPECT_ERROR(ErrorKind::kInsufficient, merged());
}

TEST(FillPage, PutsDataWhereItBelongsAndKeepsItsScriptElementWhole) {
  const std::string page = "<script>\"PCEDNET-REPORT-DATA\"</script><p>";
  const std::string filled = fill_page(page, R"({"a":"</script><!--"})");
  EXPECT_EQ(filled, R"(<script>{"a":"\u003c/script>\u003c!--"}</script><p>)");
  EXPECT_ERROR(ErrorKind::kFailure, fill_page("<p>", "{}"));
}

}  // namespace
}  // namespace pcednet::report
