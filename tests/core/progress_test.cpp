#include "pcednet/core/progress.h"

#include <algorithm>
#include <thread>
#include <vector>

#include "support/expect_error.h"

namespace pcednet {
namespace {

/// Keeps what is reported to it.
struct Reports {
  std::vector<std::string> stages;
  std::vector<double> fractions;
  Progress progress = {.report =
                           [this](const std::string& stage, double fraction) {
                             stages.push_back(stage);
                             fractions.push_back(fraction);
                           },
                       .cancelled = {}};
};

TEST(Progress, IsReportedFromNothingToOne) {
  Reports reports;
  Stage stage(&reports.progress, "describe", 4);
  EXPECT_EQ(reports.fractions, std::vector<double>{0.0}) << "a stage that begins says so";
  stage.advance();
  stage.advance(2);
  stage.advance();
  EXPECT_EQ(reports.fractions, (std::vector<double>{0.0, 0.25, 0.75, 1.0}));
  EXPECT_EQ(reports.stages, std::vector<std::string>(4, "describe"));
}

TEST(Progress, IsReportedAThousandTimesAtMost) {
  Reports reports;
  Stage stage(&reports.progress, "long", 1'000'000);
  for (int i = 0; i < 1'000'000; ++i) stage.advance();
  ASSERT_EQ(reports.fractions.size(), 1001u);
  for (std::size_t i = 0; i <= 1000; ++i) {
    ASSERT_NEAR(reports.fractions[i], static_cast<double>(i) / 1000, 1e-12);
  }
}

TEST(Progress, GrowsAndEndsAtOneWhenManyThreadsCount) {
  Reports reports;  // not locked: report is called by one thread at a time
  Stage stage(&reports.progress, "parallel", 8 * 5000);
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 5000; ++i) stage.advance();
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_TRUE(std::is_sorted(reports.fractions.begin(), reports.fractions.end()));
  EXPECT_EQ(reports.fractions.back(), 1.0);
  EXPECT_LE(reports.fractions.size(), 1001u);
}

TEST(Progress, OfNoWorkAndForNobodyIsFine) {
  Stage unheard(nullptr, "a", 10);
  EXPECT_NO_THROW(unheard.advance(10));
  const Progress silent;
  Stage quiet(&silent, "b", 10);
  EXPECT_NO_THROW(quiet.advance(10));
  Reports reports;
  Stage empty(&reports.progress, "c", 0);
  empty.advance(0);
  EXPECT_EQ(reports.fractions, std::vector<double>{0.0});
}

TEST(Progress, StopsTheWorkOnceTheCallerWantsToStop) {
  bool stop = false;
  Reports reports;
  reports.progress.cancelled = [&] { return stop; };
  Stage stage(&reports.progress, "a", 3);
  EXPECT_NO_THROW(stage.advance());
  EXPECT_NO_THROW(throw_if_cancelled(&reports.progress));
  stop = true;
  EXPECT_ERROR(ErrorKind::kCancelled, stage.advance());
  EXPECT_ERROR(ErrorKind::kCancelled, throw_if_cancelled(&reports.progress));
  EXPECT_EQ(reports.fractions.size(), 2u) << "what was stopped is not counted";
  EXPECT_NO_THROW(throw_if_cancelled(nullptr));
}

TEST(Progress, OfAPartIsSilentAndStillStops) {
  Reports reports;
  reports.progress.cancelled = [] { return true; };
  const Progress part = without_report(&reports.progress);
  EXPECT_FALSE(part.report);
  EXPECT_ERROR(ErrorKind::kCancelled, throw_if_cancelled(&part));
  EXPECT_FALSE(without_report(nullptr).cancelled);
}

}  // namespace
}  // namespace pcednet
