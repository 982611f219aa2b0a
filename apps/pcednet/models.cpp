#include "models.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "pcednet/core/error.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

/// Folders that may hold the shipped models, the likeliest first.
std::vector<fs::path> model_folders() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return {program.parent_path() / "../share/pcednet/models", PCEDNET_INSTALLED_MODELS,
          PCEDNET_SOURCE_MODELS};
}

}  // namespace

fs::path find_model(const std::string& name_or_file) {
  std::error_code error;
  if (fs::is_regular_file(name_or_file, error)) return name_or_file;
  std::vector<std::string> known;
  for (const fs::path& folder : model_folders()) {
    const fs::path model = folder / (name_or_file + ".safetensors");
    if (fs::is_regular_file(model, error)) return model;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".safetensors") known.push_back(entry.path().stem().string());
    }
  }
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  throw Error(ErrorKind::kUsage, fmt::format("{}: neither a file nor a shipped model ({})",
                                             name_or_file, fmt::join(known, ", ")));
}

}  // namespace pcednet::app
