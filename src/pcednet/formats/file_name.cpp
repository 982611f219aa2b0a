#include "pcednet/formats/file_name.h"

#include <nlohmann/json.hpp>

#include "pcednet/core/error.h"

namespace pcednet::formats {

void check_is_utf8(const std::filesystem::path& path) {
  try {
    static_cast<void>(nlohmann::json(path.string()).dump());
  } catch (const nlohmann::json::exception&) {
    throw Error(ErrorKind::kUsage,
                path.string() + ": the name is not in UTF-8, as a JSON file needs it; rename it");
  }
}

}  // namespace pcednet::formats
