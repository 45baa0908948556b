// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/TextFile.h"

#include <fstream>
#include <limits>

namespace lintel {

std::string textOfFile(const std::string& path, void (*throw_error)(const std::string&), std::size_t most) {
  std::filebuf file;
  std::string text;
  try {  // reading a folder throws
    if (!file.open(path, std::ios::in | std::ios::binary)) throw std::ios_base::failure("");
    for (char part[1 << 16]; text.size() <= most;) {
      const std::streamsize count = file.sgetn(part, sizeof part);
      if (count <= 0) return text;
      text.append(part, static_cast<std::size_t>(count));
    }
  } catch (const std::ios_base::failure&) {
    throw_error(path + ": cannot be read; check the name and its permissions");
  }
  throw_error(path + ": longer than " + std::to_string(most >> 20) + " MB; give a text file");
  return {};
}

std::string bytesOfFile(const std::string& path) {
  struct Unreadable {};
  try {
    return textOfFile(
        path, [](const std::string&) { throw Unreadable(); }, std::numeric_limits<std::size_t>::max());
  } catch (const Unreadable&) {
    return {};
  }
}

}  // namespace lintel
