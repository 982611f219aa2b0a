#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "pcednet/core/random_vectors.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/ply/faces.h"
#include "support/expect_error.h"
#include "support/own_folder.h"
#include "workbench/annotate/project/known_files.h"
#include "workbench/annotate/scene/scene.h"
#include "workbench/annotate/session.h"

namespace pcednet::annotate {
namespace {

namespace fs = std::filesystem;

/// Exact points of a cube, without normals.
PointCloud cube_without_normals(int points) {
  Random random(9);
  PointCloud cloud;
  for (int i = 0; i < points; ++i) {
    Vec3 p = uniform_vector(random, -Vec3::Ones(), Vec3::Ones());
    p[i % 3] = random.uniform() < 0.5 ? -1 : 1;
    cloud.positions.push_back(p);
  }
  return cloud;
}

class StartFile : public testing::Test, protected test::OwnFolder {
 protected:
  StartFile() {
    fs::create_directory(folder_ / "m");
    std::ofstream(file_) << "a model";
  }
  const fs::path project_ = folder_ / "a.json", file_ = folder_ / "m" / "mine.safetensors";
  const ShippedModels shipped_ = {{"general", "/shipped/general.safetensors"}};
};

TEST_F(StartFile, HasOneNameHoweverItIsGiven) {
  const fs::path here = fs::proximate(file_);
  for (const fs::path& given : {file_, folder_ / "m/../m/./mine.safetensors", here, "./" / here}) {
    EXPECT_EQ(start_name(given, project_, shipped_), "m/mine.safetensors") << given;
    EXPECT_EQ(start_name(given, fs::proximate(project_), shipped_), "m/mine.safetensors") << given;
  }
  const fs::path elsewhere = folder_ / "projects/a.json";
  const std::string whole = fs::weakly_canonical(file_).string();
  EXPECT_EQ(start_name(here, elsewhere, shipped_), whole);
  EXPECT_EQ(start_file(whole, elsewhere, shipped_), whole);
  EXPECT_EQ(start_file("m/mine.safetensors", project_, shipped_), whole);
}

TEST_F(StartFile, IsNotTakenForAShippedModel) {
  const fs::path twin = folder_ / "general";
  std::ofstream(twin) << "a model";
  EXPECT_EQ(start_name(twin, project_, shipped_), fs::weakly_canonical(twin).string());
  EXPECT_EQ(start_place("general", project_, shipped_), shipped_.at("general"));
}

TEST_F(StartFile, ThatIsMissingIsNamedWithItsProject) {
  fs::remove(file_);
  const auto error = test::error_of([&] { start_file("m/mine.safetensors", project_, shipped_); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::kUnreadable);
  const std::string words = error->what();
  EXPECT_TRUE(words.starts_with(project_.string() + ": its start, the model ")) << words;
  EXPECT_NE(words.find(file_.string() + ", is missing"), words.npos) << words;
}

detect::EdgeModel shipped(const std::string& name) {
  return detect::load_model(PCEDNET_SOURCE_DIR "/models/" + name + ".safetensors");
}

/// Two clouds on which different experts of `general` decide.
class StartOfSession : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directory(folder_);
    formats::write_cloud(folder_ / "large.ply", cube_without_normals(6000), {});
    formats::write_cloud(folder_ / "small.ply", cube_without_normals(1500), {});
    SessionOptions options{.input = folder_ / "large.ply", .further = {folder_ / "small.ply"}};
    options.model = "general";
    options.starts = {"general", "cad"};
    options.load_model = shipped;
    options.emit = [this](const Event& event) {
      if (std::holds_alternative<Predicted>(event)) ++predicted_;
    };
    session_.emplace(options);
    session_->wait_until_ready();
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (predicted_ == 0 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    ASSERT_EQ(predicted_, 1);
  }
  void TearDown() override {
    session_.reset();
    fs::remove_all(folder_);
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) /
      ("pcednet_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  std::atomic<int> predicted_ = 0;
  std::optional<Session> session_ = {};
};

TEST_F(StartOfSession, ShowsWhatClassifyFindsInEachCloud) {
  const detect::EdgeModel general = shipped("general");
  std::vector<std::optional<detect::CloudKind>> kinds;
  for (const std::size_t k : {0u, 1u}) {
    const fs::path input = folder_ / (k == 0 ? "large.ply" : "small.ply");
    const PointCloud cloud = formats::read_cloud(input).cloud;
    const auto prepared = detect::prepare(cloud);
    auto found = detect::classify(prepared, general);
    detect::mark_boundary(detect::find_boundary(prepared), found.classes);
    kinds.push_back(found.expert);
    session_->save(Saved::kCloud, folder_ / "saved.ply", Overwrite::kYes, k);
    EXPECT_EQ(formats::read_cloud(folder_ / "saved.ply").cloud.labels, found.classes) << k;
  }
  EXPECT_TRUE(kinds[0] && kinds[0]->exact);  // where the distance to the crease decides
  EXPECT_TRUE(kinds[1] && kinds[1]->below > 0);
}

TEST_F(StartOfSession, SavesTheWholeModel) {
  session_->save(Saved::kModel, folder_ / "saved.safetensors", Overwrite::kYes);
  const detect::EdgeModel saved = detect::load_model(folder_ / "saved.safetensors");
  EXPECT_EQ(saved.experts.size(), shipped("general").experts.size());
  EXPECT_GT(saved.experts.size(), 0u);
}

TEST_F(StartOfSession, LearnsTwoClassesFromAModelOfTwo) {
  EXPECT_EQ(session_->change_settings({.start = "cad"}).classes, 2);
  EXPECT_EQ(session_->change_settings({.classes = 3}).classes, 2);
  EXPECT_EQ(session_->change_settings({.classes = 3, .start = "general"}).classes, 3);
}

TEST(SpacingOfAScene, IsNotThatOfAPointFarAway) {
  const fs::path path = fs::path(testing::TempDir()) / "pcednet_far_point.ply";
  PointCloud cloud = cube_without_normals(3000);
  const auto spacing = [&] {
    formats::write_cloud(path, cloud, {.overwrite = Overwrite::kYes});
    return load_scene(path)->spacing;
  };
  const double without = spacing();
  cloud.positions.emplace_back(1e4, 0, 0);
  EXPECT_NEAR(spacing() / without, 1.0, 0.02);
  fs::remove(path);
}

TEST(WarningsOfAScene, TellOfRoundedCoordinates) {
  const fs::path path = fs::path(testing::TempDir()) / "pcednet_rounded.ply";
  PointCloud cloud = cube_without_normals(3000);
  cloud.position_type = ScalarType::kFloat32;
  formats::write_cloud(path, cloud, {.overwrite = Overwrite::kYes});
  EXPECT_TRUE(load_scene(path)->warnings.empty());
  for (Vec3& p : cloud.positions)
    p = (p + Vec3(500'000, 5'400'000, 0)).cast<float>().cast<double>();
  formats::write_cloud(path, cloud, {.overwrite = Overwrite::kYes});
  const auto warnings = load_scene(path)->warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("are rounded to steps of 0.5"), std::string::npos) << warnings[0];
  fs::remove(path);
}

TEST(WarningsOfAScene, TellOfFacesAndOfEstimatedNormals) {
  const fs::path path = fs::path(testing::TempDir()) / "pcednet_faces.ply";
  PointCloud cloud = cube_without_normals(3000);
  cloud.foreign_elements.push_back(io::make_face_element({3, 3}, {0, 1, 2, 1, 2, 3}));
  formats::write_cloud(path, cloud, {.overwrite = Overwrite::kYes});
  const auto notes = notes_of(*load_scene(path));
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_TRUE(notes[0].starts_with("2 faces are not used, only their vertices")) << notes[0];
  EXPECT_TRUE(notes[1].starts_with("no normals in the file: estimated")) << notes[1];
  fs::remove(path);
}

TEST(WarningsOfAScene, TellOfNoiseThickerThanTheSpacing) {
  const fs::path path = fs::path(testing::TempDir()) / "pcednet_thick.ply";
  PointCloud cloud = cube_without_normals(100'000);
  Random random(9);
  for (Vec3& p : cloud.positions) p += 0.031 * normal_vector(random);  // two spacings
  formats::write_cloud(path, cloud, {.overwrite = Overwrite::kYes});
  const auto warnings = load_scene(path)->warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("noise is 2"), std::string::npos) << warnings[0];
  fs::remove(path);
}

}  // namespace
}  // namespace pcednet::annotate
