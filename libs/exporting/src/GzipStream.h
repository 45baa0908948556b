// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zlib.h>

#include <cstddef>
#include <string>

namespace lintel {

/// A stream for MRPT's archives that keeps only the compressed bytes in memory. No time of day is written into them.
class GzipStream {
 public:
  GzipStream();
  ~GzipStream();
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  /// The interface that mrpt::serialization::archiveFrom() needs; this stream cannot be read.
  std::size_t Write(const void* data, std::size_t size);
  std::size_t Read(void*, std::size_t) { return 0; }
  std::string getStreamDescription() const { return "gzip in memory"; }

  /// Ends the stream and hands out the bytes of a .gz file. Call once, last.
  std::string finish();

 private:
  void run(int flush);

  z_stream stream_{};
  std::string bytes_;
};

}  // namespace lintel
