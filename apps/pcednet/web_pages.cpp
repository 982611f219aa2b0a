#include "web_pages.h"

// The pages become parts of the program byte for byte: .incbin takes the files whose paths CMake
// defines, which are empty where a page was not built.
#define PCEDNET_EMBED(name, path)                                                               \
  asm(".pushsection .rodata\n" #name ":\n.incbin \"" path "\"\n" #name "_end:\n.popsection\n"); \
  extern "C" const char name[], name##_end[];

PCEDNET_EMBED(pcednet_report_page, PCEDNET_REPORT_PAGE)
PCEDNET_EMBED(pcednet_annotate_page, PCEDNET_ANNOTATE_PAGE)

namespace pcednet::app {
namespace {

std::string_view between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::string_view report_page() {
  return between(pcednet_report_page, pcednet_report_page_end);
}

std::string_view annotate_page() {
  return between(pcednet_annotate_page, pcednet_annotate_page_end);
}

}  // namespace pcednet::app
