#include "workbench/annotate/learn/adapt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "pcednet/core/random_vectors.h"
#include "workbench/annotate/learn/held_out.h"

namespace pcednet::annotate {
namespace {

/// 8,000 points of a cube, described as the model `scan` wants it, with its answer.
class Adapting : public testing::Test {
 protected:
  void SetUp() override { make(false); }

  void make(bool reversed) {
    Random random(5);
    cloud_ = {};
    for (int i = 0; i < 8000; ++i) {
      const int axis = static_cast<int>(random.index(3));
      Vec3 p = uniform_vector(random, -Vec3::Ones(), Vec3::Ones());
      Vec3 normal = Vec3::Zero();
      p[axis] = normal[axis] = random.uniform() < 0.5 ? -1 : 1;
      cloud_.positions.push_back(p);
      cloud_.normals.push_back(normal);
    }
    if (reversed) {
      std::reverse(cloud_.positions.begin(), cloud_.positions.end());
      std::reverse(cloud_.normals.begin(), cloud_.normals.end());
    }
    prepared_ = detect::prepare(cloud_);
    auto model = detect::load_model(PCEDNET_SOURCE_DIR "/models/scan.safetensors");
    described_ = describe_once(prepared_, model.descriptor, {});
    start_ = make_start(std::move(model), subject());
  }

  Subject subject() const { return {{{*described_, cloud_.positions, prepared_.curve}}}; }

  /// Gives the points within `reach` of `centre` the class that `classes` has for them.
  void paint(const Vec3& centre, double reach, const std::vector<std::uint8_t>& classes,
             std::vector<std::uint8_t>& labels) const {
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if ((cloud_.positions[i] - centre).norm() < reach) labels[i] = classes[i];
    }
  }

  /// The share of the points of `which` that have the class `c` in `found`.
  static double share(const std::vector<std::uint8_t>& which, std::uint8_t label,
                      const std::vector<std::uint8_t>& found, std::uint8_t c) {
    double all = 0, same = 0;
    for (std::size_t i = 0; i < which.size(); ++i) {
      if (which[i] != label) continue;
      ++all;
      same += found[i] == c ? 1 : 0;
    }
    return same / all;
  }

  std::vector<std::uint8_t> nothing() const {
    return std::vector<std::uint8_t>(cloud_.size(), kUnlabelled);
  }

  PointCloud cloud_ = {};
  detect::PreparedCloud prepared_ = {};
  std::shared_ptr<const Described> described_ = {};
  Start start_ = {};
};

TEST_F(Adapting, ToWhatTheModelKnewChangesLittle) {
  const auto& before = start_.answer.classes;
  ASSERT_GT(std::count(before.begin(), before.end(), kSharpEdge), 200);
  auto labels = nothing();
  paint({1, 1, 0}, 0.2, before, labels);
  const Adapted adapted = adapt("a", start_, subject(), labels, 1);
  ASSERT_TRUE(adapted.model.context.has_value());
  for (const std::uint8_t c : {kNonEdge, kSharpEdge}) {
    EXPECT_GT(share(before, c, adapted.found.classes, c), 0.96) << int{c};
  }
}

TEST_F(Adapting, FollowsThePaintWhereItContradicts) {
  // The edges along z are none, say six strokes; those along x and y were not painted.
  const auto& before = start_.answer.classes;
  auto labels = nothing();
  const std::vector<std::uint8_t> none(cloud_.size(), kNonEdge);
  for (const double z : {-0.6, 0.0, 0.6}) {
    paint({1, 1, z}, 0.25, none, labels);
    paint({-1, 1, z}, 0.25, none, labels);
  }
  const Adapted adapted = adapt("a", start_, subject(), labels, 1);
  // The painted balls hold flat surface too, which both know.
  const double wrong_before = 1 - share(labels, kNonEdge, before, kNonEdge);
  const double wrong = 1 - share(labels, kNonEdge, adapted.found.classes, kNonEdge);
  EXPECT_GT(wrong_before, 0.3);
  EXPECT_LT(wrong, wrong_before / 2);
}

TEST_F(Adapting, IsTheSameForAnyNumberingOfThePoints) {
  auto labels = nothing();
  paint({1, 1, 0}, 0.3, std::vector<std::uint8_t>(cloud_.size(), kSmoothEdge), labels);
  const Adapted one = adapt("a", start_, subject(), labels, 1);
  make(true);
  std::reverse(labels.begin(), labels.end());
  const Adapted other = adapt("a", start_, subject(), labels, 1);
  EXPECT_EQ(one.model.network.network.parameters, other.model.network.network.parameters);
  EXPECT_EQ(one.model.context->network.parameters, other.model.context->network.parameters);
}

TEST_F(Adapting, FindsWhatItsModelFinds) {
  auto labels = nothing();
  paint({1, 1, 0}, 0.3, std::vector<std::uint8_t>(cloud_.size(), kSmoothEdge), labels);
  const Adapted adapted = adapt("a", start_, subject(), labels, 1);
  const auto found = detect::classify(described_->cloud, cloud_.positions, adapted.model);
  EXPECT_EQ(adapted.found.classes, found.classes);
  EXPECT_EQ(adapted.found.p_sharp, found.p_sharp);
  EXPECT_EQ(adapted.found.p_smooth, found.p_smooth);
}

TEST_F(Adapting, StopsWhenAsked) {
  const Progress progress = {.report = {}, .cancelled = [] { return true; }};
  EXPECT_TRUE(adapt("a", start_, subject(), nothing(), 1, {}, &progress).cancelled);
}

TEST_F(Adapting, IsJudgedByWholeStrokesOnceThereAreEnough) {
  Labels labels(cloud_.size());
  const auto stroke = [&](const Vec3& centre, std::uint8_t edge_class) {
    std::vector<std::uint32_t> points;
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      const bool is_near = (cloud_.positions[i] - centre).norm() < 0.3;
      if (is_near && start_.answer.classes[i] == edge_class) {
        points.push_back(static_cast<std::uint32_t>(i));
      }
    }
    labels.paint(edge_class, points);
  };
  const auto judged = [&] { return hold_out(subject(), labels, {}, &start_); };
  stroke({1, 1, 0.5}, kSharpEdge);
  stroke({1, 1, -0.5}, kSharpEdge);
  EXPECT_FALSE(judged().accuracy) << "one class alone";
  stroke({1, 0, 0}, kNonEdge);
  EXPECT_FALSE(judged().accuracy) << "one stroke of a class";
  stroke({0, 1, 0}, kNonEdge);
  const HeldOut held_out = judged();
  EXPECT_EQ(held_out.strokes, 4u);
  EXPECT_EQ(held_out.start, 1.0);  // its own answers were painted
  ASSERT_TRUE(held_out.accuracy);
  EXPECT_GT(*held_out.accuracy, 0.95);
  labels.undo();
  EXPECT_FALSE(judged().accuracy) << "a stroke taken back does not count";
}

TEST(Labels, NameTheStrokeOfEachPoint) {
  Labels labels(4);
  labels.paint(kSharpEdge, {0, 1, 2});
  labels.paint(kNonEdge, {1});
  labels.paint(kUnlabelled, {2});
  EXPECT_EQ(labels.strokes(), (std::vector<std::uint32_t>{0, 1, kNoStroke, kNoStroke}));
  labels.undo();
  EXPECT_EQ(labels.strokes()[2], 0u);
}

/// The oracle keeps names: of the strokes in effect, and of those that may be redone.
TEST(Labels, CountTheStrokesSinceAnEarlierState) {
  Random random(3);
  Labels labels(10);
  std::vector<int> done, undone;
  std::vector<std::pair<Labels, std::set<int>>> states;
  for (int step = 0; step < 300; ++step) {
    states.emplace_back(labels, std::set<int>(done.begin(), done.end()));
    const double choice = random.uniform();
    if (choice < 0.4) {
      labels.paint(2, {static_cast<std::uint32_t>(step % 10)});
      done.push_back(step);
      undone.clear();
    } else {
      auto& from = choice < 0.75 ? done : undone;
      auto& to = choice < 0.75 ? undone : done;
      choice < 0.75 ? labels.undo() : labels.redo();
      if (!from.empty()) to.push_back(from.back()), from.pop_back();
    }
    const std::set<int> now(done.begin(), done.end());
    for (const auto& [then, its] : states) {
      std::vector<int> apart;
      std::set_symmetric_difference(its.begin(), its.end(), now.begin(), now.end(),
                                    std::back_inserter(apart));
      ASSERT_EQ(labels.steps_since(then), apart.size()) << step;
    }
  }
}

}  // namespace
}  // namespace pcednet::annotate
