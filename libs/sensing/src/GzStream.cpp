// SPDX-License-Identifier: BSD-3-Clause
#include "GzStream.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

constexpr unsigned kBuffer_bytes = 256 * 1024;

unsigned chunk(std::size_t count) { return static_cast<unsigned>(std::min<std::size_t>(count, 1u << 30)); }

[[noreturn]] void failWriting(const std::string& path) {
  throw std::runtime_error(path + ": cannot be written: is the disk full, the folder writable?");
}

}  // namespace

GzInput::GzInput(const std::string& path) : file_(nullptr) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw RecordingError(path + ": no such file: give a .rawlog");
  file_ = gzopen(path.c_str(), "rb");
  if (!file_) throw RecordingError(path + ": cannot be opened: check its permissions");
  gzbuffer(file_, kBuffer_bytes);
}

GzInput::~GzInput() { gzclose_r(file_); }

std::size_t GzInput::Read(void* buffer, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    const int n = gzread(file_, static_cast<char*>(buffer) + done, chunk(count - done));
    if (n <= 0) break;
    done += static_cast<std::size_t>(n);
  }
  if (done < count) {
    int error = Z_OK;
    gzerror(file_, &error);
    damaged_ = damaged_ || (error != Z_OK && error != Z_STREAM_END);
  }
  bytes_ += done;
  return done;
}

GzOutput::GzOutput(const std::string& path, int level) : path_(path), file_(nullptr) {
  const std::string mode = level == 0 ? std::string("wbT") : "wb" + std::to_string(level);
  file_ = gzopen(path.c_str(), mode.c_str());
  if (!file_) failWriting(path_);
  gzbuffer(file_, kBuffer_bytes);
}

GzOutput::~GzOutput() {
  if (file_) gzclose_w(file_);
}

void GzOutput::close() {
  gzFile file = file_;
  file_ = nullptr;
  if (file && gzclose_w(file) != Z_OK) failed_ = true;
  check();
}

void GzOutput::check() const {
  if (failed_) failWriting(path_);
}

std::size_t GzOutput::Write(const void* buffer, std::size_t count) {
  for (std::size_t done = 0; done < count;) {
    const int n = gzwrite(file_, static_cast<const char*>(buffer) + done, chunk(count - done));
    failed_ = failed_ || n <= 0;
    check();
    done += static_cast<std::size_t>(n);
  }
  bytes_ += count;
  return count;
}

}  // namespace lintel
