#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "pcednet/core/progress.h"

namespace pcednet::python {

/// Python's options for long work.
struct JobOptions {
  pybind11::object progress;  ///< None, or called with a stage and the fraction of it that is done
  int threads = 0;            ///< 0: every core
};

/// Does `work` on a separate thread while this one, without Python's lock, waits. Only this thread
/// calls back: a signal (Ctrl-C) or an exception of the callback cancels the work and is thrown
/// when the work has ended. Otherwise throws what the work throws. `work` must not touch Python.
void run_job(const JobOptions& options, const std::function<void(const Progress* progress)>& work);

}  // namespace pcednet::python
