// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/FolderLock.h"

#include <gmock/gmock.h>

#include <future>
#include <optional>

#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

TEST(FolderLock, IsHeldByOneAndGivenUpAtItsEnd) {
  const test::TempFolder folder;
  const std::string path = folder.path().string();
  std::optional<FolderLock> first(std::in_place, path);
  try {
    const FolderLock second(path);
    ADD_FAILURE() << "held twice";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), path + ": another run is writing to it; wait for its end or choose another name");
  }
  first.reset();
  EXPECT_NO_THROW(FolderLock{path});
  EXPECT_EQ(folder.entries(), 0) << "nothing is written";
}

TEST(FolderLock, CanBeWaitedFor) {
  const test::TempFolder folder;
  std::optional<FolderLock> first(std::in_place, folder.path().string());
  auto second = std::async(std::launch::async,
                           [&] { const FolderLock lock(folder.path().string(), FolderLock::WhenHeld::kWait); });
  EXPECT_EQ(second.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout);
  first.reset();
  second.get();
}

TEST(FolderLock, NeedsSomethingThatExists) { EXPECT_THROW(FolderLock("/nonexistent/folder"), std::runtime_error); }

}  // namespace
}  // namespace lintel
