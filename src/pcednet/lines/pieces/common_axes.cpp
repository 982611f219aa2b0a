#include "pcednet/lines/pieces/common_axes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pcednet::lines {
namespace {

constexpr std::size_t kMostAxes = 6;
constexpr std::size_t kMostDirections = 256;  ///< to choose from, of the longest pieces
constexpr double kLikeAxis = 0.999;           ///< cosine
constexpr double kLeastVotes = 0.04;          ///< share of all
constexpr double kLeastSine = 0.5;            ///< of a segment and its side

struct CommonAxis {
  Vec3 sum;  ///< of the directions, by their votes
  double votes;
};

void vote(std::vector<CommonAxis>& axes, const Vec3& direction, double votes) {
  for (CommonAxis& axis : axes) {
    const double cosine = direction.dot(axis.sum.normalized());
    if (std::abs(cosine) < kLikeAxis) continue;
    axis.sum += std::copysign(votes, cosine) * direction;
    axis.votes += votes;
    return;
  }
  if (axes.size() < kMostDirections) axes.push_back({votes * direction, votes});
}

}  // namespace

std::vector<Vec3> common_axes(const std::vector<Piece>& pieces) {
  std::vector<CommonAxis> axes;
  for (const std::size_t i : longest_first(pieces)) {
    const Piece& piece = pieces[i];
    const auto votes = static_cast<double>(piece.nodes.size());
    if (piece.fit.kind == CurveKind::kArc) vote(axes, piece.fit.direction, votes);
    if (piece.fit.kind != CurveKind::kSegment) continue;
    for (const Vec3& side : {piece.middle().side_a, piece.middle().side_b}) {
      const Vec3 normal = piece.fit.direction.cross(side);
      if (normal.norm() > kLeastSine) vote(axes, normal.normalized(), votes);
    }
  }
  double all = 0.0;
  for (const CommonAxis& axis : axes) all += axis.votes;
  std::stable_sort(axes.begin(), axes.end(),
                   [](const CommonAxis& a, const CommonAxis& b) { return a.votes > b.votes; });
  std::vector<Vec3> common;
  for (const CommonAxis& axis : axes) {
    if (common.size() == kMostAxes || axis.votes < kLeastVotes * all) break;
    common.push_back(axis.sum.normalized());
  }
  return common;
}

}  // namespace pcednet::lines
