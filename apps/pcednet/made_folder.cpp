#include "made_folder.h"

#include "pcednet/core/output_file.h"

namespace pcednet::app {

namespace fs = std::filesystem;

MadeFolder::MadeFolder(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code ignored;
  fs::path missing = fs::absolute(folder).lexically_normal();
  if (!missing.has_filename()) missing = missing.parent_path();  // "out/"
  for (; !fs::exists(missing, ignored); missing = missing.parent_path()) made_.push_back(missing);
  make_folder(folder);
}

MadeFolder::~MadeFolder() {
  std::error_code ignored;
  for (const fs::path& folder : made_) fs::remove(folder, ignored);  // not if it holds something
}

}  // namespace pcednet::app
