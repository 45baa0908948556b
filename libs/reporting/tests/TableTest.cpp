// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/reporting/Table.h"

#include <gmock/gmock.h>

#include <cmath>

namespace lintel {
namespace {

using ::testing::HasSubstr;

Table sample() {
  return {"accuracy",
          "Errors [m]",
          {"recording", "points", "lines"},
          {{"hall", {"0.021", CellMark::kNone}, {"0.019", CellMark::kBest}},
           {"a,b", {"failed <3>", CellMark::kFault}, "-"}},
          {"* best"}};
}

TEST(Table, TextIsAligned) {
  EXPECT_EQ(textOf(sample()),
            "Errors [m]\n\n"
            "recording      points   lines\n"
            "---------  ----------  ------\n"
            "hall            0.021  0.019*\n"
            "a,b        failed <3>       -\n"
            "\n* best\n");
}

TEST(Table, CsvQuotesWhatNeedsIt) {
  EXPECT_EQ(csvOf(sample()), "recording,points,lines\nhall,0.021,0.019\n\"a,b\",failed <3>,-\n");
}

TEST(Table, HtmlEscapesAndMarks) {
  const std::string html = htmlOf(sample());
  EXPECT_THAT(html, HasSubstr("<td><b>0.019</b></td>"));
  EXPECT_THAT(html, HasSubstr("<td class=\"fault\">failed &lt;3&gt;</td>"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\">hall</th>"));
}

TEST(Table, AFigureThatDoesNotExistIsADash) {
  EXPECT_EQ(fixedText(NAN, 2), "-");
  EXPECT_EQ(fixedText(1.005, 1), "1.0");
}

}  // namespace
}  // namespace lintel
