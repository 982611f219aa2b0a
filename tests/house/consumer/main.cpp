// Uses the installed library as an outside project would. Returns 0 if it works.
#include <pcednet/cloud/bounding_box.h>
#include <pcednet/core/version.h>
#include <pcednet/normals/prepare.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 2 || std::string(argv[1]) != pcednet::kVersion) {
    std::fprintf(stderr, "the headers are of version %s\n", pcednet::kVersion);
    return 1;
  }
  // A slope that rises along x by one half.
  std::vector<pcednet::Vec3> positions;
  for (int i = 0; i < 400; ++i) positions.emplace_back(i % 20, i / 20, 0.5 * (i % 20));
  const pcednet::Vec3 expected = pcednet::Vec3(-0.5, 0, 1).normalized();
  const auto prepared = pcednet::normals::estimate_oriented_normals(positions);
  for (const pcednet::Vec3& normal : prepared.normals) {
    if (!((normal - expected).norm() < 1e-6)) {
      std::fprintf(stderr, "a normal is (%g, %g, %g)\n", normal.x(), normal.y(), normal.z());
      return 1;
    }
  }
  const double diagonal = pcednet::bounding_box(positions).diagonal();
  return std::abs(diagonal - std::hypot(19.0, 19.0, 9.5)) < 1e-12 ? 0 : 1;
}
