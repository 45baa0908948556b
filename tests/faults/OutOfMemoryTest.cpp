// SPDX-License-Identifier: BSD-3-Clause
// Memory that runs out is an exception in programs, whichever operator new asked for it (apps/OperatorNew.cpp): they
// end with a line.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <new>

namespace lintel::test {
namespace {

// volatile: the compiler refuses what it can see to be too much
volatile std::size_t too_much = std::numeric_limits<std::ptrdiff_t>::max() - 4096;

TEST(OutOfMemory, IsAnException) {
  constexpr std::align_val_t kAligned{64};
  EXPECT_THROW(::operator delete(::operator new(too_much)), std::bad_alloc);
  EXPECT_THROW(::operator delete[](::operator new[](too_much)), std::bad_alloc);
  EXPECT_THROW(::operator delete(::operator new(too_much, kAligned), kAligned), std::bad_alloc);
  EXPECT_THROW(::operator delete[](::operator new[](too_much, kAligned), kAligned), std::bad_alloc);
}

TEST(OutOfMemory, WhatIsThereIsAligned) {
  for (const std::size_t alignment : {32, 64, 4096}) {
    void* block = ::operator new(100, std::align_val_t(alignment));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % alignment, 0U);
    ::operator delete(block, std::align_val_t(alignment));
  }
  void* nothing = ::operator new(0);
  EXPECT_NE(nothing, nullptr);
  ::operator delete(nothing);
}

}  // namespace
}  // namespace lintel::test
