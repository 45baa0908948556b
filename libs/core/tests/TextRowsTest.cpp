// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/TextRows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

using ::testing::ElementsAre;

struct TableError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class TextRowsTest : public ::testing::Test {
 protected:
  TextRows rowsOf(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return {path_, throwError<TableError>};
  }
  template <class Action>
  static std::string errorOf(const Action& action) {
    try {
      action();
    } catch (const TableError& error) {
      return error.what();
    }
    return "no error";
  }

  test::TempFolder folder_;
  std::string path_ = folder_ / "table.csv";
};

TEST_F(TextRowsTest, CommasOrBlanksWhateverTheRowHas) {
  TextRows rows = rowsOf("# comment\n\n 1, two ,,3\r\n 4  5\t6 \n");
  ASSERT_TRUE(rows.next());
  EXPECT_THAT(rows.fields(), ElementsAre("1", "two", "", "3"));
  EXPECT_TRUE(rows.commaSeparated());
  ASSERT_TRUE(rows.next());
  EXPECT_THAT(rows.fields(), ElementsAre("4", "5", "6"));
  EXPECT_FALSE(rows.commaSeparated());
  EXPECT_EQ(rows.where(), path_ + ":4");
  EXPECT_FALSE(rows.next());
}

TEST_F(TextRowsTest, ReadsNumbersAndTimesToTheLastDigit) {
  TextRows rows = rowsOf("+1.5 1403636580838555648 1403636580.838555648 nan x\n");
  ASSERT_TRUE(rows.next());
  EXPECT_EQ(rows.number(0), 1.5);
  EXPECT_EQ(rows.integer(1), 1403636580838555648);
  EXPECT_EQ(rows.secondsAsNanoseconds(2), 1403636580838555648);
  EXPECT_TRUE(std::isnan(rows.numberIfAny(3).value()));
  EXPECT_FALSE(rows.numberIfAny(4));
  EXPECT_FALSE(rows.numberIfAny(5)) << "no such field";
  EXPECT_FALSE(rows.integerIfAny(0));
}

TEST_F(TextRowsTest, ErrorsAreOfTheCallersClassAndNameFileAndLine) {
  TextRows rows = rowsOf("1 2\n3 x inf\n");
  ASSERT_TRUE(rows.next() && rows.next());
  EXPECT_EQ(errorOf([&] { rows.number(1); }), path_ + ":2: column 2 should be a number, but is 'x'");
  EXPECT_EQ(errorOf([&] { rows.number(2); }), path_ + ":2: column 3 is not finite; remove the row");
  EXPECT_EQ(errorOf([&] { rows.integer(3); }), path_ + ":2: column 4 is missing");
  EXPECT_THAT(errorOf([&] { TextRows(folder_ / "absent", throwError<TableError>); }),
              ::testing::HasSubstr("absent: cannot be opened (No such file or directory)"));
}

TEST_F(TextRowsTest, ALastRowWithoutALineFeedMayBeCut) {
  TextRows rows = rowsOf("1,2\n3,4");
  ASSERT_TRUE(rows.next());
  EXPECT_FALSE(rows.isUnterminated());
  ASSERT_TRUE(rows.next());
  EXPECT_TRUE(rows.isUnterminated());
}

}  // namespace
}  // namespace lintel
