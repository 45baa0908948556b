// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lintel {

/// Throws an `Error` with this message: names the class of errors that a reader throws.
template <class Error>
[[noreturn]] void throwError(const std::string& message) {
  throw Error(message);
}

/// The rows of a text table (comma- or blank-separated) one after the other, with errors that name file and line.
class TextRows {
 public:
  using Throw = void (*)(const std::string& message);

  /// Errors are thrown by `throw_error`, which must not return. The first: the file cannot be opened.
  TextRows(std::string path, Throw throw_error);

  /// Reads the next line that holds something into fields(); with `skip_comments`, lines starting with # do not count.
  /// False at the end. Fails on a read error.
  bool next(bool skip_comments = true);

  /// Fields of the current row, without surrounding blanks. Separated by commas if the row has one, else by blanks.
  const std::vector<std::string_view>& fields() const { return fields_; }
  bool commaSeparated() const { return comma_separated_; }

  /// Whether the current row is the last of the file and no line feed ends it: it may have been cut.
  bool isUnterminated() const { return in_.eof(); }

  /// The number in field `index` (NaN and infinity are numbers); empty when there is none.
  std::optional<double> numberIfAny(std::size_t index) const;
  /// The integer in field `index`; empty when there is none.
  std::optional<std::int64_t> integerIfAny(std::size_t index) const;

  // The same and more, but fail when there is none:

  double number(std::size_t index) const;  ///< finite
  std::int64_t integer(std::size_t index) const;
  /// A time in seconds in field `index`, in nanoseconds: exact to the last decimal, which a double is not.
  std::int64_t secondsAsNanoseconds(std::size_t index) const;

  std::string where() const { return path_ + ":" + std::to_string(line_number_); }

  /// Throws the error "path:line: what".
  [[noreturn]] void fail(const std::string& what) const;

 private:
  template <class T>
  T parse(std::size_t index, const char* expected) const;
  [[noreturn]] void raise(const std::string& message) const;
  bool readLine();
  void split();

  std::string path_;
  Throw throw_error_;
  std::ifstream in_;
  std::string line_;
  std::size_t line_number_ = 0;
  bool comma_separated_ = false;
  std::vector<std::string_view> fields_;
};

}  // namespace lintel
