// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace lintel {

/// A file could not be written: one line naming the file, the system's reason and the remedy.
class FileWriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that appears under its name only when it is whole: written beside (`.NAME.part-PID`), flushed to the disk and
/// renamed by `commit()`. Without commit the destructor removes what was written; a file that had the name before
/// stays. A symbolic link is followed. What is no regular file (a pipe, a device) is written in place, as renaming
/// would replace it.
class AtomicFile {
 public:
  /// Creates the file beside. Throws FileWriteError.
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends `bytes`. Throws FileWriteError (disk full, …).
  void write(std::string_view bytes);

  /// Hands what was appended so far to the system: most failures show here. Throws FileWriteError.
  void flush();

  /// Makes the file appear under its name. Throws FileWriteError; then nothing has appeared. Call once, last.
  void commit();

  /// The file `path` with just these bytes. Throws FileWriteError.
  static void writeWhole(const std::string& path, std::string_view bytes);

 private:
  [[noreturn]] void fail(int error_number) const;

  std::string path_;       // as given, for messages
  std::string final_;      // after symbolic links
  std::string temporary_;  // empty: written in place
  std::string buffer_;
  int descriptor_ = -1;
  bool committed_ = false;
};

}  // namespace lintel
