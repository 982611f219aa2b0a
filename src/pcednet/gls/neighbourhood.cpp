#include "pcednet/gls/neighbourhood.h"

#include <array>
#include <cstddef>
#include <utility>

#include "pcednet/gls/scales.h"

namespace pcednet::gls {

void order_by_shell(std::span<const double> radii, std::vector<spatial::Neighbour>& neighbours,
                    std::vector<spatial::Neighbour>& scratch) {
  // A branch-free bisection: mispredicted branches for random shells would cost more than the
  // search.
  const auto shell_of = [&](const spatial::Neighbour& neighbour) {
    std::size_t shell = 0;
    for (std::size_t step = radii.size() / 2; step > 0; step /= 2) {
      const double radius = radii[shell + step - 1];
      shell += static_cast<std::size_t>(neighbour.sq_distance >= radius * radius) * step;
    }
    return shell;
  };
  std::array<std::size_t, kMaxScales + 1> next = {};  // where the next one of each shell goes
  for (const spatial::Neighbour& neighbour : neighbours) ++next[shell_of(neighbour) + 1];
  for (std::size_t s = 1; s < radii.size(); ++s) next[s] += next[s - 1];
  scratch.resize(neighbours.size());
  for (const spatial::Neighbour& neighbour : neighbours) {
    scratch[next[shell_of(neighbour)]++] = neighbour;
  }
  std::swap(neighbours, scratch);
}

}  // namespace pcednet::gls
