// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>

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
  ASSERT_EQ(suite.published.size(), 3u);
  for (const auto& [system, figures] : suite.published)
    for (const BenchRecording& recording : suite.recordings) EXPECT_EQ(figures.count(recording.name), 1u) << system;
}

}  // namespace
}  // namespace lintel
