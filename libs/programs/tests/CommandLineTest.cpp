// SPDX-License-Identifier: BSD-3-Clause
#include "CommandLine.h"

#include <gmock/gmock.h>

#include <sstream>
#include <string>
#include <vector>

#include "lintel/core/Version.h"

namespace lintel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class CommandLineTest : public ::testing::Test {
 protected:
  std::optional<int> parse(const std::vector<std::string>& arguments) {
    CommandLine line("prog", "Does a thing.");
    line.option("--number", number_, "A number").positive().showDefault();
    line.option("--name", name_, "A name").oneOf({"red", "green"}).type("COLOUR");
    line.option("--list", list_, "Several").separatedBy(',').oneWord();
    line.option("input", input_, "Files");
    line.flag("-q,--quiet", quiet_, "Print nothing");
    std::vector<const char*> argv{"prog"};
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    return line.parse(static_cast<int>(argv.size()), argv.data(), out_, err_);
  }
  int number_ = 7;
  std::string name_, input_;
  std::vector<std::string> list_;
  bool quiet_ = false;
  std::ostringstream out_, err_;
};

TEST_F(CommandLineTest, SetsTheVariables) {
  EXPECT_EQ(parse({"--number=3", "--name", "green", "--list", "a,b", "file", "-q"}), std::nullopt);
  EXPECT_EQ(number_, 3);
  EXPECT_EQ(name_, "green");
  EXPECT_THAT(list_, ElementsAre("a", "b"));
  EXPECT_EQ(input_, "file");
  EXPECT_TRUE(quiet_);
  EXPECT_EQ(out_.str() + err_.str(), "");
}

TEST_F(CommandLineTest, HelpAndVersionGoToOut) {
  EXPECT_EQ(parse({"--help"}), 0);
  EXPECT_THAT(out_.str(), HasSubstr("--number"));
  EXPECT_THAT(out_.str(), HasSubstr("7"));
  EXPECT_THAT(out_.str(), HasSubstr("COLOUR"));
  out_.str("");
  EXPECT_EQ(parse({"--version"}), 0);
  EXPECT_THAT(out_.str(), ::testing::StartsWith(std::string("prog ") + version() + "\nbuilt with Eigen 3."));
  EXPECT_EQ(err_.str(), "");
}

TEST_F(CommandLineTest, WrongUseIsOneLineAndTwo) {
  for (const char* wrong : {"--unknown", "--number=three", "--number=-1", "--name=blue"}) {
    err_.str("");
    const std::string text = wrong;
    EXPECT_EQ(parse({text}), 2) << text;
    EXPECT_THAT(err_.str(), StartsWith("prog: "));
    EXPECT_THAT(err_.str(), HasSubstr(text.substr(text.find('=') + 1)));
  }
  EXPECT_EQ(out_.str(), "");
}

}  // namespace
}  // namespace lintel
