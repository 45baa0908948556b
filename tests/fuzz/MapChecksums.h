// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>

namespace lintel::test {

/// Bytes of a map file with the checksums that they should have (MapFile.cpp), so that changes reach what is behind.
inline std::string withRightChecksums(std::string bytes) {
  constexpr std::size_t kHead = 12, kSectionHead = 12, kChecksum = 4;
  for (std::size_t at = kHead; at + kSectionHead + kChecksum <= bytes.size();) {
    std::uint64_t size;
    std::memcpy(&size, bytes.data() + at + 4, sizeof size);
    if (size > bytes.size() - at - kSectionHead - kChecksum) break;
    const auto* section = reinterpret_cast<const Bytef*>(bytes.data() + at);
    const auto checksum = static_cast<std::uint32_t>(crc32_z(0, section, kSectionHead + size));
    std::memcpy(bytes.data() + at + kSectionHead + size, &checksum, kChecksum);
    at += kSectionHead + size + kChecksum;
  }
  return bytes;
}

}  // namespace lintel::test
