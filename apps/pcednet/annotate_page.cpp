#include "annotate_page.h"

// The page becomes part of the program byte for byte; CMake defines its path where it was built.
#ifdef PCEDNET_ANNOTATE_PAGE
asm(".pushsection .rodata\n"
    "pcednet_annotate_page:\n"
    ".incbin \"" PCEDNET_ANNOTATE_PAGE
    "\"\n"
    "pcednet_annotate_page_end:\n"
    ".popsection\n");
extern "C" const char pcednet_annotate_page[];
extern "C" const char pcednet_annotate_page_end[];
#endif

namespace pcednet::app {

std::string_view annotate_page() {
#ifdef PCEDNET_ANNOTATE_PAGE
  return {pcednet_annotate_page,
          static_cast<std::size_t>(pcednet_annotate_page_end - pcednet_annotate_page)};
#else
  return {};
#endif
}

}  // namespace pcednet::app
