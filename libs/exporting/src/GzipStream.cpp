// SPDX-License-Identifier: BSD-3-Clause
#include "GzipStream.h"

#include <array>

#include "lintel/exporting/MapExport.h"

namespace lintel {

GzipStream::GzipStream() {
  constexpr int kWindowOfGzip = 15 + 16;
  if (deflateInit2(&stream_, Z_BEST_SPEED, Z_DEFLATED, kWindowOfGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw ExportError("zlib does not start; is memory full?");
}

GzipStream::~GzipStream() { deflateEnd(&stream_); }

void GzipStream::run(int flush) {
  std::array<char, 1 << 16> chunk;
  do {
    stream_.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream_.avail_out = static_cast<uInt>(chunk.size());
    if (deflate(&stream_, flush) == Z_STREAM_ERROR) throw ExportError("zlib breaks off");
    bytes_.append(chunk.data(), chunk.size() - stream_.avail_out);
  } while (stream_.avail_out == 0);
}

std::size_t GzipStream::Write(const void* data, std::size_t size) {
  constexpr std::size_t kMost = 1U << 30;  // zlib counts in 32 bits
  for (std::size_t done = 0; done < size;) {
    const std::size_t part = size - done < kMost ? size - done : kMost;
    stream_.next_in = static_cast<Bytef*>(const_cast<void*>(data)) + done;
    stream_.avail_in = static_cast<uInt>(part);
    run(Z_NO_FLUSH);
    done += part;
  }
  return size;
}

std::string GzipStream::finish() {
  stream_.avail_in = 0;
  run(Z_FINISH);
  return std::move(bytes_);
}

}  // namespace lintel
