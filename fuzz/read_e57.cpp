#include <cstring>
#include <vector>

#include "in_memory.h"
#include "pcednet/io/e57/e57.h"
#include "pcednet/io/e57/pages.h"

namespace {

/// Corrects the checksum of every page: otherwise hardly any input would pass them.
void repair_checksums(std::vector<std::uint8_t>& bytes) {
  using pcednet::io::kE57PageBytes, pcednet::io::kE57PageContent;
  for (std::size_t page = 0; page + kE57PageBytes <= bytes.size(); page += kE57PageBytes) {
    const auto content = std::span<const std::uint8_t>(bytes).subspan(page, kE57PageContent);
    const std::uint32_t sum = pcednet::io::crc32c(std::as_bytes(content));
    for (unsigned i = 0; i < 4; ++i) {
      bytes[page + kE57PageContent + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> bytes(data, data + size);
  repair_checksums(bytes);
  return pcednet::fuzz::read_or_refuse(bytes, [](const std::filesystem::path& path) {
    check_consistent(pcednet::io::read_e57(pcednet::io::InputFile(path)).cloud);
  });
}
