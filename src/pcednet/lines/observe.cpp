#include "pcednet/lines/observe.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace pcednet::lines {

void observe(ChainNode& node, const OrderedPoints& cloud) {
  std::vector<spatial::Neighbour> near;
  cloud.within(node.at, node.spacing, near);
  std::erase_if(near, [&](const auto& point) { return !cloud.is_edge(point.index); });
  const auto edges = static_cast<double>(std::max<std::size_t>(near.size(), 1));
  for (const auto& point : near) {
    node.probability += static_cast<double>(cloud.probability(point.index)) / edges;
    if (cloud.edge_class(point.index) == kSharpEdge) node.sharp += 1.0 / edges;
  }
  node.edge_points = 0.5 * static_cast<double>(near.size());  // both nodes beside it see them, too
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
