// SPDX-License-Identifier: BSD-3-Clause
// A real estimate against its ground truth: the figures were found by independent evaluators.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "lintel/evaluation/TrajectoryErrors.h"

namespace lintel {
namespace {

std::filesystem::path testData() {
  const char* folder = std::getenv("LINTEL_TEST_DATA");
  return folder != nullptr ? std::filesystem::path(folder)
                           : std::filesystem::path(LINTEL_SOURCE_DIR) / "../shared/data";
}

class ReferenceFigures : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto folder = testData() / "evaluation";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent: set LINTEL_TEST_DATA";
    estimate_ = readTrajectory((folder / "V1_02_estimate.tum").string());
    groundtruth_ = readTrajectory((folder / "V1_02_groundtruth.csv").string());
  }
  StampedPoses estimate_, groundtruth_;
};

TEST_F(ReferenceFigures, Se3) {
  const TrajectoryErrors errors = evaluateTrajectory(estimate_, groundtruth_);
  EXPECT_EQ(errors.poses, 807u);
  EXPECT_EQ(errors.pairs, 798u);
  EXPECT_NEAR(errors.position_m.rmse, 0.09172711520685738, 1e-12);
  EXPECT_NEAR(errors.position_m.mean, 0.08152162194619839, 1e-12);
  EXPECT_NEAR(errors.position_m.median, 0.07791194901949508, 1e-12);
  EXPECT_NEAR(errors.position_m.max, 0.2558167338139706, 1e-12);
}

TEST_F(ReferenceFigures, Sim3) {
  TrajectoryErrorParams params;
  params.alignment = AlignmentKind::kSim3;
  const TrajectoryErrors errors = evaluateTrajectory(estimate_, groundtruth_, params);
  EXPECT_NEAR(errors.scale, 0.9796982521745788, 1e-12);
  EXPECT_NEAR(errors.position_m.rmse, 0.08384138804295285, 1e-12);
  EXPECT_NEAR(errors.position_m.max, 0.22665179238277003, 1e-12);
  EXPECT_EQ(errors.position_m.rmse, errors.position_sim3_m.rmse);
}

}  // namespace
}  // namespace lintel
