// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace lintel {

/// The rows of a text table (comma- or blank-separated) one after the other, with errors that name file and line.
class TextRows {
 public:
  /// Throws EvaluationError when the file cannot be opened.
  explicit TextRows(const std::string& path);

  /// Reads the next line that holds something into fields(); with `skip_comments`, lines starting with # do not count.
  /// Throws EvaluationError on a read error.
  bool next(bool skip_comments = true);

  /// Fields of the current row, without surrounding blanks. Separated by commas if the row has one, else by blanks.
  const std::vector<std::string_view>& fields() const { return fields_; }
  bool commaSeparated() const { return comma_separated_; }

  /// The finite number in field `index`; fail()s when there is none.
  double number(std::size_t index) const;

  /// A time in seconds in field `index`, in nanoseconds: exact to the last decimal, which a double is not.
  std::int64_t secondsAsNanoseconds(std::size_t index) const;
  std::int64_t integer(std::size_t index) const;

  /// Throws EvaluationError "path:line: what".
  [[noreturn]] void fail(const std::string& what) const;

 private:
  template <class T>
  T parse(std::size_t index, const char* expected) const;
  void split();

  std::string path_;
  std::ifstream in_;
  std::string line_;
  std::size_t line_number_ = 0;
  bool comma_separated_ = false;
  std::vector<std::string_view> fields_;
};

}  // namespace lintel
