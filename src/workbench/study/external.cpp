#include "workbench/study/external.h"

#include <fmt/format.h>

namespace pcednet::study {

eval::Predictions external_classes(const ExternalMethod& method, const std::string& set,
                                   const StudyCloud& cloud) {
  constexpr std::string_view kSet = "{set}";
  std::string folder = method.folder;
  if (const std::size_t place = folder.find(kSet); place != std::string::npos) {
    folder.replace(place, kSet.size(), set);
  }
  const std::filesystem::path file = eval::find_predictions(folder, cloud.name, cloud.file);
  if (file.empty()) return {};
  auto predictions = eval::read_predictions(file, cloud.cloud.positions);
  if (!predictions.note.empty()) {
    predictions.note = fmt::format("{}: {}", file.string(), predictions.note);
  }
  return predictions;
}

}  // namespace pcednet::study
