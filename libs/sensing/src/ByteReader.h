// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

namespace lintel {

/// Reads little-endian values from bytes that someone else holds, and never beyond their end.
class ByteReader {
 public:
  class OutOfBytes : public std::runtime_error {
   public:
    OutOfBytes() : std::runtime_error("data end too early") {}
  };

  ByteReader() = default;
  ByteReader(const std::uint8_t* data, std::size_t size) : begin_(data), at_(data), end_(data + size) {}

  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  std::size_t position() const { return static_cast<std::size_t>(at_ - begin_); }
  const std::uint8_t* begin() const { return at_; }
  const std::uint8_t* end() const { return end_; }

  template <class T>
  T get() {
    T value;
    std::memcpy(&value, part(sizeof value).at_, sizeof value);
    return value;
  }

  /// The next `size` bytes.
  ByteReader part(std::uint64_t size) {
    if (size > remaining()) throw OutOfBytes();
    const ByteReader part(at_, static_cast<std::size_t>(size));
    at_ += size;
    return part;
  }

  /// A text behind its length of 32 bits.
  std::string text() {
    const ByteReader characters = part(get<std::uint32_t>());
    return {characters.begin(), characters.end()};
  }

 private:
  const std::uint8_t* begin_ = nullptr;
  const std::uint8_t* at_ = nullptr;
  const std::uint8_t* end_ = nullptr;
};

}  // namespace lintel
