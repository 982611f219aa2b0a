#pragma once

#include <string>

#include "pcednet/core/error.h"

namespace pcednet {

/// Throws Error(kUsage) for a negative number of threads.
inline void check_thread_count(int threads) {
  if (threads >= 0) return;
  throw Error(ErrorKind::kUsage,
              std::to_string(threads) + " threads: give 0, for every core, or more");
}

}  // namespace pcednet
