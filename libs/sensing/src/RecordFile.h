// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "lintel/sensing/Recording.h"

namespace lintel {

/// A binary file read in order; a length that it does not have is refused before memory is taken for it.
class RecordFile {
 public:
  /// Throws RecordingError when it cannot be opened.
  explicit RecordFile(const std::string& path) : file_(path, std::ios::binary | std::ios::ate) {
    if (!file_) throw RecordingError(path + ": cannot be opened: check its name");
    left_ = static_cast<std::uint64_t>(file_.tellg());
    file_.seekg(0);
  }

  /// All false when the file does not have so many bytes left.
  bool read(void* bytes, std::size_t size) {
    if (!take(size)) return false;
    return static_cast<bool>(file_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(size)));
  }
  bool read(std::uint64_t size, std::vector<std::uint8_t>& bytes) {
    if (size > left_) return false;
    bytes.resize(static_cast<std::size_t>(size));
    return read(bytes.data(), bytes.size());
  }
  bool skip(std::uint64_t size) {
    if (!take(size)) return false;
    return static_cast<bool>(file_.seekg(static_cast<std::streamoff>(size), std::ios::cur));
  }

 private:
  bool take(std::uint64_t size) {
    if (size > left_) return false;
    left_ -= size;
    return true;
  }

  std::ifstream file_;
  std::uint64_t left_ = 0;
};

}  // namespace lintel
