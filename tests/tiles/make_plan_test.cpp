#include "pcednet/tiles/make_plan.h"

#include <gtest/gtest.h>

#include "pcednet/core/random.h"
#include "pcednet/formats/write_cloud.h"
#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::tiles {
namespace {

class MakePlan : public testing::Test, protected test::OwnFolder {
 protected:
  MakePlan() {
    Random random(1);
    for (int i = 0; i < 3000; ++i) {
      const double x = random.uniform(), y = random.uniform();
      cloud_.positions.emplace_back(x, y, 0.0);
      cloud_.normals.push_back(Vec3::UnitZ());
    }
  }

  Plan plan_with(double tile_length) const {
    formats::write_cloud(folder_ / "in.ply", cloud_, {.overwrite = Overwrite::kYes});
    const std::filesystem::path model = PCEDNET_SOURCE_DIR "/models/general.safetensors";
    return make_plan({.inputs = {folder_ / "in.ply"},
                      .folder = folder_ / "tiles",
                      .output = {},
                      .model = {.name = "general", .path = model},
                      .tile_length = tile_length},
                     detect::load_model(model));
  }

  PointCloud cloud_;
};

TEST_F(MakePlan, CountsEachPlaceOnce) {
  for (std::size_t i = 0; i < 2000; ++i) {
    cloud_.positions.push_back(cloud_.positions[i]);
    cloud_.normals.push_back(cloud_.normals[i]);
  }
  cloud_.positions[7].x() = NAN;  // its copy keeps the place
  cloud_.positions[2500].x() = NAN;
  const Plan plan = plan_with(0.5);
  EXPECT_EQ(plan.points(), 5000u);
  EXPECT_EQ(plan.places, 2999u);
}

TEST_F(MakePlan, RefusesTilesThatAreTooShortToCount) {
  EXPECT_ERROR(ErrorKind::kUsage, plan_with(1e-12));
  EXPECT_ERROR(ErrorKind::kUsage, plan_with(1e-300));
  // All at one place, far from the origin.
  for (Vec3& position : cloud_.positions) position = {1e9, 0.0, 0.0};
  cloud_.positions.front().z() = 1.0;
  EXPECT_ERROR(ErrorKind::kUsage, plan_with(1e-12));
}

}  // namespace
}  // namespace pcednet::tiles
