// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "Warnings.h"
#include "lintel/core/TextRows.h"

namespace lintel {

/// Reads an EuRoC table (CSV) row by row: first field an integer time [ns], comments begin with '#'.
class EurocTable {
 public:
  /// Throws RecordingError when the file cannot be opened. `min_fields` includes the time.
  EurocTable(std::string path, std::size_t min_fields);

  /// Moves to the next row; false at the end. A last row that the disk or the transfer cut short is skipped with a
  /// warning. Throws RecordingError on a row with too few fields or without a time.
  bool next(const WarningSink& warn);

  std::int64_t time_ns() const { return time_ns_; }                          ///< as written, not cut to ticks
  std::string_view field(std::size_t i) const { return rows_.fields()[i]; }  ///< without surrounding blanks

  /// Fields first … first+count-1 as numbers (NaN and infinity are numbers). If one is none: throws RecordingError, but
  /// on a cut last row warns and returns false.
  bool numbers(std::size_t first, std::size_t count, double* values, const WarningSink& warn) const;

  std::string where() const { return rows_.where(); }

 private:
  bool refuse(const std::string& what, const WarningSink& warn) const;

  TextRows rows_;
  std::size_t min_fields_, fields_before_ = 0;
  std::int64_t time_ns_ = 0;
};

}  // namespace lintel
