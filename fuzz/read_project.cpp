#include <string_view>

#include "in_memory.h"
#include "workbench/annotate/page/json.h"
#include "workbench/annotate/project/project.h"

namespace {

constexpr std::size_t kMostPoints = 100'000;

void read_project(const std::filesystem::path& path) {
  const auto project = pcednet::annotate::read_project(path);
  const std::size_t points = pcednet::annotate::points_of(project.inputs);
  if (points > kMostPoints) return;  // a program compares them with the clouds first
  pcednet::annotate::replay(project.records, points);
}

}  // namespace

/// Project files, and the annotator's inputs from a browser and from its journal.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pcednet;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto try_to = [](const auto& read) {
    try {
      read();
    } catch (const Error&) {
    }
  };
  try_to([&] { annotate::parse_stroke(text); });
  try_to([&] { annotate::parse_decision(text); });
  try_to([&] { annotate::parse_lines_search(text); });
  try_to([&] { annotate::parse_save(text); });
  try_to([&] { annotate::parse_classes_change(text); });
  try_to([&] { annotate::parse_settings_change(text); });
  try_to([&] { annotate::parse_record(text, kMostPoints); });
  try_to([&] { annotate::parse_inputs(text); });
  return fuzz::read_or_refuse({data, size}, read_project);
}
