#pragma once

#include <functional>

namespace pcednet {

/// Runs `work` with at most `threads` threads in parallel_blocks(); 0: as many as
/// set_thread_count() allows. May be called from several threads at once, each with its own bound.
void run_with_threads(int threads, const std::function<void()>& work);

}  // namespace pcednet
