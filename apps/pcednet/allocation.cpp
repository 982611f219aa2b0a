#include <cstdlib>
#include <new>

#include "pcednet/core/large_pages.h"

// Large vectors get large pages, too: the library asks for them where it allocates itself.

void* operator new(std::size_t bytes) {
  void* memory = nullptr;
  while ((memory = std::malloc(bytes == 0 ? 1 : bytes)) == nullptr) {
    const std::new_handler make_room = std::get_new_handler();
    if (make_room == nullptr) throw std::bad_alloc();
    make_room();
  }
  pcednet::prefer_large_pages(memory, bytes);
  return memory;
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
