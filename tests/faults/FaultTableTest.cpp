// SPDX-License-Identifier: BSD-3-Clause
// Every line of faults.txt, in process; and doc/faults.md says what the table says. With LINTEL_FAULTS_WRITE set,
// outcomes and messages of both files are written anew instead: look at the difference.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include "FaultTable.h"
#include "lintel/testing/TempFolder.h"

namespace lintel::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const fs::path kTable = LINTEL_SOURCE_DIR "/tests/faults/faults.txt", kPage = LINTEL_SOURCE_DIR "/doc/faults.md";
constexpr const char* kBegin = "<!-- made by tests/faults of faults.txt -->\n";
constexpr const char* kEnd = "<!-- end -->\n";

/// What hostile files may make a reader take.
void limitMemory() {
  constexpr rlim_t kMost = rlim_t(3) << 30;
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = kMost;
#ifndef __SANITIZE_ADDRESS__
  setrlimit(RLIMIT_AS, &limit);
#endif
}

std::string pageWith(const std::string& page, const std::string& table) {
  const std::size_t begin = page.find(kBegin), end = page.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos)
    throw std::runtime_error("doc/faults.md has no place for the table");
  return page.substr(0, begin) + kBegin + table + page.substr(end);
}

std::string headOf(const fs::path& file) {
  std::ifstream in(file);
  std::string head;
  for (std::string line; std::getline(in, line) && !line.empty() && line[0] == '#';) head += line + "\n";
  return head;
}

TEST(FaultTable, EveryFaultEndsAsTheTableSays) {
  limitMemory();
  const TempFolder folder;
  const FaultInputs inputs(folder.path());
  std::vector<FaultRow> rows = readFaultTable(kTable);
  const bool write = std::getenv("LINTEL_FAULTS_WRITE") != nullptr;
  for (FaultRow& row : rows) {
    SCOPED_TRACE(row.form + " | " + row.kind + " | " + row.edits);
    Outcome outcome;
    EXPECT_NO_THROW(outcome = inputs.outcomeOf(row));
    EXPECT_THAT(outcome.text, AllOf(Not(HasSubstr("GARBAGE")), Not(HasSubstr("SILENT"))));
    EXPECT_THAT(outcome.message, Not(HasSubstr("MORE THAN ONE LINE")));
    if (outcome.exitCode() != 0) {
      EXPECT_NE(outcome.message, "");
    }
    if (write) {
      row.expected = outcome;
      continue;
    }
    EXPECT_EQ(outcome.text, row.expected.text);
    EXPECT_EQ(outcome.message, row.expected.message);
  }
  if (!write) return;
  const std::string head = headOf(kTable), page = pageWith(bytesOf(kPage), kindTable(rows));
  std::ofstream(kTable) << head << faultTableText(rows);
  std::ofstream(kPage) << page;
}

TEST(FaultTable, HoldsManyFaultsOfManyKinds) {
  std::set<std::string> kinds, faults;
  for (const FaultRow& row : readFaultTable(kTable)) {
    kinds.insert(row.kind);
    EXPECT_TRUE(faults.insert(row.form + row.edits).second) << "twice: " << row.form << " " << row.edits;
  }
  EXPECT_GE(kinds.size(), 40u);
  EXPECT_GE(faults.size(), 300u);
}

TEST(FaultTable, IsThatOfTheDocumentation) {
  const std::string page = bytesOf(kPage);
  EXPECT_EQ(page, pageWith(page, kindTable(readFaultTable(kTable))));
}

}  // namespace
}  // namespace lintel::test
