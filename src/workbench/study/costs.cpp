#include "workbench/study/costs.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>

#include "pcednet/core/parallel.h"

namespace pcednet::study {
namespace {

/// Joules that the packages' counters show; empty if there is none to read. Joules lost when a
/// counter starts over (after 2^18 J or so) show as a negative lap, which counts as zero.
std::optional<double> counted_joules() {
  namespace fs = std::filesystem;
  std::error_code error;
  std::optional<double> sum;
  for (const auto& entry : fs::directory_iterator("/sys/class/powercap", error)) {
    const std::string name = entry.path().filename().string();
    // "intel-rapl:0" is a package, "intel-rapl:0:1" a part of it; AMD's are called so too.
    if (!name.starts_with("intel-rapl:") || std::count(name.begin(), name.end(), ':') != 1) {
      continue;
    }
    double microjoules = 0;
    if (std::ifstream(entry.path() / "energy_uj") >> microjoules) {
      sum = sum.value_or(0.0) + 1e-6 * microjoules;
    }
  }
  return sum;
}

double processor_seconds() {
  timespec time = {};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

Costs& Costs::operator+=(const Costs& other) {
  normals += other.normals;
  describe += other.describe;
  describe_training += other.describe_training;
  train += other.train;
  classify += other.classify;
  return *this;
}

EnergyMeter::EnergyMeter(double watts_per_core)
    : watts_per_core_(watts_per_core),
      has_counters_(counted_joules().has_value()),
      joules_(joules_now()) {}

double EnergyMeter::joules_now() const {
  if (has_counters_) return counted_joules().value_or(joules_);
  return watts_per_core_ * processor_seconds();
}

Cost EnergyMeter::lap() {
  const double now = joules_now();
  const Cost cost{watch_.lap(), std::max(0.0, now - joules_)};
  joules_ = now;
  return cost;
}

std::string machine_name() {
  std::ifstream file("/proc/cpuinfo");
  std::string name = "unknown processor";
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) {
      name = line.substr(std::min(line.size(), line.find(':') + 2));
      break;
    }
  }
  return fmt::format("{}, {} threads", name, thread_count());
}

}  // namespace pcednet::study
