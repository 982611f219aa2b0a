// Edges from C++: of arrays in memory, and from file to file.
//   detect_edges MODEL.safetensors             finds the edge points and the edges of a cube
//   detect_edges MODEL.safetensors IN OUT      labels the points of a file
#include <pcednet/formats/read_cloud.h>
#include <pcednet/formats/write_cloud.h>
#include <pcednet/pcednet.h>

#include <cstdio>
#include <string>

namespace {

/// Points at equal steps on the faces of a cube of 2 x 2 x 2, without normals.
pcednet::PointCloud cube() {
  constexpr int kSteps = 60;
  pcednet::PointCloud cloud;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i < kSteps * kSteps; ++i) {
        pcednet::Vec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = 2.0 * (i % kSteps + 0.5) / kSteps - 1.0;
        p[(axis + 2) % 3] = 2.0 * (i / kSteps + 0.5) / kSteps - 1.0;
        cloud.positions.push_back(p);
      }
    }
  }
  return cloud;
}

void from_arrays(const pcednet::detect::EdgeModel& model) {
  const pcednet::PointCloud cloud = cube();
  const auto prepared = pcednet::detect::prepare(cloud, {.average_noise = true});
  for (const std::string& note : prepared.notes) std::printf("note: %s\n", note.c_str());
  const auto found = pcednet::detect::classify(prepared, model);
  std::printf("%zu points: %zu sharp, %zu smooth\n", cloud.size(), found.counts.sharp,
              found.counts.smooth);
  const auto curves = pcednet::lines::find_lines(
      {prepared.positions, prepared.normals, found.classes, found.p_sharp, found.p_smooth});
  std::printf("%zu curves; the first is %.3f long\n", curves.size(),
              curves.empty() ? 0.0 : pcednet::lines::length_of(curves.front()));
}

void from_file_to_file(const pcednet::detect::EdgeModel& model, const char* in, const char* out) {
  pcednet::PointCloud cloud = pcednet::formats::read_cloud(in).cloud;
  const auto prepared = pcednet::detect::prepare(cloud, {.average_noise = true});
  auto found = pcednet::detect::classify(prepared, model);
  pcednet::detect::mark_boundary(prepared, found);
  pcednet::detect::add_result(cloud, prepared, found, model);
  pcednet::formats::write_cloud(out, cloud);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 4) {
    std::fprintf(stderr, "usage: detect_edges MODEL [IN OUT]\n");
    return 2;
  }
  try {
    const auto model = pcednet::detect::load_model(argv[1]);
    if (argc == 2) {
      from_arrays(model);
    } else {
      from_file_to_file(model, argv[2], argv[3]);
    }
  } catch (const pcednet::Error& error) {
    std::fprintf(stderr, "detect_edges: %s\n", error.what());
    return static_cast<int>(error.kind());
  }
}
