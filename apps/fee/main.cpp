// pcednet-fee: feature edges by the Voronoi covariance measure (Merigot, Ovsjanikov, Guibas 2011),
// as CGAL implements it. This program, linked with CGAL's Point Set Processing, is under the GPL
// version 3 or later; the rest of pcednet is not, and talks to it by files alone:
//
//     pcednet-fee R r < POSITIONS > RATIOS
//
// R, r: offset and convolution radius. POSITIONS: x y z of every point, finite, as raw doubles.
// RATIOS: a raw double per point, l1 / (l0 + l1 + l2) of the measure's eigenvalues l0 <= l1 <= l2,
// which CGAL's vcm_is_on_feature_edge() compares with a threshold.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/vcm_estimate_edges.h>

#include <array>
#include <cstdio>
#include <exception>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

std::vector<Kernel::Point_3> read_positions() {
  std::vector<Kernel::Point_3> points;
  std::array<double, 3> p;
  while (std::fread(p.data(), sizeof(double), 3, stdin) == 3) points.emplace_back(p[0], p[1], p[2]);
  return points;
}

double ratio(std::array<double, 6>& measure) {
  std::array<double, 3> values;
  using Diagonalize = CGAL::Default_diagonalize_traits<double, 3>;
  if (!Diagonalize::diagonalize_selfadjoint_covariance_matrix(measure, values)) return 0.0;
  const double sum = values[0] + values[1] + values[2];
  return sum > 0.0 ? values[1] / sum : 0.0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: pcednet-fee R r < positions > ratios\n", stderr);
    return 2;
  }
  try {
    const std::vector<Kernel::Point_3> points = read_positions();
    std::vector<std::array<double, 6>> measures;
    CGAL::compute_vcm(points, measures, std::atof(arguments[1]), std::atof(arguments[2]));
    for (auto& measure : measures) {
      const double value = ratio(measure);
      std::fwrite(&value, sizeof value, 1, stdout);
    }
    return std::fflush(stdout) == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pcednet-fee: %s\n", error.what());
    return 1;
  }
}
