// SPDX-License-Identifier: BSD-3-Clause
#include "Decompress.h"

#include <lz4frame.h>
#include <zstd.h>

namespace lintel {
namespace {

constexpr std::uint64_t kMaxSize = 1U << 30;

/// Whether packed bytes can become so many: asked before memory is taken for them.
bool isPossible(const std::string& kind, const ByteReader& packed, std::uint64_t size) {
  if (kind == "lz4") return size <= 255 * static_cast<std::uint64_t>(packed.remaining());
  std::uint64_t said = 0;
  return isZstd(packed, said) && (said == 0 || said == size);
}

bool decompressZstd(const ByteReader& packed, std::vector<std::uint8_t>& out) {
  return ZSTD_decompress(out.data(), out.size(), packed.begin(), packed.remaining()) == out.size();
}

bool decompressLz4(const ByteReader& packed, std::vector<std::uint8_t>& out) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) return false;
  std::size_t read = 0, written = 0, hint = 1;
  while (hint != 0 && read < packed.remaining()) {
    std::size_t source = packed.remaining() - read, target = out.size() - written;
    hint = LZ4F_decompress(context, out.data() + written, &target, packed.begin() + read, &source, nullptr);
    if (LZ4F_isError(hint) || (source == 0 && target == 0)) break;
    read += source;
    written += target;
  }
  LZ4F_freeDecompressionContext(context);
  return hint == 0 && written == out.size();
}

}  // namespace

bool decompress(const std::string& kind, const ByteReader& packed, std::uint64_t size, std::vector<std::uint8_t>& out) {
  if (size > kMaxSize) return false;
  if (kind.empty()) {
    out.assign(packed.begin(), packed.end());
    return out.size() == size;
  }
  if ((kind != "zstd" && kind != "lz4") || !isPossible(kind, packed, size)) return false;
  out.resize(static_cast<std::size_t>(size));
  return kind == "zstd" ? decompressZstd(packed, out) : decompressLz4(packed, out);
}

bool isZstd(const ByteReader& bytes, std::uint64_t& size) {
  ByteReader copy = bytes;
  if (bytes.remaining() < 4 || copy.get<std::uint32_t>() != ZSTD_MAGICNUMBER) return false;
  const unsigned long long content = ZSTD_getFrameContentSize(bytes.begin(), bytes.remaining());
  size = content == ZSTD_CONTENTSIZE_UNKNOWN || content == ZSTD_CONTENTSIZE_ERROR ? 0 : content;
  return true;
}

}  // namespace lintel
