#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/lines/exact/contacts.h"
#include "pcednet/lines/exact/fold_surface.h"
#include "pcednet/lines/exact/planes.h"
#include "pcednet/lines/exact/strip.h"
#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/points/ordered_points.h"
#include "pcednet/lines/points/plane_line.h"

namespace pcednet::lines {

inline constexpr double kLeastSineOfFold = 0.34;  ///< of its planes: 20 degrees

/// The line in which two planes meet, seen from a place near it; none if they are turned too
/// little.
std::optional<PlaneLine> fold_line(const PlanePatch& a, const PlanePatch& b, const Vec3& near);

/// Two surfaces and the line in which they meet.
class FoldSearch {
 public:
  FoldSearch(const OrderedPoints& cloud, const FoldSurface& a, const FoldSurface& b,
             const PlaneLine& line, double spacing)
      : cloud_(cloud), a_(a), b_(b), line_(line), spacing_(spacing) {}

  /// The folds where these points of the pair are.
  std::vector<Piece> folds(std::span<const PlaneContact> contacts) const;

  /// The folds as far as the cloud has points along the line from a place near it.
  std::vector<Piece> folds_from(const Vec3& near) const;

  /// The fillets there: along the middle of the arc between the planes.
  std::vector<Piece> fillets(std::span<const PlaneContact> contacts) const;

  /// Whether half of the fold or more is along one of the fillets.
  bool is_rounded(const Piece& fold, std::span<const Piece> fillets) const;

  /// The short folds between neighbouring vertices, which lie on the line, that `known` leaves.
  std::vector<Piece> folds_between(std::span<const Vec3> vertices,
                                   std::span<const Piece> known) const;

 private:
  /// The points of a surface on one side of the line.
  struct Side {
    Vec3 into;  ///< unit
    Strip strip;
  };

  std::vector<Interval> regions(std::span<const PlaneContact> contacts) const;
  Interval reachable_from(double start) const;
  std::vector<std::uint32_t> points_beside(const Interval& region) const;
  std::array<Side, 2> sides_of(const FoldSurface& surface,
                               std::span<const std::uint32_t> points) const;
  void add_folds(const Interval& region, std::vector<Piece>& found) const;
  void add_fillets(const Interval& region, std::vector<Piece>& found) const;
  bool has_only_surfaces(const Interval& interval, std::span<const std::uint32_t> points) const;
  std::optional<Piece> fold_between(const Interval& interval) const;
  Interval interval_of(const Piece& piece) const;
  /// That the points beside the interval, among these, are of an edge.
  double mean_probability(const Interval& interval, std::span<const std::uint32_t> points) const;
  Piece piece_along(const Interval& interval, const Vec3& side_a, const Vec3& side_b) const;
  Vec3 place(double along) const { return line_.point + along * spacing_ * line_.along; }
  double along(const Vec3& place) const {
    return (place - line_.point).dot(line_.along) / spacing_;
  }

  const OrderedPoints& cloud_;
  FoldSurface a_, b_;
  PlaneLine line_;
  double spacing_;
};

}  // namespace pcednet::lines
