#include "workbench/annotate/project/classes.h"

#include <gtest/gtest.h>

#include "pcednet/core/random.h"
#include "pcednet/nn/predict.h"
#include "support/expect_error.h"
#include "workbench/annotate/learn/learn.h"
#include "workbench/annotate/project/project.h"

namespace pcednet::annotate {
namespace {

constexpr std::array<std::size_t, kMostClasses> kNothing = {};

TEST(ProjectClasses, AreAnyUntilTheFirstStroke) {
  const ProjectClasses own{.table = parse_classes("ground,wall,pipe")};
  EXPECT_NO_THROW(check_change({}, own, kNothing, {}));
  EXPECT_NO_THROW(check_change(own, {}, kNothing, {}));
  EXPECT_TRUE(own.may_paint(2));
  EXPECT_FALSE(own.may_paint(3));
  EXPECT_FALSE(ProjectClasses().may_paint(kBoundary));
  const ProjectClasses more{.table = parse_classes("edges,pipe")};
  EXPECT_FALSE(more.may_paint(kBoundary));
  EXPECT_TRUE(more.may_paint(4));
}

TEST(ProjectClasses, ThenAreAddedToRenamedAndRemovedWhereNothingIsPainted) {
  const ProjectClasses now{.table = parse_classes("ground,wall,pipe")};
  auto counts = kNothing;
  counts[1] = 5;
  const std::set<std::uint8_t> ever = {1, 2};
  const auto change = [&](const char* table, const std::set<std::uint8_t>& removed = {}) {
    check_change(now, {.table = parse_classes(table), .removed = removed}, counts, ever);
  };
  EXPECT_NO_THROW(change("soil,wall,pipe=#010203"));
  EXPECT_NO_THROW(change("ground,wall,pipe,tree"));
  EXPECT_NO_THROW(change("ground,wall,pipe", {0, 2}));
  EXPECT_ERROR(ErrorKind::kUsage, change("ground,wall,pipe", {1}));  // painted
  EXPECT_ERROR(ErrorKind::kUsage, change("ground,wall,pipe", {3}));  // no such class
  EXPECT_ERROR(ErrorKind::kUsage, change("ground,wall"));
  EXPECT_ERROR(ErrorKind::kUsage, change("edges"));

  // Undo may bring back what was painted as a class that was removed.
  const ProjectClasses removed{.table = now.table, .removed = {0, 2}};
  const auto come_back = [&](const char* table) {
    check_change(removed, {.table = parse_classes(table)}, counts, ever);
  };
  EXPECT_NO_THROW(come_back("tree,wall,pipe"));
  EXPECT_ERROR(ErrorKind::kUsage, come_back("ground,wall,tree"));
}

TEST(ProjectClasses, HaveNamesThatDifferByMoreThanCaseAndHyphens) {
  const auto change = [](const char* table, const std::set<std::uint8_t>& removed = {}) {
    check_change({}, {.table = parse_classes(table), .removed = removed}, kNothing, {});
  };
  EXPECT_ERROR(ErrorKind::kUsage, change("edges,Sharp edge"));
  EXPECT_ERROR(ErrorKind::kUsage, change("pipe,tall_wall,tall wall"));
  EXPECT_NO_THROW(change("pipe,Pipe", {0}));
  EXPECT_NO_THROW(change("ground,pipe,pipe 2"));
}

TEST(ProjectClasses, AskedForByNameAddToThoseThatAreThere) {
  const ProjectClasses now{.table = parse_classes("ground=#000001,wall"), .removed = {1}};
  const ProjectClasses more = wanted_classes(now, parse_classes("ground,wall,pipe"));
  EXPECT_EQ(more.table[0], now.table[0]);
  EXPECT_EQ(more.table.size(), 3u);
  EXPECT_EQ(more.removed, now.removed);
  EXPECT_EQ(wanted_classes(now, parse_classes("ground,wall")), now);
  EXPECT_EQ(wanted_classes(now, parse_classes("a,b")).table, parse_classes("a,b"));
}

TEST(ProjectClasses, AreARecordOfTheirOwn) {
  const Record record{.kind = Record::Kind::kClasses,
                      .classes = {.table = parse_classes("a,b,c"), .removed = {1}}};
  const Record again = parse_record(to_line(record), 10);
  EXPECT_EQ(again.kind, record.kind);
  EXPECT_EQ(again.classes, record.classes);
  const Record stroke{.id = "s", .edge_class = 2, .points = {3, 4}};
  const Replayed end = replay(std::vector{record, stroke}, 10);
  EXPECT_EQ(end.labels.counts()[2], 2u);
  EXPECT_EQ(end.ever_painted, (std::set<std::uint8_t>{2}));
  const Record of_removed{.id = "t", .edge_class = 1, .points = {3}};
  EXPECT_ERROR(ErrorKind::kUnreadable, replay(std::vector{record, of_removed}, 10));
  const Record of_boundary{.id = "u", .edge_class = kBoundary, .points = {3}};
  EXPECT_ERROR(ErrorKind::kUnreadable, replay(std::vector{of_boundary}, 10));
  EXPECT_ERROR(ErrorKind::kUnreadable, parse_record(R"({"table":[{"name":"a"}]})", 10));
  EXPECT_ERROR(ErrorKind::kUnreadable,
               parse_record(R"({"table":[{"name":"a","colour":"#000000"}]})", 10));
}

TEST(Outputs, ThatAreNewLeaveTheOthersTheirProbabilities) {
  auto scan = detect::load_model(PCEDNET_SOURCE_DIR "/models/scan.safetensors");
  const ClassTable table = parse_classes("edges,pipe,tree");
  ASSERT_TRUE(can_start(scan, table));
  EXPECT_FALSE(can_start(scan, parse_classes("ground,wall,pipe,a,b")));
  EXPECT_ERROR(ErrorKind::kUsage, check_start(scan, "scan", parse_classes("ground,wall")));
  const auto more = with_outputs(scan, table, std::vector<std::uint8_t>{0, 5, kUnlabelled, 5});
  EXPECT_EQ(more.classes, (std::vector<std::uint8_t>{0, 1, 2, 5}));
  EXPECT_EQ(more.network.class_names.back(), "tree");
  Random random(1);
  std::vector<float> samples(50 * 96);
  for (float& x : samples) x = static_cast<float>(random.uniform(-1, 1));
  const auto before = nn::predict(scan.network, samples);
  const auto after = nn::predict(more.network, samples);
  for (std::size_t i = 0; i < 50; ++i) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(after[4 * i + c], before[3 * i + c], 0.02);
    EXPECT_GT(after[4 * i + 3], 0.0f);
  }
}

/// A cylinder on a plane, far from it: pipe and ground.
class OwnClasses : public testing::Test {
 protected:
  void SetUp() override {
    Random random(3);
    for (int i = 0; i < 6000; ++i) {
      if (i % 2 == 0) {
        const double y = random.uniform(-1, 1), x = random.uniform(-1, 1);
        cloud_.positions.emplace_back(x, y, 0);
        cloud_.normals.emplace_back(0, 0, 1);
      } else {
        const double a = random.uniform(0, 6.2831853);
        const Vec3 normal(0, std::cos(a), std::sin(a));
        cloud_.positions.push_back(Vec3(random.uniform(-1, 1), 0, 1) + 0.2 * normal);
        cloud_.normals.push_back(normal);
      }
    }
    prepared_ = detect::prepare(cloud_);
  }

  Subject subject(const ClassTable& table, const gls::ScaleSpaceOptions& descriptor) {
    described_ = describe_once(prepared_, descriptor, {});
    return {.clouds = {{*described_, cloud_.positions, prepared_.curve}}, .table = table};
  }

  /// Some points of each kind.
  std::vector<std::uint8_t> labels(std::uint8_t ground, std::uint8_t pipe) const {
    std::vector<std::uint8_t> painted(cloud_.size(), kUnlabelled);
    for (std::size_t i = 0; i < 600; ++i) painted[i] = i % 2 == 0 ? ground : pipe;
    return painted;
  }

  double right(const std::vector<std::uint8_t>& found, std::uint8_t ground,
               std::uint8_t pipe) const {
    double same = 0;
    for (std::size_t i = 0; i < found.size(); ++i) same += found[i] == (i % 2 == 0 ? ground : pipe);
    return same / static_cast<double>(found.size());
  }

  PointCloud cloud_ = {};
  detect::PreparedCloud prepared_ = {};
  std::shared_ptr<const Described> described_ = {};
};

TEST_F(OwnClasses, AreLearntFromNothing) {
  const Subject its = subject(parse_classes("ground,wall,pipe"), {});
  const Adapted learnt = learn("own", its, labels(0, 2), {}, nullptr);
  EXPECT_EQ(learnt.model.classes, (std::vector<std::uint8_t>{0, 2}));
  EXPECT_EQ(learnt.model.table, its.table);
  EXPECT_GT(right(learnt.found.classes, 0, 2), 0.95);
  EXPECT_ERROR(ErrorKind::kInsufficient, check_can_learn(labels(1, 1), {}, its.table));

  // Its model is a start that learns another class.
  const Start start = make_start(learnt.model, its);
  auto more = labels(kUnlabelled, kUnlabelled);
  for (std::size_t i = 1; i < 600; i += 2) more[i] = 1;
  const Adapted adapted = learn("own", its, more, {.start = "own"}, &start);
  EXPECT_EQ(adapted.model.classes, (std::vector<std::uint8_t>{0, 1, 2}));
  EXPECT_GT(right(adapted.found.classes, 0, 1), 0.9);
}

TEST_F(OwnClasses, AreLearntBesideThoseOfEdges) {
  const auto scan = detect::load_model(PCEDNET_SOURCE_DIR "/models/scan.safetensors");
  const Subject its = subject(parse_classes("edges,pipe"), scan.descriptor);
  const Start start = make_start(scan, its);
  const Adapted adapted = learn("own", its, labels(kUnlabelled, 4), {.start = "scan"}, &start);
  EXPECT_EQ(adapted.model.classes, (std::vector<std::uint8_t>{0, 1, 2, 4}));
  ASSERT_TRUE(adapted.model.context.has_value());
  EXPECT_GT(right(adapted.found.classes, kNonEdge, 4), 0.9);
}

}  // namespace
}  // namespace pcednet::annotate
