#include "pcednet/formats/file_name.h"

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"

namespace pcednet::formats {

void check_is_utf8(const std::filesystem::path& path) {
  try {
    static_cast<void>(to_text(Json(path.string())));
  } catch (const Json::exception&) {
    throw Error(ErrorKind::kUsage,
                path.string() + ": the name is not in UTF-8, as a JSON file needs it; rename it");
  }
}

}  // namespace pcednet::formats
