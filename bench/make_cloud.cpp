// bench_cloud KIND POINTS OUT [bare]: writes a cloud of the benchmarks, without normals if bare.
#include <cstdio>
#include <exception>
#include <string>

#include "clouds.h"
#include "pcednet/cloud/point_cloud.h"
#include "pcednet/formats/write_cloud.h"

int main(int count, char** arguments) {
  if (count < 4) {
    std::fprintf(stderr, "bench_cloud KIND POINTS OUT [bare]; kinds:\n");
    for (const pcednet::bench::CloudKind& kind : pcednet::bench::cloud_kinds()) {
      std::fprintf(stderr, "  %-12s %s\n", kind.name, kind.what);
    }
    return 2;
  }
  try {
    pcednet::bench::Cloud made = pcednet::bench::make_cloud(arguments[1], std::stoul(arguments[2]));
    pcednet::PointCloud cloud;
    cloud.positions = std::move(made.positions);
    if (count == 4) cloud.normals = std::move(made.normals);
    pcednet::formats::write_cloud(arguments[3], cloud, {.overwrite = pcednet::Overwrite::kYes});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_cloud: %s\n", error.what());
    return 1;
  }
}
