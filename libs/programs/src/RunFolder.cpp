// SPDX-License-Identifier: BSD-3-Clause
#include "RunFolder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "lintel/pipeline/Results.h"

namespace lintel {

namespace fs = std::filesystem;

RunFolder::RunFolder(const std::string& path, bool overwrite) : path_(path) {
  std::error_code error;
  made_ = fs::create_directories(path, error);
  if (error) throw std::runtime_error(path + ": cannot be made: " + error.message() + "; choose another folder");
  lock_.emplace(path);
  if (::access(path.c_str(), W_OK | X_OK) != 0)
    throw std::runtime_error(path + ": cannot be written to: " + std::strerror(errno) + "; choose another folder");
  if (!overwrite && fs::exists(fs::path(path) / "trajectory.tum"))
    throw std::runtime_error(path + ": holds the results of an earlier run; choose another folder or add -w");
  if (!overwrite && fs::exists(TrajectoryCheckpoint::fileIn(path)))
    throw std::runtime_error(path +
                             ": holds trajectory.partial.tum of a run that was killed; keep it elsewhere if you need "
                             "it, then choose another folder or add -w");
  removeParts();
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (made_) fs::remove(path_, ignored);  // not if something is in it
}

/// What AtomicFile has begun: `.NAME.part-PID`. The lock says that nobody is at it.
void RunFolder::removeParts() const {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(path_, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.front() == '.' && name.find(".part-") != std::string::npos && entry.is_regular_file(ignored))
      fs::remove(entry.path(), ignored);
  }
}

TrajectoryCheckpoint::TrajectoryCheckpoint(const std::string& folder, double every_s)
    : path_(fileIn(folder)), every_s_(every_s) {
  ::unlink(path_.c_str());
}

TrajectoryCheckpoint::~TrajectoryCheckpoint() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void TrajectoryCheckpoint::add(const OdometryPose& pose) {
  if (every_s_ <= 0) return;
  waiting_.push_back(pose);
  if (std::chrono::duration<double>(Clock::now() - last_).count() >= every_s_) flush();
}

void TrajectoryCheckpoint::flush() {
  if (waiting_.empty() || !fault_.empty()) return;
  write();
  waiting_.clear();
  last_ = Clock::now();
}

void TrajectoryCheckpoint::endStart() {
  flush();
  if (descriptor_ >= 0) settled_bytes_ = ::lseek(descriptor_, 0, SEEK_END);
}

void TrajectoryCheckpoint::withdrawStart() {
  waiting_.clear();
  if (descriptor_ >= 0 && ::ftruncate(descriptor_, settled_bytes_) != 0)
    fault_ = path_ + ": " + std::strerror(errno) + "; it holds poses of a start that was wrong";
}

void TrajectoryCheckpoint::write() {
  const std::string text = trajectoryText(waiting_), header = text.substr(0, text.find('\n') + 1);
  std::string_view rest = text;
  if (descriptor_ < 0) descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ >= 0 && ::lseek(descriptor_, 0, SEEK_END) > 0) rest.remove_prefix(header.size());
  while (descriptor_ >= 0 && !rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) break;
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  if (!rest.empty())
    fault_ = path_ + ": " + std::strerror(errno) + "; the trajectory is not saved while the run lasts";
  else
    ::fdatasync(descriptor_);
}

void TrajectoryCheckpoint::remove() {
  every_s_ = 0;
  ::unlink(path_.c_str());
}

std::string TrajectoryCheckpoint::fileIn(const std::string& folder) {
  return (fs::path(folder) / "trajectory.partial.tum").string();
}

}  // namespace lintel
