// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/bench/BenchSuite.h"

#include <gmock/gmock.h>

#include <fstream>

#include "lintel/bench/BenchJobs.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class BenchSuiteFile : public ::testing::Test {
 protected:
  BenchSuite read(const std::string& text) {
    std::ofstream(folder_ / "suite.yaml") << text;
    return readSuite(folder_ / "suite.yaml", folder_ / "data");
  }
  std::string faultOf(const std::string& text) {
    try {
      read(text);
    } catch (const SuiteError& error) {
      return error.what();
    }
    return "";
  }
  void SetUp() override {
    fs::create_directories(folder_ / "data/machine_hall/MH_01/mav0/cam0");
    std::ofstream(folder_ / "data/flight.rawlog") << "x";
    std::ofstream(folder_ / "data/second.rawlog") << "x";
  }
  test::TempFolder folder_;
};

constexpr const char* kConfigurations = "configurations:\n  - {name: points, set: [a=1, b=2]}\n  - {name: lines}\n";

TEST_F(BenchSuiteFile, RecordingsAreFoundByNameBelowOneFolder) {
  const BenchSuite suite = read(std::string("recordings: [MH_01, flight, nowhere]\n") + kConfigurations);
  ASSERT_EQ(suite.recordings.size(), 3u);
  EXPECT_THAT(suite.recordings[0].path, HasSubstr("machine_hall/MH_01"));
  EXPECT_THAT(suite.recordings[1].path, HasSubstr("flight.rawlog"));
  EXPECT_TRUE(suite.recordings[2].absent());
  EXPECT_THAT(suite.configurations[0].settings, ElementsAre("a=1", "b=2"));
}

TEST_F(BenchSuiteFile, APatternTakesAllRawlogsInTheOrderOfTheirNames) {
  const BenchSuite suite = read(std::string("recordings:\n  - {glob: '*.rawlog', to_s: 20}\n") + kConfigurations);
  ASSERT_EQ(suite.recordings.size(), 2u);
  EXPECT_EQ(suite.recordings[0].name, "flight");
  EXPECT_EQ(suite.recordings[1].name, "second");
  EXPECT_EQ(suite.recordings[1].to_s, 20);
}

TEST_F(BenchSuiteFile, FaultsNameTheLine) {
  EXPECT_THAT(faultOf(std::string("recordings: [a]\n") + kConfigurations + "colour: red\n"),
              HasSubstr("suite.yaml:5: unknown key 'colour'"));
  EXPECT_THAT(faultOf("recordings: [a]\n"), HasSubstr("needs a list 'configurations'"));
  EXPECT_THAT(faultOf(std::string("recordings: [../a]\n") + kConfigurations), HasSubstr(":1: '../a' is no name"));
  EXPECT_THAT(faultOf(std::string("recordings: [a, a]\n") + kConfigurations), HasSubstr("there twice"));
  EXPECT_THAT(faultOf(std::string("recordings: [a]\nstarts_s: often\n") + kConfigurations), HasSubstr(":2: "));
  EXPECT_THAT(faultOf("recordings: [a\n"), HasSubstr("is not YAML"));
}

TEST_F(BenchSuiteFile, JobsAreRecordingsTimesConfigurationsTimesRepetitions) {
  const BenchSuite suite =
      read(std::string("recordings: [MH_01, nowhere, {name: room, sim: {scene: room, blur: 0.01}}]\n"
                       "starts_s: [0, 2.5]\nseeds: [4, 5]\n") +
           kConfigurations);
  const auto jobs = jobsOf(suite, "/out");
  ASSERT_EQ(jobs.size(), 2u * 2 + 2 * 2 * 2);
  EXPECT_EQ(jobs[0].id, "MH_01/points/from0");
  EXPECT_EQ(jobs[1].id, "room/points/seed4-from0");
  EXPECT_EQ(jobs[2].id, "room/points/seed5-from0");
  EXPECT_EQ(jobs[3].id, "MH_01/lines/from0");  // every recording before the next configuration
  EXPECT_EQ(jobs.back().id, "room/lines/seed5-from2.5");
  EXPECT_EQ(jobs.back().from_s, 2.5);
  EXPECT_THAT(jobs.back().simulation, ElementsAre("--scene", "room", "--blur", "0.01", "--seed", "5"));
  EXPECT_EQ(jobs.back().recording_path, "/out/recordings/room-seed5");
}

TEST_F(BenchSuiteFile, AKeyChangesWithWhatIsRunAndNotWithWhereFilesLie) {
  const std::string text = std::string("recordings: [MH_01]\n") + kConfigurations;
  const auto key = [&](const std::string& suite, const char* out) { return jobsOf(read(suite), out)[0].key; };
  EXPECT_EQ(key(text, "/out"), key(text, "/elsewhere"));
  std::string other = text;
  other.replace(other.find("b=2"), 3, "b=3");
  EXPECT_NE(key(text, "/out"), key(other, "/out"));
  EXPECT_NE(key(text, "/out"), key("recordings: [{name: MH_01, to_s: 9}]\n" + std::string(kConfigurations), "/out"));
}

}  // namespace
}  // namespace lintel
