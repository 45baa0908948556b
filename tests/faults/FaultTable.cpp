// SPDX-License-Identifier: BSD-3-Clause
#include "FaultTable.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

namespace lintel::test {

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

/// What is in the table's cells and would end them.
std::string cell(std::string text) {
  std::replace(text.begin(), text.end(), '|', '/');
  text.resize(std::min(text.size(), std::size_t{160}));
  return text;
}

/// Readers that share their code go by one name on the page.
std::string formName(const std::string& form) {
  const std::string extension = std::filesystem::path(form).extension().string();
  if (extension == ".bag" || extension == ".db3" || extension == ".mcap") return "bag";
  if (extension == ".rawlog") return "rawlog";
  if (form == "kalibr.yaml" || form == "vins.yaml") return "calibration";
  if (extension == ".lintel") return "map";
  if (extension == ".csv") return "covariances";
  return form.substr(0, form.find_first_of(". "));
}

std::string happening(const std::string& outcome) {
  if (outcome == "refused") return "refused, exit code 1";
  if (outcome.rfind("ends after", 0) == 0) return "what is before it is used, exit code 1";
  if (outcome.find(" of 20 frames") != std::string::npos) return "the other frames are used";
  return outcome;
}

}  // namespace

int Outcome::exitCode() const { return text == "refused" || text.rfind("ends after", 0) == 0 ? 1 : 0; }

std::vector<FaultRow> readFaultTable(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<FaultRow> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string part; std::getline(parts, part, '|');) cells.push_back(trimmed(part));
    cells.resize(6);
    rows.push_back({cells[0], cells[1], cells[2], {cells[4], cells[5]}});
    if (!cells[4].empty() && cells[3] != std::to_string(rows.back().expected.exitCode()))
      throw std::runtime_error(line + ": exit code and outcome do not fit");
  }
  if (rows.empty()) throw std::runtime_error(file.string() + ": no faults");
  return rows;
}

std::string faultTableText(const std::vector<FaultRow>& rows) {
  std::string text;
  for (const FaultRow& row : rows)
    text += row.form + " | " + row.kind + " | " + row.edits + " | " + std::to_string(row.expected.exitCode()) + " | " +
            row.expected.text + " | " + row.expected.message + "\n";
  return text;
}

std::string kindTable(const std::vector<FaultRow>& rows) {
  std::vector<std::string> kinds;
  std::map<std::string, std::vector<const FaultRow*>> of_kind;
  for (const FaultRow& row : rows) {
    if (of_kind[row.kind].empty()) kinds.push_back(row.kind);
    of_kind[row.kind].push_back(&row);
  }
  std::ostringstream text;
  text << "| kind | in | faults | what happens | message, for example |\n|---|---|---|---|---|\n";
  for (const std::string& kind : kinds) {
    std::set<std::string> forms;
    std::map<std::string, int> outcomes;
    std::string example;
    for (const FaultRow* row : of_kind[kind]) {
      forms.insert(formName(row->form));
      ++outcomes[happening(row->expected.text)];
      if (example.empty()) example = row->expected.message;
    }
    std::string in, happens;
    for (const std::string& form : forms) in += (in.empty() ? "" : ", ") + form;
    for (const auto& [outcome, count] : outcomes)
      happens +=
          (happens.empty() ? "" : "; ") + outcome + (outcomes.size() > 1 ? " (" + std::to_string(count) + ")" : "");
    text << "| " << kind << " | " << in << " | " << of_kind[kind].size() << " | " << happens << " | "
         << (example.empty() ? "" : "`" + cell(example) + "`") << " |\n";
  }
  return text.str();
}

}  // namespace lintel::test
