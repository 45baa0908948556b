// SPDX-License-Identifier: BSD-3-Clause
#include "Ros1Check.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <vector>

#include "ByteReader.h"
#include "Decompress.h"
#include "lintel/sensing/Recording.h"

namespace lintel {

namespace {

constexpr std::uint64_t kLargestHeader = 1 << 20, kLargestChunk = 1 << 30;
enum Op : std::uint8_t { kBag = 3, kIndex = 4, kChunk = 5 };

/// Walks the records of a bag by their lengths alone.
class Walk {
 public:
  explicit Walk(const std::string& path) : file_(path, std::ios::binary | std::ios::ate) {
    size_ = file_ ? static_cast<std::uint64_t>(file_.tellg()) : 0;
    file_.seekg(0);
    std::string line;
    std::getline(file_, line);
    at_ = line.size() + 1;
    if (line != "#ROSBAG V2.0") throw RecordingError("it does not begin as one of format 2.0");
  }

  void check() {
    while (at_ < size_ && !unclosed_) checkRecord();
  }

 private:
  using Fields = std::map<std::string, std::string>;

  void checkRecord() {
    const Fields header = readHeader(size_);
    const std::uint64_t length = readLength(size_), begin = at_;
    const std::uint8_t op = opOf(header);
    if (op == kBag) unclosed_ = numberIn<std::uint64_t>(header, "index_pos") == 0;  // the library says it
    if (op == kChunk) checkChunk(header, begin, length);
    if (op == kIndex) checkIndex(length);
    at_ = begin + length;
    file_.seekg(static_cast<std::streamoff>(at_));
  }

  void checkChunk(const Fields& header, std::uint64_t begin, std::uint64_t length) {
    chunk_size_ = numberIn<std::uint32_t>(header, "size");
    starts_.clear();
    const auto compression = header.find("compression");
    if (compression == header.end()) throw RecordingError("a chunk without its kind of compression");
    if (chunk_size_ > kLargestChunk) throw RecordingError("a chunk of " + std::to_string(chunk_size_) + " bytes");
    if (compression->second == "none") walkPlain(begin, length);
    if (compression->second == "lz4") walkPacked(length);
  }

  void walkPlain(std::uint64_t begin, std::uint64_t length) {
    if (chunk_size_ != length) throw RecordingError("a chunk whose two lengths differ");
    while (at_ < begin + length) {
      starts_.push_back(at_ - begin);
      readHeader(begin + length);
      const std::uint64_t data = readLength(begin + length);
      at_ += data;
      file_.seekg(static_cast<std::streamoff>(at_));
    }
  }

  void walkPacked(std::uint64_t length) {
    packed_.resize(static_cast<std::size_t>(length));
    read(packed_.data(), packed_.size());
    if (!decompress("lz4", {packed_.data(), packed_.size()}, chunk_size_, chunk_))
      throw RecordingError("a chunk that cannot be decompressed");
    for (ByteReader reader(chunk_.data(), chunk_.size()); reader.remaining() > 0;) {
      starts_.push_back(reader.position());
      for (const char* part : {"header", "data"}) {
        const auto size = reader.get<std::uint32_t>();
        if (size > reader.remaining())
          throw RecordingError(std::string("a message whose ") + part + " leaves its chunk");
        reader.part(size);
      }
    }
  }

  /// Places of messages in the chunk before: time and offset, twelve bytes each.
  void checkIndex(std::uint64_t length) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(length));
    read(bytes.data(), bytes.size());
    ByteReader reader(bytes.data(), bytes.size());
    while (reader.remaining() >= 12) {
      reader.get<std::uint64_t>();
      const std::uint64_t place = reader.get<std::uint32_t>();
      if (!starts_.empty() && !std::binary_search(starts_.begin(), starts_.end(), place))
        throw RecordingError("an index of messages that are not there");
    }
  }

  Fields readHeader(std::uint64_t end) {
    const std::uint64_t length = readLength(end);
    if (length > kLargestHeader) throw RecordingError("a header of " + std::to_string(length) + " bytes");
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(length));
    read(bytes.data(), bytes.size());
    at_ += length;
    ByteReader reader(bytes.data(), bytes.size());
    Fields fields;
    while (reader.remaining() > 0) {
      const std::string field = reader.text();
      const std::size_t equals = field.find('=');
      if (equals == std::string::npos) throw RecordingError("a header that is none");
      fields[field.substr(0, equals)] = field.substr(equals + 1);
    }
    return fields;
  }

  /// A length of 32 bits, of something that must end before `end`.
  std::uint64_t readLength(std::uint64_t end) {
    std::uint8_t bytes[4];
    if (end - at_ < sizeof bytes) throw RecordingError("its last record is cut");
    read(bytes, sizeof bytes);
    at_ += sizeof bytes;
    const auto length = ByteReader(bytes, sizeof bytes).get<std::uint32_t>();
    if (length > end - at_)
      throw RecordingError("a record of " + std::to_string(length) + " bytes where " + std::to_string(end - at_) +
                           " are left");
    return length;
  }

  void read(std::uint8_t* bytes, std::size_t size) {
    if (size > 0 && !file_.read(reinterpret_cast<char*>(bytes), static_cast<std::streamsize>(size)))
      throw RecordingError("cannot be read");
  }

  template <class Number>
  static Number numberIn(const Fields& fields, const std::string& name) {
    const auto field = fields.find(name);
    if (field == fields.end() || field->second.size() != sizeof(Number))
      throw RecordingError("a record without " + name);
    return ByteReader(reinterpret_cast<const std::uint8_t*>(field->second.data()), sizeof(Number)).get<Number>();
  }
  static std::uint8_t opOf(const Fields& fields) { return numberIn<std::uint8_t>(fields, "op"); }

  std::ifstream file_;
  std::uint64_t size_ = 0, at_ = 0, chunk_size_ = 0;
  std::vector<std::uint64_t> starts_;  // of the records in the chunk before, where it could be looked into
  std::vector<std::uint8_t> packed_, chunk_;
  bool unclosed_ = false;
};

}  // namespace

void checkRos1Bag(const std::string& path) { Walk(path).check(); }

}  // namespace lintel
