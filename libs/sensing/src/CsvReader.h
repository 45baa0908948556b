// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "Warnings.h"

namespace lintel {

/// Reads an EuRoC CSV file line by line: first field an integer time [ns], comments begin with '#'.
class CsvReader {
 public:
  /// Throws RecordingError when the file cannot be opened. `min_fields` includes the time.
  CsvReader(std::string path, std::size_t min_fields);

  /// Moves to the next data line; false at the end. A last line that the disk or the transfer cut short is skipped with
  /// a warning. Throws RecordingError on a line with too few fields or without a time.
  bool next(const WarningSink& warn);

  std::int64_t time_ns() const { return time_ns_; }                   ///< as written, not cut to ticks
  std::string_view field(std::size_t i) const { return fields_[i]; }  ///< without surrounding blanks

  /// Field as a number (NaN and infinity are numbers); empty when it is none.
  std::optional<double> number(std::size_t i) const;

  /// Fields first … first+count-1 as numbers. If one is none: throws RecordingError, but on a cut last line warns and
  /// returns false.
  bool numbers(std::size_t first, std::size_t count, double* values, const WarningSink& warn) const;

  std::string where() const { return path_ + ":" + std::to_string(line_number_); }

 private:
  bool refuse(const std::string& what, const WarningSink& warn) const;
  void split();

  std::string path_;
  std::size_t min_fields_;
  std::ifstream file_;
  std::string line_;
  std::vector<std::string_view> fields_;
  std::size_t line_number_ = 0;
  std::int64_t time_ns_ = 0;
};

}  // namespace lintel
