#include "pcednet/lines/pieces/observe.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace pcednet::lines {

void observe(ChainNode& node, const OrderedPoints& cloud) {
  std::vector<spatial::Neighbour> near;
  cloud.within(node.at, node.spacing, near);
  const auto edge = std::stable_partition(
      near.begin(), near.end(), [&](const auto& point) { return cloud.is_edge(point.index); });
  node.edge_points =
      0.5 * static_cast<double>(edge - near.begin());  // its neighbours see them, too
  if (edge != near.begin()) near.erase(edge, near.end());
  const auto count = static_cast<double>(near.size());
  for (const auto& point : near) {
    node.probability += static_cast<double>(cloud.probability(point.index)) / count;
    if (cloud.edge_class(point.index) == kSharpEdge) node.sharp += 1.0 / count;
  }
}

void add_observed_nodes(Piece& segment, std::size_t count, const ChainNode& like,
                        const OrderedPoints& cloud) {
  const Vec3 whole = segment.ends[1] - segment.ends[0];
  for (std::size_t k = 0; k < count; ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    ChainNode node = like;
    node.at = segment.ends[0] + share * whole;
    observe(node, cloud);
    segment.nodes.push_back(node);
  }
}

}  // namespace pcednet::lines
