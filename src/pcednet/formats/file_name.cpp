#include "pcednet/formats/file_name.h"

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"

namespace pcednet::formats {
namespace {

namespace fs = std::filesystem;

/// U+FFFD, which stands for bytes that were replaced.
constexpr const char* kReplaced = "\xEF\xBF\xBD";

bool is_replaced(const fs::path& name) {
  return name.string().find(kReplaced) != std::string::npos;
}

/// The name in `folder` that is written as `name`; empty if there is none.
fs::path name_in(const fs::path& folder, const fs::path& name) {
  std::error_code error;
  fs::path found;
  for (fs::directory_iterator it(folder.empty() ? "." : folder, error), end; !error && it != end;
       it.increment(error)) {
    const fs::path its = it->path().filename();
    if (as_utf8(its.string()) == name.string() && (found.empty() || its < found)) found = its;
  }
  return found;
}

}  // namespace

fs::path find_written(const fs::path& written) {
  std::error_code error;
  if (!is_replaced(written) || fs::exists(written, error)) return written;
  fs::path found;
  for (const fs::path& name : written) {
    const bool is_there = !is_replaced(name) || fs::exists(found / name, error);
    const fs::path its = is_there ? name : name_in(found, name);
    if (its.empty() && !name.empty()) return written;
    found /= its;
  }
  return found;
}

void check_is_utf8(const std::filesystem::path& path) {
  try {
    static_cast<void>(to_text(Json(path.string())));
  } catch (const Json::exception&) {
    throw Error(ErrorKind::kUsage,
                path.string() + ": the name is not in UTF-8, as a JSON file needs it; rename it");
  }
}

}  // namespace pcednet::formats
