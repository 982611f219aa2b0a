#include "report_page.h"

// The page becomes part of the program byte for byte; CMake defines its path where it was built.
#ifdef PCEDNET_REPORT_PAGE
asm(".pushsection .rodata\n"
    "pcednet_report_page:\n"
    ".incbin \"" PCEDNET_REPORT_PAGE
    "\"\n"
    "pcednet_report_page_end:\n"
    ".popsection\n");
extern "C" const char pcednet_report_page[];
extern "C" const char pcednet_report_page_end[];
#endif

namespace pcednet::app {

std::string_view report_page() {
#ifdef PCEDNET_REPORT_PAGE
  return {pcednet_report_page,
          static_cast<std::size_t>(pcednet_report_page_end - pcednet_report_page)};
#else
  return {};
#endif
}

}  // namespace pcednet::app
