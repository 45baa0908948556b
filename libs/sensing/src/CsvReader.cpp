// SPDX-License-Identifier: BSD-3-Clause
#include "CsvReader.h"

#include <charconv>

#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

std::string_view trimmed(std::string_view text) {
  const char* blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

template <class T>
std::optional<T> parsed(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace

CsvReader::CsvReader(std::string path, std::size_t min_fields)
    : path_(std::move(path)), min_fields_(min_fields), file_(path_) {
  if (!file_) throw RecordingError(path_ + ": cannot be read: is the recording complete?");
}

void CsvReader::split() {
  fields_.clear();
  const std::string_view line(line_);
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields_.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
}

bool CsvReader::refuse(const std::string& what, const WarningSink& warn) const {
  // Only the last line of a file can end without a line feed: it was cut.
  if (!file_.eof()) throw RecordingError(where() + ": " + what + ": repair or remove the line");
  warn(Fault::CutLine, where() + ": last line incomplete: skipped");
  return false;
}

bool CsvReader::next(const WarningSink& warn) {
  while (std::getline(file_, line_)) {
    ++line_number_;
    const std::string_view text = trimmed(line_);
    if (text.empty() || text.front() == '#') continue;
    split();
    if (fields_.size() < min_fields_)
      return refuse(std::to_string(fields_.size()) + " fields, expected " + std::to_string(min_fields_), warn);
    const std::optional<std::int64_t> time = parsed<std::int64_t>(fields_[0]);
    if (!time || *time < 0) return refuse("'" + std::string(fields_[0]) + "' is no time in nanoseconds", warn);
    time_ns_ = *time;
    return true;
  }
  if (file_.bad()) throw RecordingError(where() + ": read error: check the disk");
  return false;
}

std::optional<double> CsvReader::number(std::size_t i) const { return parsed<double>(fields_[i]); }

bool CsvReader::numbers(std::size_t first, std::size_t count, double* values, const WarningSink& warn) const {
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> value = number(first + i);
    if (!value) return refuse("'" + std::string(fields_[first + i]) + "' is no number", warn);
    values[i] = *value;
  }
  return true;
}

}  // namespace lintel
