#include "pcednet/tiles/plan.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "pcednet/core/version.h"
#include "pcednet/tiles/tile_file.h"
#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::tiles {
namespace {

namespace fs = std::filesystem;

class PlanFile : public testing::Test, protected test::OwnFolder {
 protected:
  void SetUp() override { fs::create_directories(folder_ / "tiles"); }

  Plan some_plan() const {
    Plan plan{.version = kVersion};
    plan.inputs = {{folder_ / "in/a.laz",
                    1234,
                    true,
                    0,
                    1,
                    {{50000, 0, {{0, 1, 2}, {3, 4, 5.1}}, "d1"}},
                    {"GpsTime"}},
                   {"/elsewhere/b.laz", 99, false, 1, 1, {{10, 10, {}, "d2"}, {1, 0, {}, "d3"}}}};
    plan.las_steps = {0.01, 0, 0.01, 0, 0.01, 0.1};
    plan.forms = {0, 1}, plan.timed = 1;
    plan.places = 50000;
    plan.box = {{0, 1, 2}, {3, 4, 0.1 + 0.2}};
    plan.model = {"general", "/models/general.safetensors", "abc", false, true, false};
    plan.estimates = true;
    plan.scanners = {{1, 2, 3.1}, Vec3::Constant(NAN)};
    plan.s_min = 0.1, plan.s_max = 1.0 / 3.0;
    plan.normals = {
        true, 48, 12, true, true, true, {0.01, {-1.0, 2.0, 0.5}, 0.04}, {0.02, {1.0, 2.0, 3.5}},
        true};
    plan.pyramids = {
        {{0, 1, 2}, 3.0, {{false, gls::Crowd::kKeep}, {true, gls::Crowd::kMergeByAxis}}},
        {{0, 1, 2}, 3.0, {{true, gls::Crowd::kKeep}, {false, gls::Crowd::kMerge}}}};
    plan.pyramids.resize(4, plan.pyramids.back());
    plan.grid = {0.1, 7};
    plan.buffer = 0.7, plan.reach = 0.3, plan.memory = 5'000'000'000;
    plan.tiles = {{0, -1, 50001, folder_ / "tiles/0.laz"}, {1, -1, 10, folder_ / "tiles/1.laz"}};
    plan.notes = {"a note with \"quotes\""};
    return plan;
  }
};

TEST_F(PlanFile, ComesBackAsItWas) {
  const Plan plan = some_plan();
  write_plan(folder_ / "p.json", plan, Overwrite::kNo);
  const Plan back = read_plan(folder_ / "p.json");
  ASSERT_EQ(back.inputs.size(), 2u);
  EXPECT_EQ(back.inputs[0].path, plan.inputs[0].path);
  EXPECT_EQ(back.inputs[1].path, plan.inputs[1].path);
  EXPECT_EQ(back.inputs[0].bytes, 1234u);
  EXPECT_TRUE(back.inputs[0].narrow_colours);
  EXPECT_EQ(back.inputs[0].first_scan, 0);
  EXPECT_EQ(back.inputs[1].first_scan, 1);
  EXPECT_EQ(back.inputs[1].scans, 1);
  EXPECT_EQ(back.inputs[0].chunks[0].box.max, plan.inputs[0].chunks[0].box.max);
  EXPECT_TRUE(back.inputs[1].chunks[0].box.empty());
  EXPECT_EQ(back.inputs[1].chunks[0].without_place, 10u);
  EXPECT_EQ(back.inputs[1].chunks[1].digest, "d3");
  EXPECT_EQ(back.points(), 50011u);
  EXPECT_EQ(back.places, 50000u);
  EXPECT_EQ(back.las_steps, plan.las_steps);
  EXPECT_EQ(back.forms, plan.forms);
  EXPECT_EQ(back.timed, 1u);
  EXPECT_EQ(back.inputs[0].left_out, plan.inputs[0].left_out);
  EXPECT_TRUE(back.inputs[1].left_out.empty());
  EXPECT_EQ(back.box.max, plan.box.max);
  ASSERT_EQ(back.scanners.size(), 2u);
  EXPECT_EQ(back.scanners[0], plan.scanners[0]);
  EXPECT_FALSE(back.scanners[1].allFinite());
  EXPECT_EQ(back.model.path, plan.model.path);
  EXPECT_FALSE(back.model.context || back.model.exact);
  EXPECT_TRUE(back.model.boundary);
  EXPECT_EQ(back.s_max, 1.0 / 3.0);
  EXPECT_EQ(back.normals.neighbours, 48u);
  EXPECT_EQ(back.normals.fewest, 12u);
  EXPECT_TRUE(back.normals.poles);
  EXPECT_EQ(back.normals.rounding.step, 0.01);
  EXPECT_EQ(back.normals.rounding.origin, Vec3(-1.0, 2.0, 0.5));
  EXPECT_EQ(back.normals.rounding.spacing, 0.04);
  EXPECT_EQ(back.normals.averaging.deviation, 0.02);
  EXPECT_EQ(back.normals.averaging.middle, Vec3(1.0, 2.0, 3.5));
  EXPECT_TRUE(back.normals.made && back.normals.exact_planes && back.normals.exact);
  EXPECT_TRUE(back.normals.noisy && back.estimates);
  ASSERT_EQ(back.pyramids.size(), 4u);
  EXPECT_EQ(back.pyramids[0].levels, plan.pyramids[0].levels);
  EXPECT_EQ(back.pyramids[1].levels, plan.pyramids[1].levels);
  EXPECT_EQ(back.grid.length(), plan.grid.length());
  EXPECT_EQ(back.memory, plan.memory);
  EXPECT_EQ(back.tiles[0].row, -1);
  EXPECT_EQ(back.tiles[1].output, plan.tiles[1].output);
  EXPECT_EQ(back.notes, plan.notes);
  // The same plan has the same bytes.
  write_plan(folder_ / "again.json", back, Overwrite::kNo);
  EXPECT_EQ(read_plan(folder_ / "again.json").digest, back.digest);
}

TEST_F(PlanFile, KeepsPathsBelowItRelative) {
  write_plan(folder_ / "p.json", some_plan(), Overwrite::kNo);
  const auto json = nlohmann::json::parse(std::ifstream(folder_ / "p.json"));
  EXPECT_EQ(json["inputs"][0]["path"], "in/a.laz");
  EXPECT_EQ(json["inputs"][1]["path"], "/elsewhere/b.laz");
  EXPECT_EQ(json["tiles"][0]["output"], "tiles/0.laz");
}

TEST_F(PlanFile, IsRefusedWhereItIsNone) {
  const fs::path path = folder_ / "p.json";
  EXPECT_ERROR(ErrorKind::kUnreadable, read_plan(path));
  write_plan(path, some_plan(), Overwrite::kNo);
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  const std::string whole = text.str();
  for (std::size_t size = 0; size + 3 < whole.size(); size += 37) {
    std::ofstream(path) << whole.substr(0, size);
    EXPECT_ERROR(ErrorKind::kUnreadable, read_plan(path));
  }
  auto other = nlohmann::json::parse(whole);
  other["program"] = "0.0.1";
  std::ofstream(path) << other;
  EXPECT_ERROR(ErrorKind::kUsage, read_plan(path));
}

TEST_F(PlanFile, SaysWhatIsWrongInAPlainSentence) {
  const fs::path path = folder_ / "p.json";
  const auto said = [&](const auto& json) -> std::string {
    std::ofstream(path) << json;
    try {
      read_plan(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUnreadable);
      return error.what();
    }
    return "";
  };
  const std::string none = path.string() + ": not a plan of tiles";
  for (const char* other : {"{}", "[]", "7", "null", "{\"format\": 3}"}) {
    EXPECT_EQ(said(other), none);
  }
  write_plan(path, some_plan(), Overwrite::kYes);
  const auto whole = nlohmann::json::parse(std::ifstream(path));
  for (const auto& [member, value] : whole.items()) {
    if (member == "format" || member == "points") continue;  // the latter is for readers
    const std::string damaged = fmt::format("{}: \"{}\" is missing or damaged", none, member);
    auto lacks = whole, wrong = whole;
    lacks.erase(member);
    EXPECT_EQ(said(lacks), damaged);
    wrong[member] = true;
    if (!value.is_number()) {
      EXPECT_EQ(said(wrong), damaged);
    }
  }
  for (const auto& [member, value] : {std::pair<std::string, double>("cell", 0.0),
                                      {"cell", -1.0},
                                      {"cells_across", 0},
                                      {"buffer", -1.0},
                                      {"memory", 0}}) {
    auto wrong = whole;
    wrong[member] = value;
    EXPECT_EQ(said(wrong), fmt::format("{}: \"{}\" is damaged", none, member));
  }
  auto wrong = whole;
  wrong["tiles"] = nlohmann::json::array();
  EXPECT_EQ(said(wrong), none + ": \"tiles\" is damaged");
  for (const auto& forms : {std::vector<int>{}, {0, 2}}) {
    wrong = whole;
    wrong["forms"] = forms;
    EXPECT_EQ(said(wrong), none + ": \"forms\" is damaged");
  }
  wrong = whole;
  wrong["timed"] = 2;
  EXPECT_EQ(said(wrong), none + ": \"timed\" is damaged");
  wrong = whole;
  wrong["pyramids"][0]["levels"][0][1] = "heap";
  EXPECT_EQ(said(wrong), none + ": \"pyramids\" is missing or damaged");
}

TEST_F(PlanFile, HasPyramidsForEveryOctaveAndScale) {
  const auto is_refused = [&](const auto& damage) {
    Plan plan = some_plan();
    damage(plan);
    write_plan(folder_ / "p.json", plan, Overwrite::kYes);
    try {
      read_plan(folder_ / "p.json");
    } catch (const Error& error) {
      return std::string(error.what()).ends_with(": \"pyramids\" is damaged");
    }
    return false;
  };
  EXPECT_TRUE(is_refused([](Plan& plan) { plan.pyramids.clear(); }));
  EXPECT_TRUE(is_refused([](Plan& plan) { plan.pyramids.resize(5, plan.pyramids.front()); }));
  EXPECT_TRUE(is_refused([](Plan& plan) { plan.pyramids[2].levels.pop_back(); }));
  EXPECT_TRUE(is_refused([](Plan& plan) { plan.pyramids[0].side = -3.0; }));
  EXPECT_TRUE(is_refused([](Plan& plan) { plan.pyramids[3].corner.y() += 1.0; }));
  EXPECT_TRUE(is_refused([](Plan& plan) { plan.model.exact = true; }));
  EXPECT_FALSE(is_refused([](Plan& plan) { plan.pyramids.pop_back(); }));
  EXPECT_FALSE(is_refused([](Plan& plan) { plan.pyramids.resize(1); }));
  EXPECT_FALSE(is_refused([](Plan& plan) {
    plan.model.exact = true;
    for (auto& pyramid : plan.pyramids) pyramid.levels.clear();
  }));
}

TEST_F(PlanFile, KnowsWhichTilesAreDone) {
  write_plan(folder_ / "p.json", some_plan(), Overwrite::kNo);
  const Plan plan = read_plan(folder_ / "p.json");
  const fs::path tile = plan.tiles[0].output;
  EXPECT_EQ(state_of(plan, 0), TileState::kMissing);
  std::ofstream(tile) << "some points";
  EXPECT_EQ(state_of(plan, 0), TileState::kMissing);  // without a record it is not finished
  write_record(tile, {.plan = plan.digest, .tile = 0, .points = 50001});
  EXPECT_EQ(state_of(plan, 0, true), TileState::kDone);
  std::ofstream(tile) << "same length";
  EXPECT_EQ(state_of(plan, 0), TileState::kDone);
  EXPECT_EQ(state_of(plan, 0, true), TileState::kDamaged);
  std::ofstream(tile) << "shorter";
  EXPECT_EQ(state_of(plan, 0), TileState::kDamaged);
  write_record(tile, {.plan = "that of another plan", .tile = 0, .points = 50001});
  EXPECT_EQ(state_of(plan, 0), TileState::kDamaged);
  std::ofstream(tile.string() + ".json") << "{\"half a rec";
  EXPECT_EQ(state_of(plan, 0), TileState::kMissing);
}

}  // namespace
}  // namespace pcednet::tiles
