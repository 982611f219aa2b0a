#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include "normals/shapes.h"
#include "support/own_folder.h"

namespace pcednet::normals {
namespace {

namespace fs = std::filesystem;

class NormalsCommand : public testing::Test, protected test::OwnFolder {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Writes the positions, and the normals times `sign` unless it is 0.
  void write(const std::string& name, const Shape& shape, double sign) const {
    std::ofstream file(path(name));
    file.precision(std::numeric_limits<double>::max_digits10);
    for (std::size_t i = 0; i < shape.positions.size(); ++i) {
      file << shape.positions[i].transpose();
      if (sign != 0.0) file << ' ' << (sign * shape.normals[i]).transpose();
      file << '\n';
    }
  }

  /// The fourth to sixth column.
  std::vector<Vec3> read_normals(const std::string& name) const {
    std::ifstream file(path(name));
    std::vector<Vec3> normals;
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || line[0] == '#') continue;
      std::istringstream words(line);
      Vec3 p, n;
      words >> p.x() >> p.y() >> p.z() >> n.x() >> n.y() >> n.z();
      EXPECT_FALSE(words.fail()) << line;
      normals.push_back(n);
    }
    return normals;
  }

  /// Runs `pcednet normals ARGUMENTS`; its words to stderr are then in `said_`.
  int run(const std::string& arguments) {
    const std::string command = std::string(PCEDNET_BINARY) + " normals " + arguments + " 2> " +
                                path("stderr") + " > " + path("stdout");
    const int status = std::system(command.c_str());
    std::ostringstream said;
    said << std::ifstream(path("stderr")).rdbuf();
    said_ = said.str();
    EXPECT_EQ(fs::file_size(path("stdout")), 0u);
    return WEXITSTATUS(status);
  }

  std::string said_;
};

TEST_F(NormalsCommand, AddsOutwardNormals) {
  const Shape shape = sphere(600, 1.0);
  write("in.xyz", shape, 0.0);
  ASSERT_EQ(run(path("in.xyz") + " -o " + path("out.xyz")), 0) << said_;
  EXPECT_EQ(agreement(shape, read_normals("out.xyz")), 1.0);
  EXPECT_NE(said_.find("600 normals, 600 estimated from 12 neighbours"), std::string::npos)
      << said_;
  EXPECT_NE(said_.find("1 connected part\n"), std::string::npos) << said_;
}

TEST_F(NormalsCommand, KeepsGivenNormalsUpToTheirSigns) {
  const Shape shape = sphere(600, 1.0);
  write("in.xyz", shape, -1.0);
  ASSERT_EQ(run(path("in.xyz") + " --keep -o " + path("out.xyz")), 0) << said_;
  const auto normals = read_normals("out.xyz");
  // Text files hold what a float holds at most.
  for (std::size_t i = 0; i < 600; ++i) EXPECT_LT((normals[i] - shape.normals[i]).norm(), 1e-6);
}

TEST_F(NormalsCommand, TurnsAsAsked) {
  const Shape shape = sphere(600, 1.0);
  write("in.xyz", shape, 0.0);
  ASSERT_EQ(run(path("in.xyz") + " --flip -o " + path("flipped.xyz")), 0) << said_;
  EXPECT_EQ(agreement(shape, read_normals("flipped.xyz")), 0.0);
  ASSERT_EQ(run(path("in.xyz") + " --viewpoint 0.1 -0.1 0 -o " + path("seen.xyz")), 0) << said_;
  EXPECT_EQ(agreement(shape, read_normals("seen.xyz")), 0.0);
}

TEST_F(NormalsCommand, RefusesWithTheCodeOfTheCause) {
  write("in.xyz", sphere(50, 1.0), 0.0);
  std::ofstream(path("empty.xyz")) << "# x y z\n";
  const std::string in = path("in.xyz"), out = " -o " + path("out.xyz");
  EXPECT_EQ(run(in), 2);
  EXPECT_EQ(run(in + " --neighbours 1" + out), 2);
  EXPECT_EQ(run(in + " --viewpoint 1 2" + out), 2);
  EXPECT_EQ(run(in + " -o " + path("out.unknown")), 2);
  EXPECT_EQ(run(in + " -o " + in), 2);  // exists
  EXPECT_EQ(run(path("missing.xyz") + out), 3);
  EXPECT_EQ(run(in + " --keep" + out), 4);
  EXPECT_EQ(run(path("empty.xyz") + out), 4);
  EXPECT_FALSE(fs::exists(path("out.xyz")));
}

}  // namespace
}  // namespace pcednet::normals
