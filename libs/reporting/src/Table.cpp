// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/reporting/Table.h"

#include <algorithm>
#include <cmath>

#include "lintel/core/Formatted.h"
#include "lintel/reporting/HtmlPage.h"

namespace lintel {

namespace {

/// Characters, not bytes, of UTF-8.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width - std::min(width, widthOf(text)), ' ');
  return right ? blanks + text : text + blanks;
}

std::string trimmed(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

std::string shown(const Cell& cell) { return cell.mark == CellMark::kBest ? cell.text + "*" : cell.text; }

std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

}  // namespace

std::string textOf(const Table& table) {
  std::vector<std::size_t> widths;
  for (const std::string& column : table.columns) widths.push_back(widthOf(column));
  for (const auto& row : table.rows)
    for (std::size_t i = 0; i < row.size() && i < widths.size(); ++i)
      widths[i] = std::max(widths[i], widthOf(shown(row[i])));
  std::string text = table.caption + "\n\n", line, rule;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    line += (i > 0 ? "  " : "") + padded(table.columns[i], widths[i], i > 0);
    rule += (i > 0 ? "  " : "") + std::string(widths[i], '-');
  }
  text += trimmed(line) + "\n" + rule + "\n";
  for (const auto& row : table.rows) {
    line.clear();
    for (std::size_t i = 0; i < row.size() && i < widths.size(); ++i)
      line += (i > 0 ? "  " : "") + padded(shown(row[i]), widths[i], i > 0);
    text += trimmed(line) + "\n";
  }
  for (const std::string& note : table.notes) text += "\n" + note;
  return text + (table.notes.empty() ? "" : "\n");
}

std::string csvOf(const Table& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) text += (i > 0 ? "," : "") + csvField(table.columns[i]);
  text += "\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? "," : "") + csvField(row[i].text);
    text += "\n";
  }
  return text;
}

std::string htmlOf(const Table& table) {
  std::string html = "<div class=\"wide\"><table>\n<caption>" + escaped(table.caption) + "</caption>\n<thead><tr>";
  for (const std::string& column : table.columns) html += "<th scope=\"col\">" + escaped(column) + "</th>";
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string text = escaped(row[i].text);
      if (i == 0)
        html += "<th scope=\"row\">" + text + "</th>";
      else if (row[i].mark == CellMark::kBest)
        html += "<td><b>" + text + "</b></td>";
      else if (row[i].mark == CellMark::kFault)
        html += "<td class=\"fault\">" + text + "</td>";
      else
        html += "<td>" + text + "</td>";
    }
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  for (const std::string& note : table.notes) html += "<p class=\"note\">" + escaped(note) + "</p>\n";
  return html;
}

std::string fixedText(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  return formatted("%.*f", decimals, value);
}

}  // namespace lintel
