// SPDX-License-Identifier: BSD-3-Clause
#include "ProgramMain.h"

#include <gmock/gmock.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <new>
#include <sstream>

#include "lintel/core/Version.h"

namespace lintel {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(ProgramMain, TurnsExceptionsIntoOneLineAndAnExitCode) {
  std::ostringstream err;
  EXPECT_EQ(programMain("prog", err, [] { return 0; }), 0);
  EXPECT_EQ(err.str(), "");
  EXPECT_EQ(programMain("prog", err, []() -> int { throw std::runtime_error("file:3: bad\nremove it\n"); }), 1);
  EXPECT_EQ(err.str(), "prog: file:3: bad remove it\n");
  err.str("");
  EXPECT_EQ(programMain("prog", err, []() -> int { throw UsageError("--a needs --b"); }), 2);
  EXPECT_EQ(err.str(), "prog: --a needs --b; see prog --help\n");
  err.str("");
  EXPECT_EQ(programMain("prog", err, []() -> int { throw std::bad_alloc(); }), 1);
  EXPECT_THAT(err.str(), StartsWith("prog: out of memory"));
}

class ParseArguments : public ::testing::Test {
 protected:
  std::optional<int> parse(const char* argument) {
    CLI::App app("Does a thing.", "prog");
    int number = 0;
    app.add_option("--number", number);
    const char* argv[] = {"prog", argument};
    return parseArguments(app, 2, argv, out_, err_);
  }
  std::ostringstream out_, err_;
};

TEST_F(ParseArguments, GoesOnWhenAllIsWell) {
  EXPECT_EQ(parse("--number=3"), std::nullopt);
  EXPECT_EQ(out_.str() + err_.str(), "");
}

TEST_F(ParseArguments, HelpAndVersionGoToOut) {
  EXPECT_EQ(parse("--help"), 0);
  EXPECT_THAT(out_.str(), HasSubstr("--number"));
  out_.str("");
  EXPECT_EQ(parse("--version"), 0);
  EXPECT_EQ(out_.str(), std::string("prog ") + version() + "\n");
  EXPECT_EQ(err_.str(), "");
}

TEST_F(ParseArguments, WrongUseIsOneLineAndTwo) {
  EXPECT_EQ(parse("--unknown"), 2);
  EXPECT_THAT(err_.str(), StartsWith("prog: "));
  EXPECT_THAT(err_.str(), HasSubstr("--unknown"));
  err_.str("");
  EXPECT_EQ(parse("--number=three"), 2);
  EXPECT_THAT(err_.str(), HasSubstr("three"));
  EXPECT_EQ(out_.str(), "");
}

}  // namespace
}  // namespace lintel
