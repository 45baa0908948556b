// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/reporting/HtmlPage.h"

#include <gmock/gmock.h>

namespace lintel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(HtmlPage, NothingIsTakenForHtml) {
  HtmlPage page("<b>");
  page.heading("1 < 2 & \"3\"");
  page.warnings({"<script>alert(1)</script>"});
  const std::string text = page.text();
  EXPECT_THAT(text, HasSubstr("<title>&lt;b&gt;</title>"));
  EXPECT_THAT(text, HasSubstr("1 &lt; 2 &amp; &quot;3&quot;"));
  EXPECT_THAT(text, Not(HasSubstr("<script")));
}

TEST(HtmlPage, NeedsNothingButItself) {
  HtmlPage page("page");
  page.picture("\x89PNG", "a picture");
  Figure figure{"t", "x", "y"};
  figure.curves = {{"c", {{0, 0}, {1, 1}}}};
  page.figure(figure, "a plot");
  const std::string text = page.text();
  EXPECT_THAT(text, HasSubstr("data:image/png;base64,iVBORw=="));
  for (const char* address : {"src=\"http", "href=\"http", "url("}) EXPECT_THAT(text, Not(HasSubstr(address)));
}

TEST(HtmlPage, APlotWithoutDataIsALineOfText) {
  HtmlPage page("page");
  page.figure({"t", "x", "y"}, "how it went");
  EXPECT_THAT(page.text(), HasSubstr("No picture (how it went): "));
}

TEST(HtmlPage, SectionsAreListedOnceThereAreSome) {
  HtmlPage page("page");
  page.heading("One");
  EXPECT_THAT(page.text(), Not(HasSubstr("<nav>")));
  page.heading("Two");
  EXPECT_THAT(page.text(), HasSubstr("<a href=\"#s2\">Two</a>"));
}

}  // namespace
}  // namespace lintel
