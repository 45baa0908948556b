// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include "lintel/mapping/LineMap.h"

namespace lintel {

/// The native map file cannot be read or written: one line naming the file, what is wrong with it and the remedy.
class MapFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes `map` losslessly as the native file (`map.lintel`), atomically: the file appears whole or not at all.
/// The same map gives the same bytes. Throws MapFileError.
void writeMap(const LineMap& map, const std::string& path);

/// Reads a native map file. Throws MapFileError on anything that is not a whole, undamaged map; memory is bounded by a
/// small multiple of the file's size whatever the bytes say.
LineMap readMap(const std::string& path);

/// The same from a file's bytes; `name` is for messages.
LineMap mapFromBytes(const std::string& bytes, const std::string& name);

}  // namespace lintel
