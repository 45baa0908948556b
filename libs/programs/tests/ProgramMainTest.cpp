// SPDX-License-Identifier: BSD-3-Clause
#include "ProgramMain.h"

#include <glog/logging.h>
#include <gmock/gmock.h>

#include <new>
#include <sstream>
#include <system_error>

#include "StopSignals.h"

namespace lintel {
namespace {

using ::testing::StartsWith;

TEST(ProgramMain, TurnsExceptionsIntoOneLineAndAnExitCode) {
  std::ostringstream err;
  EXPECT_EQ(programMain("prog", err, [] { return 0; }), 0);
  EXPECT_EQ(err.str(), "");
  EXPECT_EQ(programMain("prog", err, []() -> int { throw std::runtime_error("file:3: bad\nremove it\n"); }), 1);
  EXPECT_EQ(err.str(), "prog: file:3: bad remove it\n");
  EXPECT_EQ(oneLine("a\x1b[31mb"), "a?[31mb");
  err.str("");
  EXPECT_EQ(programMain("prog", err, []() -> int { throw UsageError("--a needs --b"); }), 2);
  EXPECT_EQ(err.str(), "prog: --a needs --b; see prog --help\n");
  err.str("");
  EXPECT_EQ(programMain("prog", err, []() -> int { throw std::bad_alloc(); }), 1);
  EXPECT_THAT(err.str(), StartsWith("prog: out of memory"));
  err.str("");
  EXPECT_EQ(programMain("prog", err, []() -> int { throw std::system_error(std::make_error_code(std::errc(EAGAIN))); }),
            1);
  EXPECT_EQ(err.str(), "prog: Resource temporarily unavailable: a thread was refused; free some memory\n");
  err.str("");
  EXPECT_EQ(programMain("prog", err, []() -> int { throw Stopped("stopped by SIGTERM", 143); }), 143);
  EXPECT_EQ(err.str(), "prog: stopped by SIGTERM\n");
}

TEST(ProgramMain, TheLogOfCeresIsNotForTheTerminal) {
  std::ostringstream err;
  testing::internal::CaptureStderr();
  const int code = programMain("prog", err, [] {
    LOG(ERROR) << "Linear solver failure";
    return 0;
  });
  EXPECT_EQ(testing::internal::GetCapturedStderr() + err.str(), "");
  EXPECT_EQ(code, 0);
}

}  // namespace
}  // namespace lintel
