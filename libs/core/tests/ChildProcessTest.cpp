// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/ChildProcess.h"

#include <gmock/gmock.h>

#include <string>

#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

using ::testing::HasSubstr;

TEST(ChildProcess, GivesBackWhatTheProgramSaidAndItsExitCode) {
  const ChildResult result = runChild({{"sh", "-c", "cat; echo fault >&2; exit 3"}, "question\n", "", {}});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.output, "question\n");
  EXPECT_EQ(result.errors, "fault\n");
}

TEST(ChildProcess, MuchInputAndOutputDoNotBlockEachOther) {
  const std::string much(3000000, 'x');
  EXPECT_EQ(runChild({{"cat"}, much, "", {}}).output, much);
}

TEST(ChildProcess, AMissingProgramIsAnExitCodeNotAnException) {
  const ChildResult result = runChild({{"lintel-no-such-program"}, "", "", {}});
  EXPECT_EQ(result.exit_code, 127);
  EXPECT_THAT(result.errors, HasSubstr("lintel-no-such-program"));
}

TEST(ChildProcess, ASignalIsToldFromAnExit) {
  EXPECT_EQ(runChild({{"sh", "-c", "kill -SEGV $$"}, "", "", {}}).exit_code, 128 + 11);
}

TEST(ChildProcess, IsToldToStop) {
  EXPECT_EQ(runChild({{"sleep", "1000"}, "", "", {}, [] { return true; }}).exit_code, 128 + 15);
  EXPECT_EQ(runChild({{"true"}, "", "", {}, [] { return false; }}).exit_code, 0);
}

TEST(ChildProcess, AddsToTheEnvironmentAndReplaces) {
  const ChildResult result =
      runChild({{"sh", "-c", "echo $LINTEL_X $HOME"}, "", "", {"LINTEL_X=here", "HOME=elsewhere"}});
  EXPECT_EQ(result.output, "here elsewhere\n");
}

TEST(ChildProcess, TheLogIsAppendedTo) {
  const test::TempFolder folder;
  const std::string log = folder / "log";
  for (const char* word : {"one", "two"}) runChild({{"sh", "-c", std::string("echo ") + word}, "", log, {}});
  EXPECT_EQ(test::bytesOf(log), "one\ntwo\n");
}

TEST(ChildProcess, ShellLinesSurviveAShell) {
  const std::vector<std::string> words{"printf", "%s|", "plain", "two words", "it's", "$HOME", "", "a=b"};
  EXPECT_EQ(runChild({{"sh", "-c", shellLine(words)}, "", "", {}}).output, "plain|two words|it's|$HOME||a=b|");
}

}  // namespace
}  // namespace lintel
