#include "pcednet/detect/clean_up.h"

#include <algorithm>
#include <array>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/detect/decide.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::detect {

void clean_up(std::span<const Vec3> positions, Classification& result,
              const CleanUpOptions& options, const Progress* progress) {
  const std::size_t points = positions.size();
  if (options.neighbours < 1 || result.classes.size() != points) {
    throw Error(ErrorKind::kUsage, "clean-up: needs a neighbour or more, and a class per point");
  }
  const spatial::KdTree tree(positions);
  const std::vector<float> sharp = result.p_sharp, smooth = result.p_smooth;
  const std::vector<std::uint8_t> before = result.classes;
  Stage stage(progress, "clean up", points);
  parallel_blocks(points, 4096, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      if (before[i] == kUnlabelled) continue;
      tree.nearest(positions[i], static_cast<std::size_t>(options.neighbours) + 1, near);
      double sum_sharp = sharp[i], sum_smooth = smooth[i], weights = 1.0;
      for (const spatial::Neighbour& neighbour : near) {
        const std::uint32_t j = neighbour.index;
        if (j == i || before[j] == kUnlabelled) continue;
        sum_sharp += options.weight * static_cast<double>(sharp[j]);
        sum_smooth += options.weight * static_cast<double>(smooth[j]);
        weights += options.weight;
      }
      const double p_sharp = sum_sharp / weights, p_smooth = sum_smooth / weights;
      result.p_sharp[i] = static_cast<float>(p_sharp);
      result.p_smooth[i] = static_cast<float>(p_smooth);
      const std::array<double, 3> p = {1.0 - p_sharp - p_smooth, p_smooth, p_sharp};
      result.classes[i] =
          static_cast<std::uint8_t>(std::max_element(p.begin(), p.end()) - p.begin());
    }
    stage.advance(end - begin);
  });
  result.counts = count_classes(result.classes);
}

}  // namespace pcednet::detect
