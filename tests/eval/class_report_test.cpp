#include "pcednet/eval/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/expect_error.h"

namespace pcednet::eval {
namespace {

TEST(ClassReport, ScoresEachClassAgainstTheOthers) {
  ClassReport report{.table = parse_classes("ground,wall,pipe")};
  const std::vector<std::uint8_t> truth = {0, 0, 0, 0, 1, 1, kUnlabelled, 7};
  const std::vector<std::uint8_t> found = {0, 0, 0, 1, 1, 2, 0, 0};
  add_cloud(truth, found, report);
  EXPECT_EQ(report.points, 6u);
  EXPECT_EQ(report.right, 4u);
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_DOUBLE_EQ(json["classes"][0]["recall"], 0.75);
  EXPECT_DOUBLE_EQ(json["classes"][0]["precision"], 1.0);
  EXPECT_DOUBLE_EQ(json["classes"][1]["iou"], 1.0 / 3);
  EXPECT_EQ(json["classes"][2]["points"], 0);
  // The mean is over the classes that the truth has.
  EXPECT_DOUBLE_EQ(json["mean"]["recall"], (0.75 + 0.5) / 2);
  EXPECT_DOUBLE_EQ(json["accuracy"], 4.0 / 6);

  add_cloud(truth, truth, report);
  EXPECT_EQ(report.clouds, 2u);
  EXPECT_EQ(report.right, 10u);
  const std::string table = to_table(report);
  EXPECT_NE(table.find("pipe"), std::string::npos);
  EXPECT_NE(table.find("accuracy 0.833, 2 clouds"), std::string::npos);
  EXPECT_ERROR(ErrorKind::kInsufficient, add_cloud(truth, {}, report));
}

}  // namespace
}  // namespace pcednet::eval
