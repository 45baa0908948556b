// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/BoundedQueue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>

namespace lintel {
namespace {

TEST(BoundedQueue, HandsOverInOrderAndNeverHoldsMore) {
  constexpr int kCapacity = 3, kValues = 200;
  BoundedQueue<std::unique_ptr<int>> queue(kCapacity);
  std::atomic<int> pushed{0};
  std::thread giver([&] {
    for (int i = 0; i < kValues; ++i) {
      queue.push(std::make_unique<int>(i));
      ++pushed;
    }
    queue.close();
  });
  for (int i = 0; i < kValues; ++i) {
    EXPECT_LE(pushed, i + kCapacity);
    EXPECT_EQ(*queue.pop().value(), i);
  }
  EXPECT_FALSE(queue.pop());
  giver.join();
}

TEST(BoundedQueue, AGiverThatWaitsIsToldThatTheQueueIsClosed) {
  BoundedQueue<int> queue(1);
  bool taken = true;
  std::thread giver([&] {
    while (queue.push(0)) {
    }
    taken = false;
  });
  queue.close();
  giver.join();
  EXPECT_FALSE(taken);
}

}  // namespace
}  // namespace lintel
