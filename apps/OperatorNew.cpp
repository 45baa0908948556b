// SPDX-License-Identifier: BSD-3-Clause
// operator new as C++ has it, by mimalloc's malloc. The library's own, compiled as C, cannot throw: it aborts the
// program without a word when memory runs out.
#include <cstddef>
#include <cstdlib>
#include <new>

void* operator new(std::size_t bytes) {
  if (void* block = std::malloc(bytes)) return block;
  throw std::bad_alloc();
}

void* operator new[](std::size_t bytes) { return operator new(bytes); }

void* operator new(std::size_t bytes, std::align_val_t alignment) {
  void* block = nullptr;
  if (posix_memalign(&block, static_cast<std::size_t>(alignment), bytes) == 0) return block;
  throw std::bad_alloc();
}

void* operator new[](std::size_t bytes, std::align_val_t alignment) { return operator new(bytes, alignment); }
