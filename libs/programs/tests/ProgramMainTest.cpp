// SPDX-License-Identifier: BSD-3-Clause
#include "ProgramMain.h"

#include <gmock/gmock.h>

#include <new>
#include <sstream>

namespace lintel {
namespace {

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

}  // namespace
}  // namespace lintel
