#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "io/sample_cloud.h"
#include "io/scratch.h"
#include "pcednet/formats/write_cloud.h"

namespace pcednet::io {
namespace {

struct Outcome {
  int code = 0;
  std::string out;
  std::string err;
};

Outcome run(const Scratch& scratch, const std::string& arguments) {
  const std::string out = scratch.path("stdout").string(), err = scratch.path("stderr").string();
  const int status = std::system(
      (std::string(PCEDNET_BINARY) + " " + arguments + " >" + out + " 2>" + err).c_str());
  return {WEXITSTATUS(status), bytes_of(out), bytes_of(err)};
}

TEST(InfoCommand, SaysWhatAFileHolds) {
  const Scratch scratch;
  PointCloud cloud = sample_cloud(50);
  cloud.positions[1] = cloud.positions[0];
  cloud.normals[4].setZero();
  const std::string path = scratch.path("a.ply").string();
  formats::write_cloud(path, cloud);
  const Outcome json = run(scratch, "info " + path + " --json -");
  ASSERT_EQ(json.code, 0) << json.err;
  const auto files = nlohmann::json::parse(json.out);
  ASSERT_EQ(files.size(), 1u);
  const auto& file = files[0];
  EXPECT_EQ(file["file"], path);
  EXPECT_EQ(file["format"], "PLY");
  EXPECT_EQ(file["points"], 50);
  EXPECT_EQ(file["position_type"], "float32");
  double least = 1e9;
  for (const Vec3& p : cloud.positions) least = std::fmin(least, p.x());
  EXPECT_EQ(file["bounds"]["min"][0], least);
  EXPECT_EQ(file["labels"], nlohmann::json({{"0", 13}, {"1", 13}, {"2", 12}, {"255", 12}}));
  EXPECT_EQ(file["attributes"].size(), 4u);
  EXPECT_EQ(file["attributes"][0]["name"], "quality");
  EXPECT_EQ(file["attributes"][0]["type"], "float32");
  EXPECT_EQ(file["defects"]["positions_not_finite"], 1);
  EXPECT_EQ(file["defects"]["normals_unusable"], 1);
  EXPECT_EQ(file["defects"]["duplicate_positions"], 1);
  EXPECT_EQ(file["comments"].size(), 2u);

  const Outcome words = run(scratch, "info " + path);
  EXPECT_EQ(words.code, 0);
  for (const char* part : {"points         50\n", "13 non-edge (0)", "12 unlabelled (255)",
                           "int16 intensity", "1 duplicate positions", "1 unusable"}) {
    EXPECT_TRUE(contains(words.out, part)) << part << "\n" << words.out;
  }
  EXPECT_EQ(words.err, "");
}

TEST(InfoCommand, ComputesTheMeanSpacing) {
  // On a cubic grid with unit spacing, periodic enough: the ten nearest of an inner point are six
  // at 1 and four at sqrt(2). A brute force over all points is the oracle.
  const Scratch scratch;
  std::vector<Vec3> points;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      for (int k = 0; k < 9; ++k) points.emplace_back(i, j, k);
    }
  }
  double sum = 0.0;
  for (const Vec3& p : points) {
    std::vector<double> distances;
    for (const Vec3& q : points) distances.push_back((p - q).norm());
    std::sort(distances.begin(), distances.end());
    for (int n = 1; n <= 10; ++n) sum += distances[static_cast<std::size_t>(n)] / 10.0;
  }
  PointCloud cloud;
  cloud.positions = points;
  formats::write_cloud(scratch.path("a.ply"), cloud);
  const auto files =
      nlohmann::json::parse(run(scratch, "info --json - " + scratch.path("a.ply").string()).out);
  // Summed in another order: 729 x 10 terms of about 1.
  EXPECT_NEAR(files[0]["mean_spacing"].get<double>(), sum / static_cast<double>(points.size()),
              1e-12);
}

TEST(InfoCommand, WritesJsonToAFileOnce) {
  const Scratch scratch;
  const std::string input = scratch.file("a.xyz", "1 2 3\n").string();
  const std::string json = scratch.path("a.json").string();
  EXPECT_EQ(run(scratch, "info " + input + " --json " + json).code, 0);
  EXPECT_EQ(nlohmann::json::parse(bytes_of(json))[0]["points"], 1);
  EXPECT_EQ(run(scratch, "info " + input + " --json " + json).code, 2);
  EXPECT_EQ(run(scratch, "info " + input + " --overwrite --json " + json).code, 0);
}

TEST(ConvertCommand, KeepsWhatItCanAndSaysWhatItCannot) {
  const Scratch scratch;
  const PointCloud cloud = sample_cloud(50);
  const std::string in = scratch.path("a.ply").string(), out = scratch.path("b.obj").string();
  formats::write_cloud(in, cloud);
  const Outcome lossy = run(scratch, "convert " + in + " -o " + out);
  EXPECT_EQ(lossy.code, 0);
  EXPECT_EQ(lossy.out, "");
  EXPECT_TRUE(contains(lossy.err, "does not keep: labels"));
  const PointCloud spelled = formats::read_cloud(out).cloud;
  ASSERT_EQ(spelled.size(), cloud.size());
  // A float is spelled as short as a float can be: the same again as a float.
  EXPECT_EQ(spelled.positions[0].cast<float>(), cloud.positions[0].cast<float>());
  const std::string pcd = scratch.path("b.pcd").string(), back = scratch.path("c.ply").string();
  EXPECT_EQ(run(scratch, "convert " + in + " -o " + pcd).code, 0);
  const Outcome whole = run(scratch, "convert --ascii " + pcd + " -o " + back);
  EXPECT_EQ(whole.code, 0);
  EXPECT_FALSE(contains(whole.err, "does not keep"));
  EXPECT_TRUE(contains(bytes_of(back), "format ascii"));
  EXPECT_TRUE(same_bits(formats::read_cloud(back).cloud.positions, cloud.positions));
}

TEST(ConvertCommand, WritesCoordinatesNearTheLargestDoubleAsLas) {
  const Scratch scratch;
  std::string text;
  for (int i = 0; i < 5; ++i) text += fmt::format("1.7e308 {} {}\n", i, 2 * i);
  const std::string in = scratch.file("a.xyz", text).string(), out = scratch.path("a.las").string();
  const Outcome outcome = run(scratch, "convert " + in + " -o " + out);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(formats::read_cloud(out).cloud.positions, formats::read_cloud(in).cloud.positions);
}

TEST(ConvertCommand, NamesThePointThatIsTooFarToComputeWith) {
  const Scratch scratch;
  std::string text;
  for (int i = 0; i < 60; ++i) text += fmt::format("{} {} {}\n", i % 7, i % 5, i % 3);
  text += "1 nan 2\n2 -1.7e308 1\n";
  const std::string in = scratch.file("a.xyz", text).string();
  const std::string out = " -o " + scratch.path("b.ply").string();
  for (const std::string& command :
       {"classify " + in + out, "normals " + in + out, "convert " + in + " --noise 0.1" + out,
        "describe " + in + " -o " + scratch.path("b.npy").string()}) {
    const Outcome outcome = run(scratch, command);
    EXPECT_EQ(outcome.code, 4) << command;
    EXPECT_TRUE(contains(outcome.err,
                         "a.xyz: coordinates too large: 1.7e+308 at "
                         "point 61; at most 1e+150"))
        << command << ": " << outcome.err;
  }
}

TEST(ConvertCommand, ReturnsTheCodeOfItsFailure) {
  const Scratch scratch;
  const std::string good = scratch.file("a.xyz", "1 2 3\n").string();
  const std::string bad = scratch.file("b.xyz", "1 2\n").string();
  const std::string out = scratch.path("o.ply").string();
  EXPECT_EQ(run(scratch, "convert " + good).code, 2);
  EXPECT_EQ(run(scratch, "convert " + good + " -o " + scratch.path("o.e57").string()).code, 2);
  const Outcome broken = run(scratch, "convert " + bad + " -o " + out);
  EXPECT_EQ(broken.code, 3);
  EXPECT_TRUE(contains(broken.err, "b.xyz:1:"));
  EXPECT_EQ(run(scratch, "convert " + scratch.path("none.xyz").string() + " -o " + out).code, 3);
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(run(scratch, "convert " + good + " -o " + out).code, 0);
  EXPECT_EQ(run(scratch, "convert " + good + " -o " + out).code, 2);
  EXPECT_EQ(run(scratch, "convert " + good + " -o " + out + " --overwrite").code, 0);
  const std::string nothing =
      scratch.file("c.ply", "ply\nformat ascii 1.0\nelement face 0\nend_header\n").string();
  EXPECT_EQ(run(scratch, "convert " + nothing + " -o " + out + " --overwrite").code, 4);
}

}  // namespace
}  // namespace pcednet::io
