// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/TrueLines.h"

#include <limits>
#include <map>
#include <string_view>

#include "lintel/core/TextRows.h"
#include "lintel/evaluation/TrajectoryFile.h"

namespace lintel {

namespace {

/// From a column's name to its number.
using Columns = std::map<std::string, std::size_t, std::less<>>;

Columns readHeader(const TextRows& rows) {
  Columns columns;
  for (std::size_t i = 0; i < rows.fields().size(); ++i) {
    std::string_view name = rows.fields()[i];
    name.remove_prefix(std::min(name.find_first_not_of("# \t"), name.size()));
    name = name.substr(0, name.find_first_of(" \t["));
    columns.emplace(name, i);
  }
  for (const char* needed : {"x0", "y0", "z0", "x1", "y1", "z1"})
    if (columns.count(needed) == 0)
      rows.fail("the header names no column '" + std::string(needed) + "'; give lines as in mav0/lines0/data.csv");
  return columns;
}

}  // namespace

std::vector<TrueLine> readTrueLines(const std::string& path) {
  TextRows rows(path, throwError<EvaluationError>);
  if (!rows.next(/*skip_comments=*/false))
    throw EvaluationError(path + ": is empty; give lines as in mav0/lines0/data.csv");
  const Columns columns = readHeader(rows);
  const auto frames_seen = columns.find("frames_seen");
  std::vector<TrueLine> lines;
  while (rows.next()) {
    const auto at = [&](const char* name) { return rows.number(columns.find(name)->second); };
    TrueLine line;
    line.segment_w.start = {at("x0"), at("y0"), at("z0")};
    line.segment_w.end = {at("x1"), at("y1"), at("z1")};
    line.frames_seen = frames_seen == columns.end() ? std::numeric_limits<int>::max()
                                                    : static_cast<int>(rows.number(frames_seen->second));
    if (line.segment_w.length() > 1e-6) lines.push_back(line);
  }
  if (lines.empty()) throw EvaluationError(path + ": holds no lines; give the true lines of the recording");
  return lines;
}

}  // namespace lintel
