#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "gls/test_clouds.h"
#include "support/own_folder.h"

namespace pcednet::gls {
namespace {

namespace fs = std::filesystem;

class DescribeCommand : public testing::Test, protected pcednet::test::OwnFolder {
 protected:
  /// Writes an ASCII PLY with the shortest numbers that read back as the same doubles.
  void write_ply(const std::string& name, const test::Cloud& cloud, bool with_normals = true) {
    std::ofstream ply(path(name));
    ply << "ply\nformat ascii 1.0\nelement vertex " << cloud.positions.size()
        << "\nproperty double x\nproperty double y\nproperty double z\n";
    if (with_normals) ply << "property double nx\nproperty double ny\nproperty double nz\n";
    ply << "end_header\n";
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
      const Vec3 &p = cloud.positions[i], &n = cloud.normals[i];
      ply << fmt::format("{} {} {}", p.x(), p.y(), p.z());
      if (with_normals) ply << fmt::format(" {} {} {}", n.x(), n.y(), n.z());
      ply << "\n";
    }
  }

  /// The exit code of `pcednet describe <arguments>`, run in the folder.
  int describe(const std::string& arguments) const {
    const std::string line = fmt::format("cd '{}' && '{}' describe {} 2> errors.txt",
                                         folder_.string(), PCEDNET_BINARY, arguments);
    return WEXITSTATUS(std::system(line.c_str()));
  }

  std::string text(const std::string& name) const {
    std::ifstream stream(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(DescribeCommand, WritesTheMatrixOfTheLibrary) {
  const test::Cloud cloud = test::cube(5000, 12, 0.005, 0.0);
  write_ply("cube.ply", cloud);
  ASSERT_EQ(describe("cube.ply -o out.npy --features 7 --scales 8 --reconstruction sphere-mls "
                     "--gate -0.2 --s-max 0.15 --exact"),
            0)
      << text("errors.txt");

  ScaleSpaceOptions options;
  options.features = FeatureSet::kInvariant7;
  options.scales = 8;
  options.range.s_max = 0.15;
  options.side_gate = -0.2;
  options.reconstruction = Reconstruction::kSphereMls;
  const ExactScaleSpace space(cloud.points(), options);
  const auto expected = test::describe<float>(space, test::all_targets(5000));

  const std::string npy = text("out.npy");
  EXPECT_NE(npy.find("'descr': '<f4'"), std::string::npos);
  EXPECT_NE(npy.find("(5000, 8, 7)"), std::string::npos);
  const std::size_t bytes = expected.features.size() * sizeof(float);
  ASSERT_GT(npy.size(), bytes);
  EXPECT_EQ(std::memcmp(npy.data() + npy.size() - bytes, expected.features.data(), bytes), 0);

  const auto json = nlohmann::json::parse(text("out.json"));
  EXPECT_EQ(json["scales"].get<std::vector<double>>(), space.scales());
  EXPECT_EQ(json["features"][6], "k2");
  EXPECT_EQ(json["reconstruction"], "sphere-mls");
  EXPECT_EQ(json["gate"], -0.2);
  for (const auto& [name, status] :
       {std::pair("stable", FitStatus::kStable), std::pair("unstable", FitStatus::kUnstable),
        std::pair("undefined", FitStatus::kUndefined)}) {
    EXPECT_EQ(json["status"][name],
              std::count(expected.status.begin(), expected.status.end(), status));
  }
}

TEST_F(DescribeCommand, RefusesWithTheExitCodeOfTheReason) {
  const test::Cloud cloud = test::cube(1000, 12);
  write_ply("cube.ply", cloud);
  write_ply("bare.ply", cloud, false);
  write_ply("empty.ply", {});
  EXPECT_EQ(describe("missing.ply -o out.npy"), 3);
  EXPECT_EQ(describe("bare.ply -o bare.npy"), 0);
  EXPECT_NE(text("errors.txt").find("no normals"), std::string::npos) << "says it estimates them";
  EXPECT_EQ(describe("empty.ply -o out.npy"), 4);
  EXPECT_EQ(describe("cube.ply -o out.bin"), 2);
  EXPECT_EQ(describe("cube.ply -o out.npy --features 5"), 2);
  EXPECT_EQ(describe("cube.ply -o out.npy --scales 12"), 2);
  EXPECT_EQ(describe("cube.ply -o out.npy --gate 7"), 2);
  EXPECT_FALSE(fs::exists(path("out.npy")));
  EXPECT_FALSE(fs::exists(path("out.json")));
  EXPECT_EQ(describe("cube.ply -o out.npy"), 0);
  EXPECT_EQ(describe("cube.ply -o out.npy"), 2) << "exists";
  EXPECT_EQ(describe("cube.ply -o out.npy --overwrite"), 0);
}

}  // namespace
}  // namespace pcednet::gls
