// SPDX-License-Identifier: BSD-3-Clause
#include "EurocTable.h"

#include "lintel/sensing/Recording.h"

namespace lintel {

EurocTable::EurocTable(std::string path, std::size_t min_fields)
    : rows_(std::move(path), throwError<RecordingError>), min_fields_(min_fields) {}

bool EurocTable::refuse(const std::string& what, const WarningSink& warn) const {
  if (!rows_.isUnterminated()) rows_.fail(what + ": repair or remove the line");
  warn(Fault::CutLine, where() + ": last line incomplete: skipped");
  return false;
}

bool EurocTable::next(const WarningSink& warn) {
  if (!rows_.next()) return false;
  const std::size_t fields = rows_.commaSeparated() ? rows_.fields().size() : 1;
  if (fields < min_fields_)
    return refuse(std::to_string(fields) + " fields, expected " + std::to_string(min_fields_), warn);
  if (fields_before_ == 0) fields_before_ = fields;
  if (fields != fields_before_)
    return refuse(std::to_string(fields) + " fields, the rows before have " + std::to_string(fields_before_), warn);
  const std::optional<std::int64_t> time = rows_.integerIfAny(0);
  if (!time || *time < 0) return refuse("'" + std::string(field(0)) + "' is no time in nanoseconds", warn);
  time_ns_ = *time;
  return true;
}

bool EurocTable::numbers(std::size_t first, std::size_t count, double* values, const WarningSink& warn) const {
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> value = rows_.numberIfAny(first + i);
    if (!value) return refuse("'" + std::string(field(first + i)) + "' is no number", warn);
    values[i] = *value;
  }
  return true;
}

}  // namespace lintel
