#pragma once

#include <functional>

namespace pcednet {

/// Runs `work` with at most so many threads in parallel_blocks(); 0: as many as set_thread_count()
/// allows. May be called from several threads at once, each with a bound of its own.
void run_with_threads(int threads, const std::function<void()>& work);

}  // namespace pcednet
