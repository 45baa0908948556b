// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/sensing/GroundTruth.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "TinyEuroc.h"
#include "lintel/sensing/EurocToRawlog.h"

namespace lintel {
namespace {

using test::TempFolder;
using test::TinyEuroc;

TEST(GroundTruth, AFolderAndItsRawlogHoldTheSamePoses) {
  const TempFolder folder;
  const std::string euroc = folder / "flight", rawlog = folder / "flight.rawlog";
  TinyEuroc().write(euroc);
  eurocToRawlog(euroc, rawlog);
  const auto of_folder = readGroundTruth(euroc), of_rawlog = readGroundTruth(rawlog);
  ASSERT_EQ(of_folder.size(), 20u);
  ASSERT_EQ(of_rawlog.size(), of_folder.size());
  for (std::size_t i = 0; i < of_folder.size(); ++i) {
    EXPECT_EQ(of_folder[i].first, of_rawlog[i].first);
    EXPECT_EQ(of_folder[i].second.p, of_rawlog[i].second.p);
    EXPECT_LT(of_folder[i].second.q.angularDistance(of_rawlog[i].second.q), 1e-7);
  }
}

TEST(GroundTruth, WithoutOneItIsEmpty) {
  const TempFolder folder;
  TinyEuroc tiny;
  tiny.groundtruth = false;
  tiny.write(folder / "flight");
  eurocToRawlog(folder / "flight", folder / "flight.rawlog");
  EXPECT_TRUE(readGroundTruth(folder / "flight").empty());
  EXPECT_TRUE(readGroundTruth(folder / "flight.rawlog").empty());
}

TEST(GroundTruth, ADamagedRawlogGivesWhatIsBeforeTheDamage) {
  const TempFolder folder;
  TinyEuroc().write(folder / "flight");
  const std::string rawlog = folder / "flight.rawlog";
  eurocToRawlog(folder / "flight", rawlog);
  std::filesystem::resize_file(rawlog, std::filesystem::file_size(rawlog) / 2);
  const auto poses = readGroundTruth(rawlog);
  EXPECT_GE(poses.size(), 1u);
  EXPECT_LT(poses.size(), 20u);
}

TEST(GroundTruth, NoRecordingIsNamed) { EXPECT_THROW(readGroundTruth("/nonexistent.rawlog"), RecordingError); }

}  // namespace
}  // namespace lintel
