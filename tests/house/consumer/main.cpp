// Uses the installed library as an outside program would, on points in memory:
//   consumer VERSION MODEL
// Returns 0 if it finds the fold of a roof.
#include <pcednet/pcednet.h>

#include <cmath>
#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  if (argc != 3 || std::string(argv[1]) != pcednet::kVersion) {
    std::fprintf(stderr, "the headers are of version %s\n", pcednet::kVersion);
    return 1;
  }
  pcednet::PointCloud roof;
  for (int i = 0; i < 10000; ++i) {
    const double x = i % 100 - 49.5, y = i / 100;
    roof.positions.emplace_back(x, y, -std::abs(x));
  }
  const auto model = pcednet::detect::load_model(argv[2]);
  const auto prepared = pcednet::detect::prepare(roof);
  const auto found = pcednet::detect::classify(prepared, model);
  int sharp_on_fold = 0, sharp_elsewhere = 0;
  for (std::size_t i = 0; i < roof.size(); ++i) {
    const pcednet::Vec3& p = roof.positions[i];
    if (found.classes[i] != pcednet::kSharpEdge || p.y() < 10 || p.y() > 89) continue;
    (std::abs(p.x()) < 1 ? sharp_on_fold : sharp_elsewhere) += 1;
  }
  if (prepared.notes.size() != 1 || sharp_on_fold < 120 || sharp_elsewhere > 400) {
    std::fprintf(stderr, "%zu notes, %d sharp points on the fold and %d elsewhere\n",
                 prepared.notes.size(), sharp_on_fold, sharp_elsewhere);
    return 1;
  }
}
