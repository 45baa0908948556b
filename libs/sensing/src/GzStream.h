// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/io/CStream.h>
#include <zlib.h>

#include <cstdint>
#include <string>

namespace lintel {

// MRPT's own gz streams neither tell a cut file from a finished one nor a full disk from a written file. These do.

/// Reads a plain or gzip-compressed file.
class GzInput final : public mrpt::io::CStream {
 public:
  /// Throws RecordingError when the file cannot be opened.
  explicit GzInput(const std::string& path);
  ~GzInput() override;

  bool damaged() const { return damaged_; }  ///< the compressed data are cut or corrupt
  std::uint64_t bytesRead() const { return bytes_; }

  std::size_t Read(void* buffer, std::size_t count) override;
  std::size_t Write(const void*, std::size_t) override { return 0; }
  std::uint64_t Seek(std::int64_t, mrpt::io::CStream::TSeekOrigin) override { return bytes_; }
  std::uint64_t getTotalBytesCount() const override { return 0; }
  std::uint64_t getPosition() const override { return bytes_; }

 private:
  gzFile file_;
  std::uint64_t bytes_ = 0;
  bool damaged_ = false;
};

/// Writes a file, compressed with gzip level 1..9, or plain with level 0.
class GzOutput final : public mrpt::io::CStream {
 public:
  /// Throws std::runtime_error when the file cannot be created.
  GzOutput(const std::string& path, int level);
  ~GzOutput() override;

  /// Throws std::runtime_error if a Write has failed.
  void check() const;
  /// Throws std::runtime_error unless everything has reached the file.
  void close();

  std::size_t Read(void*, std::size_t) override { return 0; }
  /// Throws std::runtime_error (disk full).
  std::size_t Write(const void* buffer, std::size_t count) override;
  std::uint64_t Seek(std::int64_t, mrpt::io::CStream::TSeekOrigin) override { return bytes_; }
  std::uint64_t getTotalBytesCount() const override { return bytes_; }
  std::uint64_t getPosition() const override { return bytes_; }

 private:
  std::string path_;
  gzFile file_;
  std::uint64_t bytes_ = 0;
  bool failed_ = false;
};

}  // namespace lintel
