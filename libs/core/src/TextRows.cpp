// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/TextRows.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace lintel {

namespace {

constexpr const char* kBlanks = " \t\r";
constexpr std::size_t kLongestLine = 1000000;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

template <class T>
std::optional<T> parsed(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

TextRows::TextRows(std::string path, Throw throw_error)
    : path_(std::move(path)), throw_error_(throw_error), in_(path_) {
  if (!in_) raise(path_ + ": cannot be opened (" + std::strerror(errno) + "); check the name");
}

/// The next line; a longer one than any table has is not taken into memory.
bool TextRows::readLine() {
  line_.clear();
  try {
    while (true) {
      const int c = in_.rdbuf()->sbumpc();
      if (c == '\n') return true;
      if (c == std::char_traits<char>::eof()) break;
      if (line_.size() == kLongestLine) fail("a line of more than a million characters; give a text file");
      line_ += static_cast<char>(c);
    }
    in_.setstate(std::ios::eofbit);
  } catch (const std::ios_base::failure&) {  // a folder, for example
    in_.setstate(std::ios::badbit);
  }
  return !line_.empty() && !in_.bad();
}

bool TextRows::next(bool skip_comments) {
  while (readLine()) {
    ++line_number_;
    if (line_number_ == 1 && line_.rfind("\xef\xbb\xbf", 0) == 0) line_.erase(0, 3);  // byte order mark
    const std::string_view text = trimmed(line_);
    if (text.empty() || (skip_comments && text.front() == '#')) continue;
    split();
    return true;
  }
  if (in_.bad()) raise(path_ + ": cannot be read to its end; give a text file");
  return false;
}

void TextRows::split() {
  fields_.clear();
  std::string_view rest = trimmed(line_);
  comma_separated_ = rest.find(',') != std::string_view::npos;
  const char* separators = comma_separated_ ? "," : kBlanks;
  while (true) {
    const auto end = rest.find_first_of(separators);
    fields_.push_back(trimmed(rest.substr(0, end)));
    if (end == std::string_view::npos) return;
    rest.remove_prefix(end + 1);
    if (!comma_separated_) rest = trimmed(rest);
  }
}

void TextRows::raise(const std::string& message) const {
  throw_error_(message);
  std::abort();  // throw_error_ has returned
}

void TextRows::fail(const std::string& what) const { raise(where() + ": " + what); }

std::optional<double> TextRows::numberIfAny(std::size_t index) const {
  return index < fields_.size() ? parsed<double>(fields_[index]) : std::nullopt;
}

std::optional<std::int64_t> TextRows::integerIfAny(std::size_t index) const {
  return index < fields_.size() ? parsed<std::int64_t>(fields_[index]) : std::nullopt;
}

template <class T>
T TextRows::parse(std::size_t index, const char* expected) const {
  const std::string column = "column " + std::to_string(index + 1);
  if (index >= fields_.size()) fail(column + " is missing");
  const std::optional<T> value = parsed<T>(fields_[index]);
  if (!value) fail(column + " should be " + expected + ", but is '" + std::string(fields_[index]) + "'");
  return *value;
}

double TextRows::number(std::size_t index) const {
  const auto value = parse<double>(index, "a number");
  if (!std::isfinite(value)) fail("column " + std::to_string(index + 1) + " is not finite; remove the row");
  return value;
}

std::int64_t TextRows::integer(std::size_t index) const {
  return parse<std::int64_t>(index, "a time in integer nanoseconds");
}

std::int64_t TextRows::secondsAsNanoseconds(std::size_t index) const {
  const auto seconds = parse<long double>(index, "a time in seconds");
  if (!(std::abs(seconds) < 9e9L)) fail("the time is not in seconds");
  return std::llround(seconds * 1e9L);
}

}  // namespace lintel
