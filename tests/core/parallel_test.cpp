#include "pcednet/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <numeric>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "pcednet/core/random.h"
#include "pcednet/core/run_with_threads.h"
#include "support/expect_error.h"

namespace pcednet {
namespace {

class ParallelBlocks : public testing::Test {
 protected:
  void TearDown() override { set_thread_count(0); }
};

using Cuts = std::vector<std::pair<std::size_t, std::size_t>>;

Cuts cuts_of(std::size_t count, std::size_t block) {
  Cuts cuts;
  std::mutex mutex;
  parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
    const std::lock_guard lock(mutex);
    cuts.emplace_back(begin, end);
  });
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

TEST_F(ParallelBlocks, AreOfNoNegativeNumberOfThreads) {
  set_thread_count(1);
  EXPECT_ERROR(ErrorKind::kUsage, set_thread_count(-5));
  EXPECT_EQ(thread_count(), 1);
}

TEST_F(ParallelBlocks, AreCutTheSameWayForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    EXPECT_EQ(cuts_of(10, 4), (Cuts{{0, 4}, {4, 8}, {8, 10}}));
    EXPECT_EQ(cuts_of(8, 4), (Cuts{{0, 4}, {4, 8}}));
    EXPECT_EQ(cuts_of(3, 100), (Cuts{{0, 3}}));
    EXPECT_EQ(cuts_of(0, 5), Cuts{});
    const Cuts many = cuts_of(100'003, 7);
    ASSERT_EQ(many.size(), 14287u);
    for (std::size_t i = 0; i < many.size(); ++i) {
      ASSERT_EQ(many[i].first, 7 * i);
      ASSERT_EQ(many[i].second, std::min<std::size_t>(100'003, 7 * i + 7));
    }
  }
}

TEST_F(ParallelBlocks, GiveSumsTheSameBitsForAnyNumberOfThreads) {
  std::vector<double> values(20'000);
  Random random(2);
  for (double& value : values) value = random.normal() * 1e6 * random.uniform();
  const auto sum = [&] {
    std::vector<double> parts((values.size() + 63) / 64);
    parallel_blocks(values.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) parts[begin / 64] += values[i];
    });
    return std::accumulate(parts.begin(), parts.end(), 0.0);
  };
  set_thread_count(1);
  const double expected = sum();
  for (const int threads : {2, 8}) {
    set_thread_count(threads);
    EXPECT_EQ(sum(), expected) << threads;
  }
}

TEST_F(ParallelBlocks, HandOnWhatTheWorkThrows) {
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    std::atomic<int> running = 0;
    EXPECT_ERROR(ErrorKind::kInsufficient,
                 parallel_blocks(1000, 1, [&](std::size_t begin, std::size_t) {
                   ++running;
                   if (begin == 500) {
                     --running;
                     throw Error(ErrorKind::kInsufficient, "block 500");
                   }
                   --running;
                 }));
    EXPECT_EQ(running, 0) << "a block still ran";
  }
}

TEST_F(ParallelBlocks, StayOnOneThreadWhenToldTo) {
  set_thread_count(1);
  EXPECT_EQ(thread_count(), 1);
  std::set<std::thread::id> threads;  // needs no lock: that is the point
  parallel_blocks(1000, 1,
                  [&](std::size_t, std::size_t) { threads.insert(std::this_thread::get_id()); });
  EXPECT_EQ(threads, std::set<std::thread::id>{std::this_thread::get_id()});
  set_thread_count(3);
  EXPECT_EQ(thread_count(), 3);
  set_thread_count(0);
  EXPECT_EQ(thread_count(), static_cast<int>(std::thread::hardware_concurrency()));
}

TEST_F(ParallelBlocks, RunAtTheSameTime) {
  set_thread_count(2);
  std::mutex mutex;
  std::condition_variable arrived;
  int here = 0;
  std::atomic<int> met = 0;
  parallel_blocks(2, 1, [&](std::size_t, std::size_t) {
    std::unique_lock lock(mutex);
    ++here;
    arrived.notify_all();
    // Where there is one core alone, blocks may follow each other.
    const bool both = arrived.wait_for(lock, std::chrono::seconds(20), [&] { return here == 2; });
    met += both || std::thread::hardware_concurrency() == 1;
  });
  EXPECT_EQ(met, 2);
}

/// How many threads take the blocks of parallel_blocks() under a bound.
std::size_t threads_under(int bound) {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  run_with_threads(bound, [&] {
    parallel_blocks(2000, 1, [&](std::size_t, std::size_t) {
      const std::lock_guard lock(mutex);
      threads.insert(std::this_thread::get_id());
    });
  });
  return threads.size();
}

TEST_F(ParallelBlocks, KeepTheBoundOfTheirOwnCaller) {
  set_thread_count(4);
  std::vector<std::size_t> used(2);
  {
    std::jthread one([&] { used[0] = threads_under(1); });
    std::jthread two([&] { used[1] = threads_under(2); });
  }
  EXPECT_EQ(used[0], 1U);
  EXPECT_LE(used[1], 2U);
  EXPECT_GE(threads_under(0), 1U);
  set_thread_count(1);
  EXPECT_EQ(threads_under(2), 1U);  // at most as many as all work may use
  EXPECT_ERROR(ErrorKind::kUsage,
               run_with_threads(1, [] { throw Error(ErrorKind::kUsage, "as it came"); }));
}

}  // namespace
}  // namespace pcednet
