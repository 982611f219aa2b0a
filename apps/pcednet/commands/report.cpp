#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "commands.h"
#include "pcednet/core/error.h"
#include "web_pages.h"
#include "workbench/report/merge.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
  std::string folder, output = "report.html", json;
  report::MergeOptions merge = {};
};

report::MergedStudies merge(const ReportArguments& arguments, const Progress& progress) {
  try {
    return report::merge_studies(arguments.folder, arguments.merge, &progress);
  } catch (const report::MissingCloud& error) {
    throw Error(error.kind(), fmt::format("{}; --clouds-per-set 0 needs no clouds", error.what()));
  }
}

void make_report(const ReportArguments& arguments, const Common& common) {
  const std::string_view page = report_page();
  if (page.empty()) {
    throw Error(ErrorKind::kFailure,
                "report: this pcednet was built without the page; run scripts/build_web.sh and "
                "build again");
  }
  if (arguments.merge.lines && arguments.merge.clouds_per_set == 0) {
    throw Error(ErrorKind::kUsage,
                "--lines draws over clouds, of which --clouds-per-set 0 shows none");
  }
  check_writable(arguments.output, common.overwrite());
  check_writable(arguments.json, common.overwrite());
  check_distinct({arguments.output, arguments.json});
  const Progress progress = console_progress(common);
  const auto merged = merge(arguments, progress);
  for (const fs::path& file : merged.files) {
    check_not_input(arguments.output, file);
    check_not_input(arguments.json, file);
  }
  for (const std::string& warning : merged.warnings) warn(warning);
  const std::string filled = report::fill_page(page, merged.json);
  write_text_file(arguments.output, filled, common.overwrite());
  if (!arguments.json.empty()) {
    write_text_file(arguments.json, merged.json + "\n", common.overwrite());
  }
  say(fmt::format("{}: {} {}, {} {} to look at, {:.1f} MB", arguments.output, merged.studies,
                  merged.studies == 1 ? "study" : "studies", merged.scenes,
                  merged.scenes == 1 ? "cloud" : "clouds",
                  static_cast<double>(filled.size()) / 1e6));
}

}  // namespace

void add_report(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command =
      add_command(app, common, "report", "Make one web page of the studies in a folder",
                  "pcednet report study/ -o report.html\n"
                  "pcednet report study/ --clouds-per-set 9 --points 100000 --overwrite\n"
                  "pcednet report study/ --lines\n"
                  "pcednet report study/ --title 'Facades of the old town' --date 'May 2027'");
  command->add_option("folder", arguments->folder, "Folder written by `pcednet study`")->required();
  command->add_option("-o,--output", arguments->output, "Output page; it needs no other file")
      ->capture_default_str();
  command
      ->add_option("--clouds-per-set", arguments->merge.clouds_per_set,
                   "Clouds of each set to show in 3D (0: none)")
      ->capture_default_str()
      ->check(CLI::Range(0, 10000));
  command
      ->add_option("--points", arguments->merge.points_per_cloud,
                   "Points to show per cloud; larger clouds are sampled")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000000));
  command->add_flag("--lines", arguments->merge.lines,
                    "Draw edges as lines, too: found in the labels and in every prediction as "
                    "`pcednet lines` finds them");
  command->add_option("--title", arguments->merge.title,
                      "Title of the page (default: that of the only study, or a general one)");
  command->add_option("--date", arguments->merge.date, "Date of the page, in your own words");
  command->add_option("--json", arguments->json, "Also write the data of the page to this file");
  command->callback([arguments, &common] { make_report(*arguments, common); });
}

}  // namespace pcednet::app
