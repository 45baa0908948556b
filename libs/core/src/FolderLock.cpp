// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/FolderLock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace lintel {

FolderLock::FolderLock(const std::string& path, WhenHeld when_held) {
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);  // network folders lock files that are open for writing only
  if (descriptor_ < 0 && errno == EISDIR) descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) throw std::runtime_error(path + ": " + std::strerror(errno) + "; choose another place");
  const int refuse = when_held == WhenHeld::kRefuse ? LOCK_NB : 0;
  while (::flock(descriptor_, LOCK_EX | refuse) != 0) {
    if (errno == EINTR) continue;
    if (errno != EWOULDBLOCK) return;  // there are no locks here
    ::close(descriptor_);
    throw std::runtime_error(path + ": another run is writing to it; wait for its end or choose another name");
  }
}

FolderLock::~FolderLock() { ::close(descriptor_); }

}  // namespace lintel
