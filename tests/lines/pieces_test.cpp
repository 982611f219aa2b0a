// What is made of pieces: joins, circles, strings and corners.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <utility>

#include "lines/made_pieces.h"
#include "pcednet/core/random.h"
#include "pcednet/lines/curves/chain.h"
#include "pcednet/lines/curves/touch.h"
#include "pcednet/lines/pieces/bridge.h"
#include "pcednet/lines/pieces/circles.h"
#include "pcednet/lines/pieces/corners.h"
#include "pcednet/lines/pieces/finish.h"
#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/pieces/strings.h"
#include "pcednet/lines/points/local_planes.h"
#include "support/expect_error.h"

namespace pcednet::lines {
namespace {

constexpr double kWithin = 0.2;

/// Part of the circle of radius 10 about the origin.
Piece round_piece(double from, double to) {
  return round_about_z(10, 0, from, to);
}

TEST(Pieces, OfOneLineAreJoinedOverAGap) {
  std::vector<Piece> pieces = {straight({0, 0, 0}, {10, 0, 0}), straight({14, 0, 0}, {30, 0, 0}),
                               straight({40, 0, 0}, {50, 0, 0})};
  join_pieces(pieces, 6.0, kWithin);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(length_of(pieces[0]), 30.0, 1.0);
}

TEST(Pieces, OfOneLineAreJoinedWhicheverWayTheyRun) {
  const Vec3 a(0, 0, 0), b(10, 0, 0), c(14, 0, 0), d(30, 0, 0);
  for (const auto& [first, second] :
       {std::pair(straight(a, b), straight(c, d)), std::pair(straight(a, b), straight(d, c)),
        std::pair(straight(b, a), straight(c, d)), std::pair(straight(b, a), straight(d, c))}) {
    std::vector<Piece> pieces = {first, second};
    join_pieces(pieces, 6.0, kWithin);
    ASSERT_EQ(pieces.size(), 1u);
    const std::vector<ChainNode>& nodes = pieces[0].nodes;
    const double sign = nodes.back().at.x() > nodes.front().at.x() ? 1.0 : -1.0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      EXPECT_GT(sign * nodes[i].along.x(), 0.99);
      if (i == 0) continue;
      EXPECT_GT(sign * (nodes[i].at - nodes[i - 1].at).x(), 0.0);
    }
  }
}

TEST(Pieces, StopToBeJoinedWhenTold) {
  std::vector<Piece> pieces = {straight({0, 0, 0}, {10, 0, 0})};
  const Progress stopped = {.report = {}, .cancelled = [] { return true; }};
  EXPECT_ERROR(ErrorKind::kCancelled, join_pieces(pieces, 6.0, kWithin, &stopped));
}

/// Creases one apart along the x axis.
std::vector<Crease> row_of_creases(double from, double to) {
  std::vector<Crease> creases;
  for (double x = from; x < to; x += 1.0) {
    creases.push_back({.at = {x, 0, 0},
                       .along = Vec3::UnitX(),
                       .side_a = Vec3::UnitY(),
                       .side_b = Vec3::UnitZ(),
                       .spacing = 1.0,
                       .probability = 1.0f,
                       .edge_class = kSharpEdge});
  }
  return creases;
}

TEST(Chains, CrossGapsUpToTheirWidth) {
  for (const double gap : {6.0, 12.0, 100.0, 1000.0}) {
    for (const double part : {0.5, 0.95, 1.05}) {
      std::vector<Crease> creases = row_of_creases(0.0, 20.0);
      const double beyond = 19.0 + std::max(part * gap, 3.0);
      for (Crease crease : row_of_creases(beyond, beyond + 20.0)) {
        crease.at.y() += 0.07 * part * gap;  // within the cone
        creases.push_back(crease);
      }
      Stage stage(nullptr, "chains", creases.size());
      const auto chains = trace(creases, gap, 0.0, stage);
      EXPECT_EQ(chains.size(), part < 1.0 ? 1u : 2u) << gap << ", part " << part;
    }
  }
}

TEST(Chains, StopWhenTold) {
  std::atomic traces = false;
  const Progress stopping = {
      .report = [&](const std::string&, double fraction) { traces = fraction >= 1.0; },
      .cancelled = [&] { return traces.load(); }};
  const auto creases = row_of_creases(0, 300);
  Stage stage(&stopping, "chains", creases.size());
  EXPECT_ERROR(ErrorKind::kCancelled, trace(creases, 6.0, 0.0, stage));
}

TEST(Pieces, OfOneLineStayApartIfTheirWedgesDiffer) {
  std::vector<Piece> pieces = {straight({0, 0, 0}, {10, 0, 0}),
                               straight({12, 0, 0}, {30, 0, 0}, Vec3::UnitY(), Vec3::UnitZ())};
  join_pieces(pieces, 6.0, kWithin);
  EXPECT_EQ(pieces.size(), 2u);
}

TEST(Pieces, ThatLieOnALongerOneAreDropped) {
  std::vector<Piece> pieces = {straight({0, 0, 0}, {30, 0, 0}),
                               straight({10, 0.5, 0}, {15, 0.5, 0}),
                               straight({10, 5, 0}, {15, 5, 0})};
  join_pieces(pieces, 1.0, kWithin);
  EXPECT_EQ(pieces.size(), 2u);
}

TEST(Circles, AreCompletedFromTheirArcs) {
  std::vector<Piece> pieces = {round_piece(0.0, 2.5), round_piece(3.3, 5.5)};
  complete_circles(pieces, no_points(), kWithin);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_TRUE(pieces[0].closed);
  EXPECT_NEAR(pieces[0].fit.radius, 10.0, 1e-6);
}

TEST(Circles, StayOpenWhereAnotherEdgeEndsOrTooLittleIsThere) {
  std::vector<Piece> cut = {round_piece(0.0, 5.0)};
  cut.push_back(straight(cut[0].ends[1], cut[0].ends[0]));
  complete_circles(cut, no_points(), kWithin);
  EXPECT_FALSE(cut[0].closed);
  std::vector<Piece> quarter = {round_piece(0.0, 1.6)};
  complete_circles(quarter, no_points(), kWithin);
  EXPECT_FALSE(quarter[0].closed);
}

TEST(Circles, AreCompletedWhereEdgePointsFollowThem) {
  std::vector<Piece> cut = {round_piece(0.0, 5.0)};
  cut.push_back(straight(cut[0].ends[1], cut[0].ends[0]));
  complete_circles(cut, EdgeRing(10, 0).points(), kWithin);
  EXPECT_TRUE(cut[0].closed);
  std::vector<Piece> part = {round_piece(0.0, 2.3)};
  complete_circles(part, EdgeRing(10, 2).points(), kWithin);  // too far from it
  EXPECT_FALSE(part[0].closed);
  complete_circles(part, EdgeRing(10, 0).points(), kWithin);
  EXPECT_TRUE(part[0].closed);
  std::vector<Piece> quarter = {round_piece(0.0, 1.6)};
  complete_circles(quarter, EdgeRing(10, 0).points(), kWithin);
  EXPECT_FALSE(quarter[0].closed);
}

/// The nodes of a regular polygon's sides as pieces: chords, turned as the circle within if `turn`.
std::vector<Piece> ring_of(double radius, int sides, bool turn) {
  std::vector<Piece> pieces;
  const auto at = [&](double t) { return Vec3(std::cos(t), std::sin(t), 0); };
  for (int i = 0; i < sides; ++i) {
    const double from = 2.0 * std::numbers::pi * i / sides;
    const double to = from + 2.0 * std::numbers::pi / sides;
    const Vec3 chord = (at(to) - at(from)).normalized(), out = at(0.5 * (from + to));
    Piece piece;
    for (const double part : {0.15, 0.5, 0.85}) {
      const Vec3 round = at(from + part * (to - from));
      const Vec3 on_chord = radius * (at(from) + part * (at(to) - at(from)));
      piece.nodes.push_back({.at = turn ? Vec3(radius * round) : on_chord,
                             .along = turn ? Vec3(-round.y(), round.x(), 0) : chord,
                             .side_a = turn ? round : out,
                             .side_b = Vec3::UnitZ(),
                             .spacing = 1.0});
    }
    piece.fit = fit_segment(piece.nodes);
    piece.ends = {piece.nodes.front().at, piece.nodes.back().at};
    pieces.push_back(piece);
  }
  return pieces;
}

TEST(Circles, ThatAreSmallAreFoundInShortSegments) {
  std::vector<Piece> pieces = ring_of(3.0, 6, true);
  pieces.push_back(straight({20, 0, 0}, {30, 0, 0}));
  complete_circles(pieces, no_points(), kWithin);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_FALSE(pieces[0].closed);  // the segment beside
  EXPECT_TRUE(pieces[1].closed);
  EXPECT_NEAR(pieces[1].fit.radius, 3.0, 1e-9);
  EXPECT_LT(pieces[1].fit.point.norm(), 1e-9);
}

TEST(Circles, AreNotPutInPlaceOfPolygons) {
  std::vector<Piece> square = ring_of(4.0, 4, false);
  complete_circles(square, no_points(), kWithin);
  EXPECT_EQ(square.size(), 4u);

  std::vector<Piece> prism = ring_of(3.0, 6, true);  // seen as round, but edges end on it
  for (int i = 0; i < 6; ++i) {
    const double t = 2.0 * std::numbers::pi * i / 6;
    const Vec3 corner(3.0 * std::cos(t), 3.0 * std::sin(t), 0);
    prism.push_back(straight(corner, corner + Vec3(0, 0, 6), Vec3::UnitX(), Vec3::UnitY()));
  }
  complete_circles(prism, no_points(), kWithin);
  EXPECT_EQ(prism.size(), 12u);
}

TEST(Strings, BeginAtFreeEndsBeforeTheyGoRound) {
  std::vector<std::size_t> partner(10, kNoPartner);
  const auto meet = [&](std::size_t a, std::size_t b) {
    partner[a] = b;
    partner[b] = a;
  };
  meet(1, 6), meet(7, 0);  // members 0 and 3, a ring
  meet(3, 5);              // the last ends of members 1 and 2
  const std::vector<EndString> strings = follow_partners(partner);
  ASSERT_EQ(strings.size(), 3u);
  EXPECT_EQ(strings[0].entries, (std::vector<std::size_t>{2, 5}));
  EXPECT_EQ(strings[1].entries, std::vector<std::size_t>{8});
  EXPECT_EQ(strings[2].entries, (std::vector<std::size_t>{0, 6}));
  EXPECT_FALSE(strings[0].closed || strings[1].closed);
  EXPECT_TRUE(strings[2].closed);
}

TEST(Strings, JoinWhatContinuesButNotALongLineAndALongArc) {
  std::vector<Piece> bent = {straight({0, 0, 0}, {10, 0, 0}), straight({11, 0, 0}, {20, 1.5, 0})};
  string_together(bent, 3.0, 0.5);
  ASSERT_EQ(bent.size(), 1u);
  EXPECT_EQ(bent[0].fit.kind, CurveKind::kPolyline);
  std::vector<Piece> corner = {straight({0, 0, 0}, {10, 0, 0}), straight({10, 1, 0}, {10, 9, 0})};
  string_together(corner, 3.0, 0.5);
  EXPECT_EQ(corner.size(), 2u);
  std::vector<Piece> tangent = {straight({10, -12, 0}, {10, -1, 0}, Vec3::UnitX(), Vec3::UnitZ()),
                                round_piece(0.0, 2.0)};
  string_together(tangent, 3.0, 0.5);
  EXPECT_EQ(tangent.size(), 2u);
}

TEST(Strings, AreDividedWhereSegmentsAndArcsExplainThem) {
  std::vector<Piece> tangent = {straight({10, -5, 0}, {10, -1, 0}, Vec3::UnitX(), Vec3::UnitZ()),
                                round_piece(0.0, 1.5)};
  string_together(tangent, 3.0, 0.5);
  ASSERT_EQ(tangent.size(), 1u);
  ASSERT_EQ(tangent[0].fit.kind, CurveKind::kPolyline);
  const std::size_t nodes = tangent[0].nodes.size();
  divide_strings(tangent, kWithin, 9);
  ASSERT_EQ(tangent.size(), 2u);
  EXPECT_EQ(tangent[0].fit.kind, CurveKind::kSegment);
  EXPECT_EQ(tangent[1].fit.kind, CurveKind::kArc);
  EXPECT_NEAR(tangent[1].fit.radius, 10.0, 0.5);
  EXPECT_EQ(tangent[0].nodes.size() + tangent[1].nodes.size(), nodes);

  Piece wave = straight({0, 0, 0}, {30, 0, 0});
  for (ChainNode& node : wave.nodes) node.at.y() = 2.0 * std::sin(node.at.x());
  wave.fit = {};
  std::vector<Piece> waves = {wave};
  divide_strings(waves, kWithin, 9);
  ASSERT_EQ(waves.size(), 1u);
  EXPECT_EQ(waves[0].fit.kind, CurveKind::kPolyline);
}

TEST(Strings, JoinWhatNoiseDrewSideBySideWhereItEndsFree) {
  const std::vector<Piece> beside = {straight({0, 0, 0}, {10, 0, 0}),
                                     straight({7, 2.4, 0}, {20, 2.4, 0})};
  std::vector<Piece> pieces = beside;
  string_together(pieces, 6.0, 0.5);
  EXPECT_EQ(pieces.size(), 2u);
  string_free_ends(pieces, 6.0, 0.5, 0.3);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].fit.kind, CurveKind::kPolyline);
  for (std::size_t i = 1; i < pieces[0].nodes.size(); ++i) {
    EXPECT_GT(pieces[0].nodes[i].at.x(), pieces[0].nodes[i - 1].at.x());
  }

  std::vector<Piece> corner = beside;  // two edges that end in the corner of a third
  corner[0] = straight({0, 0, 0}, {9, 0, 0});
  corner.push_back(straight({10, -1, 0}, {10, -12, 0}, Vec3::UnitX(), Vec3::UnitZ()));
  string_free_ends(corner, 6.0, 0.5, 0.3);
  EXPECT_EQ(corner.size(), 3u);
}

TEST(Strings, SimplifiedPolylinesStayWithinTheTolerance) {
  std::vector<Vec3> places;
  for (int i = 0; i <= 100; ++i) {
    places.emplace_back(0.1 * i, std::sin(0.1 * i), 0.0);
  }
  const auto vertices = simplified(places, 0.05);
  EXPECT_LT(vertices.size(), 20u);
  EXPECT_EQ(vertices.front(), places.front());
  EXPECT_EQ(vertices.back(), places.back());
  for (const Vec3& place : places) {
    double nearest = 1.0;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      const Vec3 along = vertices[i] - vertices[i - 1];
      const double t =
          std::clamp((place - vertices[i - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (place - vertices[i - 1] - t * along).norm());
    }
    EXPECT_LE(nearest, 0.05 + 1e-12);
  }
}

TEST(Corners, AreWhereThreeLinesMeet) {
  const std::vector<Piece> pieces = {straight({2, 0, 0}, {20, 0, 0}),
                                     straight({0, 3, 0}, {0, 20, 0}),
                                     straight({0, 0, 1.5}, {0, 0, 20})};
  const Corners corners = find_corners(pieces, 5.0, 0.8);
  ASSERT_EQ(corners.places.size(), 1u);
  EXPECT_LT(corners.places[0].norm(), 2e-3);
  for (const auto& ends : corners.of_ends) {
    EXPECT_EQ(ends[0], 0u);
    EXPECT_EQ(ends[1], Corners::kNoCorner);
  }
}

TEST(Corners, EndOnTheInsideOfAnotherPiece) {
  const std::vector<Piece> pieces = {straight({-20, 0, 0}, {20, 0, 0}),
                                     straight({1, 2, 0}, {1, 20, 0})};
  const Corners corners = find_corners(pieces, 5.0, 0.8);
  ASSERT_NE(corners.of_ends[1][0], Corners::kNoCorner);
  EXPECT_LT((corners.places[corners.of_ends[1][0]] - Vec3(1, 0, 0)).norm(), 1e-6);
  EXPECT_EQ(corners.of_ends[0][0], Corners::kNoCorner);
}

TEST(Corners, AreNotWhereLinesMissEachOther) {
  const std::vector<Piece> pieces = {straight({2, 0, 0}, {20, 0, 0}),
                                     straight({0, 2, 3}, {0, 20, 3})};
  EXPECT_TRUE(find_corners(pieces, 9.0, 0.8).places.empty());
}

TEST(Corners, OfALineAndAnArcAreWhereTheyTouch) {
  std::vector<Piece> pieces = {straight({10.2, -20, 0}, {10.2, 3, 0}), round_piece(0.4, 2.0)};
  const Corners corners = find_corners(pieces, 9.0, 0.8);
  ASSERT_EQ(corners.places.size(), 1u);
  EXPECT_LT((corners.places[0] - Vec3(10.1, 0, 0)).norm(), 1e-6);
  EXPECT_EQ(corners.of_ends[0][1], 0u);
  EXPECT_EQ(corners.of_ends[1][0], 0u);
}

Fit circle(const Vec3& centre, double radius) {
  return {CurveKind::kArc, centre, Vec3::UnitZ(), radius, 0.0};
}

TEST(TouchingPlace, IsOnTheLineThroughBothCentres) {
  const auto outside = touching_place(circle({0, 0, 0}, 5), circle({8.2, 0, 0}, 3), {5, 1, 0}, 0.5);
  ASSERT_TRUE(outside);
  EXPECT_LT((*outside - Vec3(5.1, 0, 0)).norm(), 1e-9);
  const auto inside = touching_place(circle({0, 0, 0}, 5), circle({-3, 0, 0}, 2), {-5, 1, 0}, 0.5);
  ASSERT_TRUE(inside);
  EXPECT_LT((*inside - Vec3(-5, 0, 0)).norm(), 1e-9);
}

TEST(TouchingPlace, IsNoneOfLinesOrCurvesThatCrossOrMiss) {
  const Fit line{CurveKind::kSegment, {4, 0, 0}, Vec3::UnitY(), 0.0, 0.0};
  EXPECT_FALSE(touching_place(line, line, {0, 0, 0}, 0.5));
  EXPECT_FALSE(touching_place(line, circle({0, 0, 0}, 5), {4, 3, 0}, 0.5));
  EXPECT_TRUE(touching_place(line, circle({0, 0, 0}, 4.1), {4, 1, 0}, 0.5));
  EXPECT_FALSE(touching_place(circle({0, 0, 0}, 5), circle({0.5, 0, 0}, 5), {5, 0, 0}, 1.0));
}

/// Points one apart on a strip along x, but for those with `from` < x < `to`.
struct Strip {
  std::vector<Vec3> positions, normals;
  std::vector<std::uint8_t> classes;

  explicit Strip(double from = 0.0, double to = 0.0) {
    Random random(7);
    for (int i = 0; i < 1200; ++i) {
      const double y = 12.0 * random.uniform() - 6.0, x = 100.0 * random.uniform();
      const Vec3 place(x, y, 0.0);
      if (place.x() > from && place.x() < to) continue;
      positions.push_back(place);
      normals.push_back(Vec3::UnitZ());
      classes.push_back(kNonEdge);
    }
  }
};

std::size_t bridged(std::vector<Piece> pieces, const Strip& strip = Strip()) {
  const OrderedPoints cloud({strip.positions, strip.normals, strip.classes});
  bridge_gaps(pieces, cloud, kWithin, 0.0);
  return pieces.size();
}

TEST(Bridges, JoinTwoPiecesOfOneLineOverAWideGap) {
  const Piece left = straight({5, 0, 0}, {25, 0, 0}), right = straight({45, 0, 0}, {70, 0, 0});
  EXPECT_EQ(bridged({left, right}), 1u);
  EXPECT_EQ(bridged({right, left}), 1u);
  EXPECT_EQ(bridged({left, straight({70, 0, 0}, {45, 0, 0})}), 1u);
  EXPECT_EQ(bridged({left, right, straight({85, 0, 0}, {95, 0, 0})}), 1u);
}

TEST(Bridges, AreNotBuiltWithoutReason) {
  const Piece left = straight({5, 0, 0}, {25, 0, 0}), right = straight({45, 0, 0}, {70, 0, 0});
  EXPECT_EQ(bridged({left, right}, Strip(27, 43)), 2u) << "no surface";
  EXPECT_EQ(bridged({left, straight({25, 5, 0}, {25, 1, 0}), right}), 3u) << "a corner";
  EXPECT_EQ(bridged({left, straight({45, 3, 0}, {70, 3, 0})}), 2u) << "another line";
  EXPECT_EQ(bridged({left, straight({60, 0, 0}, {90, 0, 0})}), 2u) << "too wide";
  EXPECT_EQ(bridged({straight({15, 0, 0}, {20, 0, 0}), straight({45, 0, 0}, {50, 0, 0})}), 2u);
  EXPECT_EQ(bridged({left, straight({45, 0, 0}, {70, 0, 0}, Vec3::UnitY(), Vec3::UnitZ())}), 2u);
}

TEST(LocalPlanes, AreThoseOfACorner) {
  NearPoints points;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 36; ++i) {
      Vec3 place = Vec3::Zero();
      place[(axis + 1) % 3] = 0.3 + i % 6;
      place[(axis + 2) % 3] = 0.3 + i / 6;
      points.add(place, Vec3::Unit(axis), 0.0);
    }
  }
  std::vector<LocalPlane> planes;
  find_planes(points, 0.2, planes);
  ASSERT_EQ(planes.size(), 3u);
  for (const LocalPlane& plane : planes) {
    EXPECT_NEAR(plane.normal.cwiseAbs().maxCoeff(), 1.0, 1e-6);
    EXPECT_NEAR(plane.distance, 0.0, 1e-6);
    EXPECT_GE(plane.support, 30);
  }
}

}  // namespace
}  // namespace pcednet::lines
