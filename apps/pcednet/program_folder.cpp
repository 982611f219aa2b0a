#include "program_folder.h"

#include <sys/auxv.h>

#include <cstdlib>

namespace pcednet::app {

namespace fs = std::filesystem;

fs::path program_folder() {
  std::error_code error;
  fs::path program = fs::read_symlink("/proc/self/exe", error);
  // Without /proc, as in a bare chroot, the kernel's record of the program.
  if (error) program = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
  return program.parent_path();
}

void use_own_proj_database() {
  const fs::path folder = program_folder() / "../share/pcednet/proj";
  std::error_code error;
  if (fs::exists(folder / "proj.db", error)) setenv("PROJ_DATA", folder.c_str(), 1);
}

}  // namespace pcednet::app
