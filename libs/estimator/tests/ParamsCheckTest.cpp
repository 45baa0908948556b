// SPDX-License-Identifier: BSD-3-Clause
#include "ParamsCheck.h"

#include <gmock/gmock.h>

#include <limits>
#include <stdexcept>

namespace lintel {
namespace {

std::string messageOf(const EstimatorParams& params) {
  try {
    checkParams(params);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(ParamsCheck, TakesTheDefaults) { EXPECT_EQ(messageOf({}), ""); }

TEST(ParamsCheck, NamesTheParameterAndItsRange) {
  EstimatorParams params;
  params.keyframes = 2;
  EXPECT_EQ(messageOf(params), "estimator.keyframes = 2, must be from 4 to 100");
}

TEST(ParamsCheck, LooksIntoTheGroups) {
  EstimatorParams params;
  params.factors.point_sigma_px = 0;
  EXPECT_THAT(messageOf(params), ::testing::HasSubstr("estimator.factors.point_sigma_px"));
  params = {};
  params.landmarks.max_depth_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(messageOf(params), ::testing::HasSubstr("estimator.landmarks.max_depth_m"));
}

TEST(ParamsCheck, LimitsThatContradictEachOther) {
  EstimatorParams params;
  params.initializer.max_frames = params.initializer.min_frames - 1;
  EXPECT_THAT(messageOf(params), ::testing::HasSubstr("initializer.max_frames"));
}

}  // namespace
}  // namespace lintel
