#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

inline constexpr std::size_t kLeastArc = 5;     ///< nodes
inline constexpr double kSmallestRadius = 1.2;  ///< in spacings

/// The initial pieces, indexed by their first nodes and by their ends.
struct PieceIndex {
  explicit PieceIndex(const std::vector<Piece>& pieces);

  spatial::KdTree starts;  ///< the first node of each piece
  EndIndex open;
  double largest_spacing = 0.0;
};

/// Whether the wedges at two nodes agree, seen from the axis of the circle.
bool same_wedge(const Fit& circle, const ChainNode& a, const ChainNode& b);

/// Whether the piece belongs to a small circle, or to the visible part of its wall.
bool belongs_to(const Fit& circle, const Piece& piece);

/// Equal parts of a circle, and which of them have points.
class Sectors {
 public:
  Sectors(const Fit& circle, std::size_t count);

  double add(const Vec3& place);  ///< returns its angle about the axis
  std::size_t points() const { return points_; }
  std::size_t covered() const;  ///< parts with points

 private:
  Fit circle_;
  Vec3 x_;
  std::vector<std::uint8_t> seen_;
  std::size_t points_ = 0;
};

/// The largest angle between neighbours of these, at least one, about an axis. Sorts them.
double widest_gap(std::vector<double>& angles);

/// A part of a circle without nodes.
struct Gap {
  Vec3 from, to;
  double length;
};

/// Sorts the nodes about the axis and returns the gaps between them.
std::vector<Gap> sort_about_axis(const Fit& circle, std::vector<ChainNode>& nodes);

/// Whether edge points lie all along the gaps of a circle that is large enough for the test.
bool edges_follow(const Fit& circle, const std::vector<Gap>& gaps, double spacing,
                  const OrderedPoints& cloud);

/// Whether another long piece ends where a gap begins; pieces in `joined`, which is ascending, do
/// not count.
bool is_blocked(const std::vector<Gap>& gaps, const std::vector<Piece>& pieces,
                const PieceIndex& index, const std::vector<std::size_t>& joined);

}  // namespace pcednet::lines
