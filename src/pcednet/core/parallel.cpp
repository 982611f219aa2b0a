#include "pcednet/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>

#include "pcednet/core/check_thread_count.h"
#include "pcednet/core/run_with_threads.h"

namespace pcednet {
namespace {

std::unique_ptr<tbb::global_control> thread_limit;  // NOLINT: set once by set_thread_count

}  // namespace

void set_thread_count(int threads) {
  check_thread_count(threads);
  const int wanted = threads > 0 ? threads : tbb::info::default_concurrency();
  thread_limit.reset();
  thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                       static_cast<std::size_t>(wanted));
}

int thread_count() {
  return static_cast<int>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void run_with_threads(int threads, const std::function<void()>& work) {
  if (threads <= 0) return work();
  tbb::task_arena(std::min(threads, thread_count())).execute(work);
}

void parallel_blocks(std::size_t count, std::size_t block,
                     const std::function<void(std::size_t, std::size_t)>& work) {
  const std::size_t blocks = (count + block - 1) / block;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, blocks, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t b = range.begin(); b != range.end(); ++b) {
          work(b * block, std::min(count, (b + 1) * block));
        }
      },
      tbb::simple_partitioner());
}

}  // namespace pcednet
