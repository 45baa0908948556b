// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "lintel/bench/BenchJobs.h"
#include "lintel/pipeline/Configuration.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;

// A suite that names an option that was renamed would fail on a user's machine, after hours.
TEST(ShippedSuites, NameOptionsThatExist) {
  int suites = 0;
  for (const auto& entry : fs::directory_iterator(LINTEL_SOURCE_DIR "/share/lintel/suites")) {
    const BenchSuite suite = readSuite(entry.path().string(), LINTEL_SOURCE_DIR);
    ++suites;
    for (const BenchConfiguration& configuration : suite.configurations) {
      Configuration options;
      EXPECT_NO_THROW(readConfiguration(configuration.config, options));
      for (const std::string& setting : configuration.settings)
        EXPECT_NO_THROW(setOption(setting, options)) << entry.path() << ": " << setting;
    }
  }
  EXPECT_GE(suites, 2);
}

TEST(ShippedSuites, TheElevenOfEuroc) {
  const BenchSuite suite = readSuite(LINTEL_SOURCE_DIR "/share/lintel/suites/euroc.yaml", LINTEL_SOURCE_DIR);
  EXPECT_EQ(suite.recordings.size(), 11u);
  std::map<std::string, double> means_m;
  for (const PublishedSystem& system : suite.published) {
    EXPECT_NE(system.source, "") << system.name;
    for (const BenchRecording& recording : suite.recordings) {
      ASSERT_EQ(system.errors.count(recording.name), 1u) << system.name;
      means_m[system.name] += system.errors.at(recording.name).rmse_m / 11;
    }
  }
  // the means as published, to the millimetre that they are rounded to
  for (const auto& [name, mean_m] : std::map<std::string, double>{
           {"DM-VIO", .069}, {"VI-DSO", .089}, {"UV-SLAM", .139}, {"OpenVINS", .150}, {"ORB-SLAM3", .043}})
    EXPECT_NEAR(means_m[name], mean_m, .0011) << name;
}

}  // namespace
}  // namespace lintel
