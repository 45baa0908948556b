// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

#include "ByteStream.h"
#include "lintel/mapping/LineMap.h"

namespace lintel {

/// One section of the native map file: its name of four characters and how it becomes bytes and comes back.
/// A section's layout never changes once released: what is added later goes into a section with a new name, which
/// earlier readers skip; what is replaced raises the file's version. A section of no bytes is not written.
struct MapSection {
  std::string_view name;
  void (*encode)(const LineMap& map, ByteWriter& out);
  void (*decode)(ByteReader& in, LineMap& map);  ///< throws ByteReaderError
};

/// All sections in the order in which they are written.
constexpr std::size_t kMapSectionCount = 19;
extern const MapSection kMapSections[kMapSectionCount];

// what merging needs, MergingSections.cpp
void encodePieces(const LineMap& map, ByteWriter& out);
void decodePieces(ByteReader& in, LineMap& map);
void encodeImu(const LineMap& map, ByteWriter& out);
void decodeImu(ByteReader& in, LineMap& map);
void encodeStamps(const LineMap& map, ByteWriter& out);
void decodeStamps(ByteReader& in, LineMap& map);
void encodeCorrelated(const LineMap& map, ByteWriter& out);
void decodeCorrelated(ByteReader& in, LineMap& map);
void encodeOffsets(const LineMap& map, ByteWriter& out);
void decodeOffsets(ByteReader& in, LineMap& map);
void encodeViews(const LineMap& map, ByteWriter& out);
void decodeViews(ByteReader& in, LineMap& map);

}  // namespace lintel
