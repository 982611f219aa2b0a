// parallel.h on plain threads (PCEDNET_PLAIN_THREADS), for the static program (preset static), as
// TBB has no static library, and for ThreadSanitizer (preset threads): TBB of Debian is not
// instrumented, so that every block it hands over would count as a race.
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "pcednet/core/check_thread_count.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/run_with_threads.h"

namespace pcednet {
namespace {

std::atomic<int> wanted_threads = 0;
thread_local bool is_worker = false;
thread_local int own_threads = 0;  // of run_with_threads()

}  // namespace

void set_thread_count(int threads) {
  check_thread_count(threads);
  wanted_threads = threads;
}

int thread_count() {
  if (own_threads > 0) return own_threads;
  if (wanted_threads > 0) return wanted_threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void run_with_threads(int threads, const std::function<void()>& work) {
  struct Bound {
    int before;
    ~Bound() { own_threads = before; }
  } const bound{own_threads};
  if (threads > 0) own_threads = std::min(threads, thread_count());
  work();
}

void parallel_blocks(std::size_t count, std::size_t block,
                     const std::function<void(std::size_t, std::size_t)>& work) {
  const std::size_t blocks = (count + block - 1) / block;
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  std::exception_ptr error;
  std::mutex mutex;
  const auto take_blocks = [&] {
    for (std::size_t b = next++; b < blocks && !failed; b = next++) {
      try {
        work(b * block, std::min(count, (b + 1) * block));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failed.exchange(true)) error = std::current_exception();
      }
    }
  };
  if (is_worker || blocks <= 1) {
    take_blocks();  // nested in a block: runs on its thread
  } else {
    const auto work_here = [&] {
      is_worker = true;
      take_blocks();
      is_worker = false;
    };
    std::vector<std::jthread> others;  // joined at the end
    const std::size_t threads = std::min(static_cast<std::size_t>(thread_count()), blocks);
    while (others.size() + 1 < threads) others.emplace_back(work_here);
    work_here();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace pcednet
