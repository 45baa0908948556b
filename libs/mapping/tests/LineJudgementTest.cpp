// SPDX-License-Identifier: BSD-3-Clause
#include "LineJudgement.h"

#include <gtest/gtest.h>

#include "TestMaterial.h"
#include "lintel/mapping/LineFitting.h"

namespace lintel {
namespace {

using namespace test;

/// A post 40 m away, seen from places 5 m apart, as one 4 m away from places 0.5 m apart.
LineState stateOfFarPost(float sigma_px, const MapParams& params, double* sigma_m) {
  const MapMaterial material = materialAlongX(5, 5);
  const KeyframeCameras cameras(material);
  LineRecord line = lineOf(material, 1, {{8, -5, 40}, {8, 6, 40}});
  for (LineView& view : line.views) view.sigma_px = sigma_px;
  EXPECT_TRUE(fitLine(cameras, LineFitParams(), line));
  const LineJudgement judged = judgeMapLine(params, cameras, line);
  *sigma_m = judged.sigma_distance_m;
  return judged.state;
}

TEST(LineJudgement, WhatIsFarAwayMayBeLessCertain) {
  MapParams params;
  double sigma_m = 0;
  EXPECT_EQ(stateOfFarPost(0.3F, params, &sigma_m), LineState::kKnown);
  EXPECT_GT(sigma_m, params.max_sigma_m);
  EXPECT_LT(sigma_m, 0.003 * 40);
  EXPECT_EQ(stateOfFarPost(1, params, &sigma_m), LineState::kDegenerate);
  EXPECT_GT(sigma_m, 0.003 * 40);
  params.max_far_sigma = 0;
  EXPECT_EQ(stateOfFarPost(0.3F, params, &sigma_m), LineState::kDegenerate);
}

}  // namespace
}  // namespace lintel
