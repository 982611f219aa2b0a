#include "pcednet/tiles/run_tile.h"

#include <gtest/gtest.h>

#include "pcednet/tiles/sha256.h"
#include "support/expect_error.h"

namespace pcednet::tiles {
namespace {

class PlannedModelFile : public testing::Test {
 protected:
  void SetUp() override {
    plan_.model.path = PCEDNET_SOURCE_DIR "/models/general.safetensors";
    plan_.model.sha256 = sha256_of_file(plan_.model.path);
    const gls::ScaleSpaceOptions descriptor = detect::load_model(plan_.model.path).descriptor;
    ASSERT_TRUE(descriptor.range.octaves);
    plan_.s_min = 0.1, plan_.s_max = descriptor.range.s_max_ratio * plan_.s_min;
    plan_.pyramids.resize(1);
    plan_.pyramids[0].levels.resize(static_cast<std::size_t>(descriptor.scales));
  }

  Plan plan_;
};

TEST_F(PlannedModelFile, IsUsedAsPlanned) {
  EXPECT_EQ(load_planned_model(plan_).descriptor.range.s_max, plan_.s_max);
  plan_.s_max *= 8.0;  // an uneven cloud
  plan_.pyramids.resize(4, plan_.pyramids.front());
  EXPECT_EQ(load_planned_model(plan_).descriptor.range.s_max, plan_.s_max);
  plan_.model.exact = true;
  for (auto& pyramid : plan_.pyramids) pyramid.levels.clear();
  EXPECT_EQ(load_planned_model(plan_).descriptor.engine, gls::Engine::kExact);
}

TEST_F(PlannedModelFile, NeedsItsDecisionsOnVoxels) {
  Plan few_levels = plan_, no_levels = plan_, octaves = plan_, no_octaves = plan_;
  few_levels.pyramids[0].levels.pop_back();
  no_levels.pyramids[0].levels.clear();
  octaves.pyramids.resize(4, plan_.pyramids.front());
  no_octaves.s_max *= 2.0;
  for (const Plan& plan : {few_levels, no_levels, octaves, no_octaves}) {
    EXPECT_ERROR(ErrorKind::kUnreadable, load_planned_model(plan));
  }
}

TEST_F(PlannedModelFile, IsRefusedIfItIsAnother) {
  plan_.model.sha256.front() ^= 1;
  EXPECT_ERROR(ErrorKind::kModelMismatch, load_planned_model(plan_));
}

}  // namespace
}  // namespace pcednet::tiles
