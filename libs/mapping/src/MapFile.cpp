// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/MapFile.h"

#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "MapChecks.h"
#include "MapSections.h"
#include "lintel/core/AtomicFile.h"

// The file, little endian throughout:
//   8 bytes  mark, u32 version
//   sections: 4 bytes name, u64 size, `size` bytes, u32 CRC-32 of all of the section before it
//   the last section is "END_" and empty: a file that ends earlier is cut
namespace lintel {

namespace {

using namespace std::string_view_literals;
constexpr std::string_view kMark =
    "\x89LINTEL\n"sv;  // the first byte is no text; transfers in text mode change the last one
constexpr std::uint32_t kVersion = 1;
constexpr std::string_view kEnd = "END_";

std::uint32_t checksum(std::string_view head, std::string_view payload) {
  const auto bytes = [](std::string_view s) { return reinterpret_cast<const Bytef*>(s.data()); };
  uLong crc = crc32_z(0, bytes(head), head.size());
  if (!payload.empty()) crc = crc32_z(crc, bytes(payload), payload.size());  // null data would reset it
  return static_cast<std::uint32_t>(crc);
}

void writeSection(AtomicFile& file, std::string_view name, const std::string& payload) {
  ByteWriter size, crc;
  size.u64(payload.size());
  const std::string head = std::string(name) + size.bytes();
  crc.u32(checksum(head, payload));
  file.write(head);
  file.write(payload);
  file.write(crc.bytes());
}

/// Parses a map file; keeps the position for messages.
class MapFileReader {
 public:
  MapFileReader(const std::string& path, std::istream& file, std::uint64_t size)
      : path_(path), file_(file), left_(size) {}

  LineMap read() {
    readHead();
    LineMap map;
    std::set<std::string> seen;
    for (;;) {
      const auto [name, payload] = readSection();
      if (name == kEnd) break;
      if (!seen.insert(name).second) fail("has a section twice");
      for (const MapSection& section : kMapSections) {
        if (section.name == name) decode(section, payload, map);
      }
    }
    if (left_ != 0) fail("has bytes after its end");
    if (const std::string wrong = whatIsWrong(map); !wrong.empty()) fail(wrong);
    return map;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw MapFileError(path_ + " " + what + "; it is damaged or no map.lintel: make or copy it again");
  }

  std::string bytes(std::uint64_t size) {
    if (size > left_) fail("ends too early");
    std::string taken(static_cast<std::size_t>(size), '\0');
    file_.read(taken.data(), static_cast<std::streamsize>(size));
    if (!file_) fail("cannot be read to its end");
    left_ -= size;
    return taken;
  }

  void readHead() {
    if (left_ < kMark.size() + 4 || bytes(kMark.size()) != kMark) fail("does not begin as a native map file");
    const std::string raw = bytes(4);
    const std::uint32_t version = ByteReader(raw).u32();
    if (version == 0) fail("has no version");
    if (version > kVersion) {
      throw MapFileError(path_ + " has format " + std::to_string(version) + ", this program reads up to " +
                         std::to_string(kVersion) + "; use a newer Lintel");
    }
  }

  std::pair<std::string, std::string> readSection() {
    const std::string head = bytes(kEnd.size() + 8);
    std::string payload = bytes(ByteReader(std::string_view(head).substr(kEnd.size())).u64());
    const std::string crc = bytes(4);
    std::string name = head.substr(0, kEnd.size());
    if (ByteReader(crc).u32() != checksum(head, payload)) fail("fails the checksum of a section");
    return {std::move(name), std::move(payload)};
  }

  void decode(const MapSection& section, const std::string& payload, LineMap& map) const {
    try {
      ByteReader in(payload);
      section.decode(in, map);
      if (!in.atEnd()) throw ByteReaderError("has bytes too many");
    } catch (const ByteReaderError& error) {
      fail("section " + std::string(section.name) + " " + error.what());
    }
  }

  std::string path_;
  std::istream& file_;
  std::uint64_t left_ = 0;
};

}  // namespace

void writeMap(const LineMap& map, const std::string& path) {
  try {
    AtomicFile file(path);
    ByteWriter version;
    version.u32(kVersion);
    file.write(kMark);
    file.write(version.bytes());
    for (const MapSection& section : kMapSections) {
      ByteWriter payload;
      section.encode(map, payload);
      if (!payload.bytes().empty()) writeSection(file, section.name, payload.bytes());
    }
    writeSection(file, kEnd, {});
    file.commit();
  } catch (const FileWriteError& error) {
    throw MapFileError(error.what());
  }
}

LineMap readMap(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const int reason = errno;
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(path, error);
  if (!file) throw MapFileError("cannot read " + path + ": " + std::strerror(reason) + "; name a map.lintel");
  if (!regular) throw MapFileError("cannot read " + path + ": not a file; name a map.lintel");
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw MapFileError("cannot read " + path + ": " + error.message());
  return MapFileReader(path, file, size).read();
}

LineMap mapFromBytes(const std::string& bytes, const std::string& name) {
  std::istringstream file(bytes);
  return MapFileReader(name, file, bytes.size()).read();
}

}  // namespace lintel
