#include "workbench/annotate/scene/line_review.h"

#include <gtest/gtest.h>

#include <fstream>

#include "io/scratch.h"
#include "support/expect_error.h"
#include "workbench/annotate/saving.h"

namespace pcednet::annotate {
namespace {

/// Three lines of lengths 1, 2 and 3.
LineReview three_lines() {
  auto curves = std::make_shared<std::vector<lines::Curve>>();
  for (int i = 1; i <= 3; ++i) {
    curves->push_back(
        {.kind = lines::CurveKind::kSegment, .points = {Vec3::Zero(), Vec3(i, 0, 0)}});
  }
  LineReview review{.version = 5, .curves = curves};
  review.decisions.resize(3);
  return review;
}

TEST(LineReview, KeepsTheAcceptedLinesInTheirOrder) {
  LineReview review = three_lines();
  EXPECT_ERROR(ErrorKind::kInsufficient, accepted_curves(review));
  decide(review, {.version = 5, .decision = Decision::kAccepted, .lines = {2, 0, 1}});
  decide(review, {.version = 5, .decision = Decision::kRejected, .lines = {1}});
  const auto accepted = accepted_curves(review);
  ASSERT_EQ(accepted.size(), 2u);
  EXPECT_EQ(length_of(accepted[0]), 1.0);
  EXPECT_EQ(length_of(accepted[1]), 3.0);
}

TEST(LineReview, ChangesNothingWhenItRefuses) {
  LineReview review = three_lines();
  EXPECT_ERROR(ErrorKind::kUsage,
               decide(review, {.version = 5, .decision = Decision::kAccepted, .lines = {0, 3}}));
  EXPECT_ERROR(ErrorKind::kInsufficient,
               decide(review, {.version = 4, .decision = Decision::kAccepted, .lines = {0}}));
  EXPECT_EQ(review.decisions, std::vector<Decision>(3, Decision::kOpen));
  LineReview none;
  EXPECT_ERROR(ErrorKind::kInsufficient, decide(none, {}));
  EXPECT_ERROR(ErrorKind::kInsufficient, accepted_curves(none));
}

TEST(LineReview, KeepsDecisionsOnTheSameLinesInAFile) {
  const io::Scratch scratch;
  const auto file = decisions_of(scratch.path("a.json"), 1);
  EXPECT_EQ(file.filename(), "a.json.lines-2");
  LineReview review = three_lines();
  const std::vector<Decision> open(3, Decision::kOpen);
  EXPECT_EQ(kept_decisions(file, *review.curves), open);
  decide(review, {.version = 5, .decision = Decision::kAccepted, .lines = {2}});
  decide(review, {.version = 5, .decision = Decision::kRejected, .lines = {0}});
  keep_decisions(file, review);
  EXPECT_EQ(kept_decisions(file, *review.curves), review.decisions);
  auto others = *review.curves;
  others[1].points[1].z() = 1e-9;
  EXPECT_EQ(kept_decisions(file, others), open);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 3);
  EXPECT_EQ(kept_decisions(file, *review.curves), open);
}

/// Vertices of polylines and circles in a DXF of an upright circle.
std::pair<std::size_t, std::size_t> drawn(io::DxfArcs arcs, double tolerance) {
  const io::Scratch scratch;
  const lines::Curve circle{.kind = lines::CurveKind::kCircle,
                            .points = {Vec3(1, 0, 0)},
                            .closed = true,
                            .axis = Vec3::UnitY(),
                            .radius = 1.0};
  const LineReview review{.curves = std::make_shared<std::vector<lines::Curve>>(1, circle),
                          .decisions = {Decision::kAccepted},
                          .tolerance = tolerance};
  const auto file = scratch.path("a.dxf");
  write_lines(file, review, PointCloud{}, Overwrite::kNo, arcs);
  std::ifstream text(file);
  std::pair<std::size_t, std::size_t> found;
  for (std::string line; text >> line;) {
    found.first += line == "VERTEX" ? 1 : 0;
    found.second += line == "CIRCLE" ? 1 : 0;
  }
  return found;
}

TEST(LineReview, WritesArcsAndPolylinesAsTheCommandDoes) {
  EXPECT_EQ(drawn(io::DxfArcs::kAll, 0.01), std::pair(std::size_t{0}, std::size_t{1}));
  for (const auto arcs : {io::DxfArcs::kFlat, io::DxfArcs::kNone}) {
    const auto [vertices, circles] = drawn(arcs, 0.01);
    EXPECT_EQ(circles, 0u);
    EXPECT_GT(vertices, 50u);
    EXPECT_GT(drawn(arcs, 1e-5).first, 5 * vertices) << "the tolerance of the lines is kept";
  }
}

}  // namespace
}  // namespace pcednet::annotate
