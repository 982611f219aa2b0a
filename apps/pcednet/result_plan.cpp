#include "result_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "pcednet/core/error.h"
#include "pcednet/formats/format.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

fs::path preview_path(const ResultArguments& arguments, const fs::path& input, bool several) {
  if (arguments.preview.path.empty()) return {};
  if (!several) return arguments.preview.path;
  const fs::path pattern = arguments.preview.path;
  return pattern.parent_path() / fmt::format("{}_{}{}", pattern.stem().string(),
                                             formats::stem_of(input), pattern.extension().string());
}

/// The default file for a result: LAS for LAS, LAZ for LAZ, PLY for everything else.
std::string output_name(const fs::path& input) {
  const std::string extension = io::extension_of(input);
  const bool is_las = extension == ".las" || extension == ".laz";
  return formats::stem_of(input) + "_edges" + (is_las ? extension : ".ply");
}

std::vector<Job> jobs_for(const std::vector<fs::path>& inputs, const ResultArguments& arguments) {
  std::vector<Job> jobs;
  for (const fs::path& input : inputs) {
    const fs::path folder =
        arguments.folder.empty() ? input.parent_path() : fs::path(arguments.folder);
    const fs::path output =
        arguments.output.empty() ? folder / output_name(input) : fs::path(arguments.output);
    jobs.push_back({input, output, preview_path(arguments, input, inputs.size() > 1)});
  }
  return jobs;
}

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return !file.empty() && fs::exists(fs::symlink_status(file, ignored));
}

/// Throws if one of several results exists, naming it.
void refuse_existing(const std::vector<Job>& jobs) {
  std::size_t existing = 0;
  for (const Job& job : jobs) {
    for (const fs::path& file : {job.output, job.preview}) {
      if (!is_there(file)) continue;
      say_error(file.string() + ": exists already");
      ++existing;
    }
  }
  if (existing == 0) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("{} of the results exist already; nothing was done. Give --skip-existing "
                          "to keep them or --overwrite to replace them",
                          existing));
}

/// Throws before any work if the outputs could not be written after it.
void check_outputs(const std::vector<Job>& jobs, const Common& common) {
  for (const Job& job : jobs) formats::format_for(job.output);
  if (jobs.size() > 1 && !common.overwrite_files) refuse_existing(jobs);
  std::map<fs::path, fs::path> inputs;  // of each output
  for (const Job& job : jobs) {
    check_not_input(job.preview, job.input);
    for (const fs::path& file : {job.output, job.preview}) {
      check_writable(file, common.overwrite());
      const auto [first, is_new] = inputs.emplace(file.lexically_normal(), job.input);
      if (file.empty() || is_new) continue;
      throw Error(ErrorKind::kUsage,
                  fmt::format("{}: the results of {} and {} would both be written here",
                              file.string(), first->second.string(), job.input.string()));
    }
  }
}

/// Leaves out inputs that are the results of others: those of an earlier run on the same folder,
/// whose results were to be where they are to be now, or beside the inputs.
void drop_results(std::vector<Job>& jobs) {
  std::set<fs::path> results;
  for (const Job& job : jobs) {
    results.insert(job.output.lexically_normal());
    const fs::path beside = job.input.parent_path() / output_name(job.input);
    results.insert(beside.lexically_normal());
    // Earlier versions wrote LAS for LAZ.
    results.insert(fs::path(beside).replace_extension(".las").lexically_normal());
  }
  const std::size_t dropped = std::erase_if(jobs, [&](const Job& job) {
    return jobs.size() > 1 && results.contains(job.input.lexically_normal());
  });
  if (dropped == 1) say("1 file left out: it is the result of another input");
  if (dropped > 1) say(fmt::format("{} files left out: they are results of other inputs", dropped));
}

}  // namespace

std::vector<fs::path> without_results(const std::vector<fs::path>& inputs) {
  std::vector<Job> jobs = jobs_for(inputs, {});
  drop_results(jobs);
  std::vector<fs::path> rest;
  for (Job& job : jobs) rest.push_back(std::move(job.input));
  return rest;
}

void warn_of_replaced(const std::string& input, const std::vector<std::string>& attributes) {
  if (attributes.empty()) return;
  warn(fmt::format("{}: its own {} {} replaced by the result's: rename what is to be kept", input,
                   fmt::join(attributes, ", "), attributes.size() == 1 ? "is" : "are"));
}

ResultPlan plan_results(const Inputs& inputs, const ResultArguments& arguments,
                        const Common& common) {
  if (!arguments.output.empty() && (inputs.count() > 1 || !arguments.folder.empty())) {
    throw Error(ErrorKind::kUsage, "classify: -o is for one input; use --out-dir for several");
  }
  ResultPlan plan{.jobs = jobs_for(inputs.files, arguments)};
  drop_results(plan.jobs);
  if (arguments.skip_existing) {
    plan.skipped = std::erase_if(plan.jobs, [](const Job& job) { return is_there(job.output); });
  }
  check_outputs(plan.jobs, common);
  return plan;
}

}  // namespace pcednet::app
