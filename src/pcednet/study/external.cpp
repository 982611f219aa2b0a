#include "pcednet/study/external.h"

#include <fmt/format.h>

#include <filesystem>

#include "pcednet/core/error.h"
#include "pcednet/io/labels.h"

namespace pcednet::study {

std::vector<std::uint8_t> external_classes(const ExternalMethod& method, const std::string& set,
                                           const StudyCloud& cloud) {
  namespace fs = std::filesystem;
  constexpr std::string_view kSet = "{set}";
  std::string folder = method.folder;
  if (const std::size_t place = folder.find(kSet); place != std::string::npos) {
    folder.replace(place, kSet.size(), set);
  }
  for (const char* ending : {".u8", ".txt", ".csv", ".lbl", ".seg", ".ply", ".pcd", "_edges.ply"}) {
    const fs::path file = fs::path(folder) / (cloud.name + ending);
    std::error_code error;
    if (!fs::is_regular_file(file, error)) continue;
    auto classes = io::read_labels(file);
    if (classes.size() != cloud.cloud.size()) {
      throw Error(ErrorKind::kInsufficient,
                  fmt::format("{}: {} classes, but {} has {} points", file.string(), classes.size(),
                              cloud.name, cloud.cloud.size()));
    }
    return classes;
  }
  return {};
}

}  // namespace pcednet::study
