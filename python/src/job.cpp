#include "job.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "pcednet/core/run_with_threads.h"

namespace pcednet::python {
namespace {

namespace py = pybind11;

/// The longest delay before a Ctrl-C is noticed.
constexpr std::chrono::milliseconds kPatience{50};

struct News {
  std::string stage;
  double fraction = 0.0;
};

/// The state shared by the working and the waiting thread.
struct Job {
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false;
  std::optional<News> news;  ///< the latest; replaces unfetched news
  std::exception_ptr error;
  std::atomic<bool> cancelled = false;
};

Progress progress_of(Job& job, bool wanted) {
  Progress progress{.report = {}, .cancelled = [&job] { return job.cancelled.load(); }};
  if (wanted) {
    progress.report = [&job](const std::string& stage, double fraction) {
      const std::lock_guard lock(job.mutex);
      job.news = News{stage, fraction};
      job.changed.notify_one();
    };
  }
  return progress;
}

/// Waits for news, the end, or for kPatience.
std::pair<bool, std::optional<News>> wait(Job& job) {
  std::unique_lock lock(job.mutex);
  job.changed.wait_for(lock, kPatience, [&] { return job.done || job.news; });
  return {job.done, std::exchange(job.news, std::nullopt)};
}

void watch(Job& job, const py::object& callback) {
  for (bool done = false; !done;) {
    std::optional<News> news;
    {
      const py::gil_scoped_release unlocked;
      std::tie(done, news) = wait(job);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (news) callback(news->stage, news->fraction);
  }
}

}  // namespace

void run_job(const JobOptions& options, const std::function<void(const Progress*)>& work) {
  Job job;
  const Progress progress = progress_of(job, !options.progress.is_none());
  std::jthread worker([&] {
    try {
      run_with_threads(options.threads, [&] { work(&progress); });
    } catch (...) {
      job.error = std::current_exception();
    }
    const std::lock_guard lock(job.mutex);
    job.done = true;
    job.changed.notify_one();
  });
  std::exception_ptr interruption;
  try {
    watch(job, options.progress);
  } catch (...) {
    interruption = std::current_exception();
    job.cancelled = true;
  }
  {
    const py::gil_scoped_release unlocked;
    worker.join();
  }
  if (interruption) std::rethrow_exception(interruption);
  if (job.error) std::rethrow_exception(job.error);
}

}  // namespace pcednet::python
