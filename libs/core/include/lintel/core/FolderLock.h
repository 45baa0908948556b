// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lintel {

/// A lock (flock) on a file or folder that exists, held by one process or thread at a time and given up when its holder
/// ends, however that happens. Nothing is written.
class FolderLock {
 public:
  enum class WhenHeld { kWait, kRefuse };

  /// Throws std::runtime_error when another holds it and `when_held` is kRefuse, or when `path` cannot be opened. A
  /// file system without locks (some network folders) is used without one.
  explicit FolderLock(const std::string& path, WhenHeld when_held = WhenHeld::kRefuse);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace lintel
