// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace lintel {

enum class CellMark {
  kNone,
  kBest,   ///< bold; a star in text
  kFault,  ///< something went wrong
};

struct Cell {
  std::string text;
  CellMark mark = CellMark::kNone;

  Cell() = default;
  Cell(std::string t, CellMark m = CellMark::kNone) : text(std::move(t)), mark(m) {}  // NOLINT: a text is a cell
  Cell(const char* t) : text(t) {}                                                    // NOLINT
};

/// A table: the first column names the rows.
struct Table {
  std::string name;     ///< of its files, e.g. "accuracy"
  std::string caption;  ///< what it shows, with units
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
  std::vector<std::string> notes;
};

/// For a terminal: columns aligned, numbers to the right.
std::string textOf(const Table& table);

/// RFC 4180, the columns' names first, without marks.
std::string csvOf(const Table& table);

/// An HTML table; the page's style makes it scroll on a narrow screen.
std::string htmlOf(const Table& table);

/// `value` with so many decimals; "-" when it is not finite.
std::string fixedText(double value, int decimals);

}  // namespace lintel
