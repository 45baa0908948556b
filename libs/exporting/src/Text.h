// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

namespace lintel {

/// Text put together from numbers: shortest digits that read back to the same value, whatever the locale.
class Text {
 public:
  Text& operator<<(std::string_view s) { return bytes_.append(s), *this; }
  Text& operator<<(char c) { return bytes_.push_back(c), *this; }
  Text& operator<<(int v) { return number(v); }
  Text& operator<<(std::int64_t v) { return number(v); }
  Text& operator<<(std::uint32_t v) { return number(v); }
  Text& operator<<(std::uint64_t v) { return number(v); }
  Text& operator<<(float v) { return number(v); }
  Text& operator<<(double v) { return number(v); }

  /// Three numbers with blanks between them.
  template <class Vector>
  Text& vector(const Vector& v) {
    return *this << v.x() << ' ' << v.y() << ' ' << v.z();
  }
  /// Seconds of a time in nanoseconds, 9 decimals.
  Text& seconds(std::int64_t t_ns) {
    const std::uint64_t magnitude = t_ns < 0 ? 0 - static_cast<std::uint64_t>(t_ns) : static_cast<std::uint64_t>(t_ns);
    const std::string fraction = std::to_string(magnitude % 1000000000);
    return *this << (t_ns < 0 ? "-" : "") << magnitude / 1000000000 << '.' << std::string(9 - fraction.size(), '0')
                 << fraction;
  }

  std::string& bytes() { return bytes_; }

 private:
  template <class Number>
  Text& number(Number v) {
    char digits[40];
    bytes_.append(digits, std::to_chars(digits, digits + sizeof digits, v).ptr);
    return *this;
  }

  std::string bytes_;
};

}  // namespace lintel
