// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "lintel/geometry/Pose.h"

namespace lintel {

/// Appends little-endian values to a string of bytes, whatever the machine's own order.
class ByteWriter {
 public:
  void u8(std::uint8_t v) { bytes_.push_back(static_cast<char>(v)); }
  void u32(std::uint32_t v) { little(v, 4); }
  void u64(std::uint64_t v) { little(v, 8); }
  void i32(std::int32_t v) { u32(static_cast<std::uint32_t>(v)); }
  void i64(std::int64_t v) { u64(static_cast<std::uint64_t>(v)); }
  void f32(float v) {
    std::uint32_t bits;
    std::memcpy(&bits, &v, 4);
    u32(bits);
  }
  void f64(double v) {
    std::uint64_t bits;
    std::memcpy(&bits, &v, 8);
    u64(bits);
  }
  void vec2(const Eigen::Vector2d& v) { f64(v.x()), f64(v.y()); }
  void vec3(const Eigen::Vector3d& v) { f64(v.x()), f64(v.y()), f64(v.z()); }
  void pose(const Pose& T) { f64(T.q.w()), f64(T.q.x()), f64(T.q.y()), f64(T.q.z()), vec3(T.p); }
  void text(const std::string& s) { u64(s.size()), bytes_.append(s); }

  void append(const ByteWriter& other) { bytes_.append(other.bytes_); }

  const std::string& bytes() const { return bytes_; }

 private:
  void little(std::uint64_t v, int size) {
    char raw[8];
    for (int i = 0; i < size; ++i) raw[i] = static_cast<char>(v >> (8 * i));
    bytes_.append(raw, static_cast<std::size_t>(size));
  }

  std::string bytes_;
};

/// The bytes end before what they announce.
class ByteReaderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Takes little-endian values from bytes; every access is checked. Throws ByteReaderError.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  std::uint8_t u8() { return static_cast<std::uint8_t>(take(1).front()); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(little(4)); }
  std::uint64_t u64() { return little(8); }
  std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
  std::int64_t i64() { return static_cast<std::int64_t>(u64()); }
  float f32() {
    const std::uint32_t bits = u32();
    float v;
    std::memcpy(&v, &bits, 4);
    return v;
  }
  double f64() {
    const std::uint64_t bits = u64();
    double v;
    std::memcpy(&v, &bits, 8);
    return v;
  }
  Eigen::Vector2d vec2() {
    const double x = f64();
    return {x, f64()};
  }
  Eigen::Vector3d vec3() {
    const double x = f64(), y = f64();
    return {x, y, f64()};
  }
  Pose pose() {
    Pose T;
    T.q.w() = f64(), T.q.x() = f64(), T.q.y() = f64(), T.q.z() = f64();
    T.p = vec3();
    return T;
  }
  std::string text() { return std::string(take(u64())); }

  /// A number of records of at least `record_size` bytes each: refused when so many cannot follow, so that what is
  /// reserved for them is bounded by the bytes there are.
  std::size_t count(std::size_t record_size) {
    const std::uint64_t n = u64();
    if (n > rest_.size() / record_size) throw ByteReaderError("announces more records than it has bytes");
    return static_cast<std::size_t>(n);
  }

  std::string_view take(std::uint64_t size) {
    if (size > rest_.size()) throw ByteReaderError("ends too early");
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(static_cast<std::size_t>(size));
    return taken;
  }
  bool atEnd() const { return rest_.empty(); }

 private:
  std::uint64_t little(std::size_t size) {
    const std::string_view raw = take(size);
    std::uint64_t v = 0;
    for (std::size_t i = 0; i < size; ++i)
      v |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(raw[i])) << (8 * i);
    return v;
  }

  std::string_view rest_;
};

}  // namespace lintel
