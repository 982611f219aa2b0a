#pragma once

#include <cstddef>
#include <functional>

namespace pcednet {

/// Bounds the threads of all later parallel work; 0 means every core. Not thread-safe: call it
/// once, before the work. Throws Error(kUsage) for a negative number.
void set_thread_count(int threads);

/// The threads that parallel work may use.
int thread_count();

/// Cuts [0, count) into blocks of `block` indices (the last may be shorter) and calls
/// `work(begin, end)` for each, on all threads.
///
/// The cut depends on `count` and `block` alone, so a sum kept per block and added up in block
/// order has the same bytes for any number of threads. The first exception thrown by `work` reaches
/// the caller after the running blocks have ended. `block` must be positive.
void parallel_blocks(std::size_t count, std::size_t block,
                     const std::function<void(std::size_t begin, std::size_t end)>& work);

}  // namespace pcednet
