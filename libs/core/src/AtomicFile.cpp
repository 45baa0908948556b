// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/AtomicFile.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace lintel {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBufferSize = 1 << 20;

std::string remedy(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or write to another disk";
    case ENOENT:
    case ENOTDIR:
      return "create the folder first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a place you may write to";
    case EISDIR:
      return "name a file, not a folder";
    default:
      return "choose another place";
  }
}

/// Where a symbolic link leads; the path itself where there is none (yet).
std::string resolved(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_symlink(fs::symlink_status(path, ignored))) return path;
  const fs::path target = fs::weakly_canonical(path, ignored);
  return ignored ? path : target.string();
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path), final_(resolved(path)) {
  if (path.empty()) fail(ENOENT);
  struct stat status {};
  const bool exists = ::stat(final_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(final_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    if (exists && ::access(final_.c_str(), W_OK) != 0) fail(errno);  // rename would replace even a read-only file
    const fs::path final_path(final_);
    temporary_ =
        (final_path.parent_path() / ("." + final_path.filename().string() + ".part-" + std::to_string(::getpid())))
            .string();
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  }
  if (descriptor_ < 0) fail(errno);
  buffer_.reserve(kBufferSize);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!committed_ && !temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t taken = std::min(bytes.size(), kBufferSize - buffer_.size());
    buffer_.append(bytes.substr(0, taken));
    bytes.remove_prefix(taken);
    if (buffer_.size() == kBufferSize) flush();
  }
}

void AtomicFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(written < 0 ? errno : ENOSPC);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void AtomicFile::commit() {
  flush();
  // A full disk may show only when the blocks are really allocated; pipes and devices know no fsync.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS && errno != ENOTSUP) fail(errno);
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail(errno);
  if (!temporary_.empty() && std::rename(temporary_.c_str(), final_.c_str()) != 0) fail(errno);
  committed_ = true;
}

void AtomicFile::fail(int error_number) const {
  throw FileWriteError("cannot write " + (path_.empty() ? std::string("a file without a name") : path_) + ": " +
                       std::strerror(error_number) + "; " + remedy(error_number));
}

void AtomicFile::writeWhole(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace lintel
