// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ByteReader.h"

namespace lintel {

/// Decompresses to exactly `size` bytes; `kind`: "zstd", "lz4" (its frame form) or "" (copied). False when the bytes
/// are damaged, the kind is not known, or the size is beyond 1 GB.
bool decompress(const std::string& kind, const ByteReader& packed, std::uint64_t size, std::vector<std::uint8_t>& out);

/// Whether bytes are a zstd frame; then its size is set, 0 if the frame does not say it.
bool isZstd(const ByteReader& bytes, std::uint64_t& size);

}  // namespace lintel
